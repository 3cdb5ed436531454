//! One step of a diagnosis: fits one model and tries every effect on top of it.

mod choice;
mod report;
mod stages;

use std::collections::VecDeque;

use super::judge::{HUGE_FALL, nested};
use super::next_experiment::{Design, Rival, TRYING};
use super::race::Race;
use super::search::Search;
use super::select::{fall, is_plain_noise, is_too_rich};
use super::session::{Scored, Session};
use super::verdict::Class;
use crate::crew::Crew;
use crate::diagnosis::{
    Contradiction, CriticismError, InputCheck, Limits, NextExperiment, Step, StepReport,
};
use crate::effect::{Effect, EffectId};
use crate::measurement::Measurement;
use crate::progress::Progress;
use crate::user_model::UserModel;

/// Share of the cost of a model below which a fit once more is in another valley, and the one below which it is taken.
const BETTER_VALLEY: f64 = 0.92;
const BETTER: f64 = 0.9999;

/// Times the cost of a model from which on an effect is needed, if the model without it is not hoped to come lower.
const NEEDED: f64 = 30.0;

/// Times the cost of the best subset of the screen to which another one must be hoped to come to be followed.
const HOPED: f64 = 1.03;

/// What a step is doing.
enum Stage {
    /// Fitting the model itself, effect by effect; `next` is the one to add then.
    Build { search: Search, next: usize },
    /// Trying subsets of effects that the screen found: the first of these is under way.
    Screened(VecDeque<Search>),
    /// Trying what tells how the record was made, where little is left.
    Record(Race),
    /// Trying every effect on top.
    Try(Race),
    /// Fitting the model once more from where an effect on top of it led, or from beyond where it was stuck.
    Revisit(Search),
    /// Trying to do without each effect.
    Remove { index: usize, search: Search },
    /// Trying every other effect in the place of each one.
    Swap { place: usize, race: Race },
    /// Looking for the experiment that tells apart what this one cannot: the first of these is under way.
    Design(Vec<Design>),
    /// Everything is known.
    Report,
}

/// Fits one model and tries every effect on top of it; where none helps, gives the verdict.
pub struct StepJob {
    session: Session,
    wanted: Vec<&'static dyn Effect>,
    stage: Stage,
    model: Option<Scored>,
    /// The same before its last effect was added.
    before_last: Option<Scored>,
    tried: Vec<(&'static dyn Effect, Scored)>,
    /// The best model with effects that the screen found together.
    screened: Option<Scored>,
    without: Vec<Scored>,
    classes: Vec<Class>,
    /// What could stand in the place of an effect.
    rivals: Vec<Rival>,
    /// How far the next experiment may go.
    limits: Limits,
    experiments: Vec<NextExperiment>,
    /// Known values that the data contradict.
    contradicted: Vec<Contradiction>,
    /// The model with an effect replaced by a part of it that does as well.
    simpler: Option<Scored>,
    /// Effects in the order in which earlier steps found them.
    earlier: Vec<EffectId>,
    /// Effects that are not added any more: they may be imitations.
    barred: Vec<EffectId>,
    /// Times that the model was fitted once more.
    visits: usize,
}

impl StepJob {
    /// The baseline plus `effects` (in the order in which the user added them) on `measurement`.
    pub fn new(measurement: &Measurement, effects: &[EffectId]) -> Result<Self, CriticismError> {
        Self::with_model(measurement, effects, &UserModel::blank(measurement.kind))
    }

    /// The same on top of what the user knows: its effects come first and are never taken out.
    pub fn with_model(
        measurement: &Measurement,
        effects: &[EffectId],
        model: &UserModel,
    ) -> Result<Self, CriticismError> {
        let session = Session::new(measurement, model)?;
        let wanted = session.chosen(model, effects)?;
        let search = Search::baseline(&session.data, &session.knowledge);
        let limits = Limits::of(measurement);
        Ok(Self::of(
            session,
            wanted,
            Stage::Build { search, next: 0 },
            limits,
        ))
    }

    /// The same with other limits of the next experiment than [`Limits::of`] the measurement.
    #[must_use]
    pub fn within(self, limits: Limits) -> Self {
        Self { limits, ..self }
    }

    /// Whether the input explains the motion.
    pub(in crate::criticism) fn input_check(&self) -> &InputCheck {
        &self.session.input_check
    }

    /// The same with the independent parts of the work done by `crew`.
    #[must_use]
    pub fn with_crew(mut self, crew: &Crew) -> Self {
        self.session.employ(crew);
        self
    }

    fn of(
        session: Session,
        wanted: Vec<&'static dyn Effect>,
        stage: Stage,
        limits: Limits,
    ) -> Self {
        Self {
            rivals: Vec::new(),
            limits,
            experiments: Vec::new(),
            session,
            wanted,
            stage,
            model: None,
            before_last: None,
            tried: Vec::new(),
            screened: None,
            without: Vec::new(),
            classes: Vec::new(),
            contradicted: Vec::new(),
            simpler: None,
            earlier: Vec::new(),
            barred: Vec::new(),
            visits: 0,
        }
    }

    /// The next step of a diagnosis, which knows the fit already.
    pub(super) fn from_fit(session: Session, model: Scored, limits: Limits) -> Self {
        let effects = model.fit.structure.effects.clone();
        let mut job = Self::of(session, effects, Stage::Report, limits);
        job.model = Some(model);
        job.stage = job.try_stage();
        job
    }

    /// The same after `steps`: what takes the place of an effect is told where that was.
    #[must_use]
    pub(super) fn following(mut self, steps: &[Step]) -> Self {
        self.earlier = steps.iter().flat_map(|s| &s.effects).copied().collect();
        self
    }

    /// The same without these effects among those that may be added.
    #[must_use]
    pub(super) fn barring(self, barred: &[EffectId]) -> Self {
        Self {
            barred: barred.to_vec(),
            ..self
        }
    }

    /// Where in the order of finding an effect stands, or one that it contains or that contains it.
    fn found(&self, effect: &'static dyn Effect) -> usize {
        let related = |id: &EffectId| self.session.find(*id).is_some_and(|e| nested(e, effect));
        self.earlier.iter().position(related).unwrap_or(usize::MAX)
    }

    /// Effects that could be added: not in the model, nor contained in one that is.
    fn others(&self) -> Vec<&'static dyn Effect> {
        self.session
            .library()
            .filter(|e| {
                self.wanted
                    .iter()
                    .all(|w| w.id() != e.id() && !w.has_part(e.id()))
            })
            .collect()
    }

    /// Effects that could stand in the place of the one at `place`, without touching the others; what it
    /// contains may be enough.
    fn rivals(&self, place: usize) -> Vec<&'static dyn Effect> {
        let own = self.wanted.get(place);
        let too_rich = |own: &dyn Effect, e: &dyn Effect| {
            let more = e.parameters().len().saturating_sub(own.parameters().len());
            let score = self.model.as_ref().map(|model| &model.score);
            score.is_some_and(|score| is_too_rich(score, more))
        };
        self.session
            .library()
            .filter(|e| {
                own.is_some_and(|own| {
                    (!nested(*own, *e) || own.has_part(e.id()))
                        && !e.limits().contains(&own.id())
                        && !too_rich(*own, *e)
                }) && self
                    .wanted
                    .iter()
                    .enumerate()
                    .all(|(k, w)| k == place || !nested(*w, *e))
            })
            .collect()
    }

    /// Does some work.
    pub fn advance(&mut self) -> Progress<StepReport> {
        if matches!(self.stage, Stage::Report)
            && let Some(report) = self.report()
        {
            return Progress::Done(report);
        }
        let session = &self.session;
        let present = self.model.as_ref().map_or(f64::INFINITY, |m| m.fit.cost);
        let works = |search: &mut Search, enough: f64| {
            let (data, scales) = (&session.data, &session.scales);
            search.scan(data, &session.scout, scales)
                || search.iterate(data, scales) && search.optimism() < enough
        };
        let over = match &mut self.stage {
            Stage::Build { search, .. } => !works(search, f64::INFINITY),
            Stage::Screened(searches) => {
                let enough = self
                    .screened
                    .as_ref()
                    .map_or(f64::INFINITY, |s| HOPED * s.fit.cost);
                !searches
                    .front_mut()
                    .is_some_and(|search| works(search, enough))
            }
            Stage::Revisit(search) => !works(search, present),
            Stage::Remove { search, .. } => !works(search, NEEDED * present),
            Stage::Record(race) | Stage::Try(race) | Stage::Swap { race, .. } => {
                session.data.tried_enough() || !race.advance(session)
            }
            Stage::Design(designs) => !designs.first_mut().is_some_and(Design::advance),
            Stage::Report => true,
        };
        if over {
            let stage = std::mem::replace(&mut self.stage, Stage::Report);
            self.stage = self.after(stage);
        }
        let (fraction, text) = self.progress();
        Progress::Running { fraction, text }
    }

    fn finished(&self, search: &Search) -> Option<Scored> {
        let fit = search.finish(&self.session.data, &self.session.scales)?;
        Some(self.session.scored(fit))
    }

    /// Takes the result of a stage and gives the next one.
    fn after(&mut self, stage: Stage) -> Stage {
        match stage {
            Stage::Build { search, next } => {
                let Some(scored) = self.finished(&search) else {
                    return Stage::Report;
                };
                if self.session.settle_body(&scored.fit) {
                    let search =
                        Search::held(&self.session.data, &scored.fit, &self.session.scales);
                    return Stage::Build { search, next };
                }
                let search = self.wanted.get(next).map(|effect| {
                    let probed = self.session.probed(&scored.fit);
                    Search::adding(
                        &self.session.data,
                        &scored.fit,
                        *effect,
                        &probed,
                        None,
                        None,
                        &self.session.scales,
                    )
                });
                self.session
                    .baseline
                    .get_or_insert_with(|| scored.score.clone());
                if search.is_none() {
                    self.wanted.clone_from(&scored.fit.structure.effects);
                    // One that took the place of a part has none before it.
                    let ids = |effects: &[&dyn Effect]| effects.iter().map(|e| e.id()).collect();
                    let others: Option<Vec<EffectId>> =
                        self.wanted.split_last().map(|(_, others)| ids(others));
                    self.before_last = self
                        .model
                        .take()
                        .filter(|before| Some(ids(&before.fit.structure.effects)) == others);
                }
                self.model = Some(scored);
                match search {
                    Some(search) => Stage::Build {
                        search,
                        next: next + 1,
                    },
                    None => self.screened_stage(),
                }
            }
            Stage::Screened(mut searches) => {
                let found = searches
                    .pop_front()
                    .and_then(|search| self.finished(&search));
                let both = self.screened.take().into_iter().chain(found);
                self.screened = both.min_by(|a, b| a.score.error.total_cmp(&b.score.error));
                if searches.is_empty() {
                    self.try_stage()
                } else {
                    Stage::Screened(searches)
                }
            }
            Stage::Record(race) => {
                self.tried = self.scored_all(race);
                let told = self.model.as_ref().and_then(|model| self.suggestion(model));
                if told.is_some_and(|(_, with)| is_plain_noise(&with.score)) {
                    self.revisit_stage()
                } else {
                    self.try_all_stage()
                }
            }
            Stage::Try(race) => {
                self.tried = self.scored_all(race);
                self.drop_what_the_whole_denies();
                self.contradicted = self.contradictions();
                self.revisit_stage()
            }
            Stage::Revisit(search) => {
                let again = self.finished(&search);
                match (again, &self.model) {
                    (Some(again), Some(model)) if again.fit.cost < BETTER * model.fit.cost => {
                        let other_valley = again.fit.cost < BETTER_VALLEY * model.fit.cost;
                        self.model = Some(again);
                        if other_valley {
                            self.try_stage()
                        } else {
                            self.remove_stage(0)
                        }
                    }
                    _ => self.remove_stage(0),
                }
            }
            Stage::Remove { index, search } => {
                let scored = self.finished(&search);
                // What the last effect has led astray may not find back without it.
                let before = self.before_last.take_if(|_| index + 1 == self.wanted.len());
                let both = scored.into_iter().chain(before);
                let better = both.min_by(|a, b| a.fit.cost.total_cmp(&b.fit.cost));
                self.without.extend(better);
                self.remove_stage(index + 1)
            }
            Stage::Swap { place, race } => {
                let fits = race.finish(&self.session);
                self.judge_swaps(place, fits);
                self.swap_stage(place + 1)
            }
            Stage::Design(mut designs) => {
                if !designs.is_empty() {
                    self.experiments.extend(designs.remove(0).finish());
                }
                if designs.is_empty() {
                    Stage::Report
                } else {
                    Stage::Design(designs)
                }
            }
            Stage::Report => Stage::Report,
        }
    }

    /// What a race came to.
    fn scored_all(&self, race: Race) -> Vec<(&'static dyn Effect, Scored)> {
        let scored = |(effect, fit)| (effect, self.session.scored(fit));
        let tried = race.finish(&self.session).into_iter().map(scored);
        let shows = |(effect, scored): &(&'static dyn Effect, Scored)| {
            scored.shows_marks_of(*effect, &self.session.scales)
        };
        tried.filter(shows).collect()
    }

    /// Of a long record all decides: what would be added by a part of it, and leaves more on the whole, is not tried.
    fn drop_what_the_whole_denies(&mut self) {
        let Some(model) = self.model.as_ref().filter(|_| self.session.is_thinned()) else {
            return;
        };
        let present = self.session.completed(model).score.error;
        while let Some((effect, with)) = self.suggestion(model) {
            if self.session.completed(with).score.error < present {
                break;
            }
            let denied = effect.id();
            self.tried.retain(|(effect, _)| effect.id() != denied);
        }
    }

    /// Whether the effect at `place` is part of the user's model.
    fn is_present(&self, place: usize) -> bool {
        let id = self.wanted.get(place).map(|e| e.id());
        id.is_some_and(|id| self.session.knowledge.has(id))
    }

    fn progress(&self) -> (f64, String) {
        let wanted = self.wanted.len().max(1) as f64;
        match &self.stage {
            Stage::Build { search, .. } => (0.1 * search.scanned(), "Fitting the model".to_owned()),
            Stage::Screened(_) => (0.1, "Fitting the model".to_owned()),
            Stage::Record(race) | Stage::Try(race) => {
                let (share, name) = race.progress();
                (0.1 + 0.6 * share, format!("Trying: {name}"))
            }
            Stage::Revisit(_) => (0.7, "Fitting the model once more".to_owned()),
            Stage::Remove { index, .. } => (
                0.7 + 0.05 * *index as f64 / wanted,
                "Checking that every effect is needed".to_owned(),
            ),
            Stage::Swap { place, race } => {
                let (share, name) = race.progress();
                (
                    0.75 + 0.25 * (*place as f64 + share) / wanted,
                    format!("Checking what else could explain it: {name}"),
                )
            }
            Stage::Design(designs) => (
                designs.first().map_or(1.0, Design::progress),
                TRYING.to_owned(),
            ),
            Stage::Report => (1.0, "Done".to_owned()),
        }
    }

    /// The model to go on from: with a suggestion that explains most of what is left, without the first needless effect,
    /// with another suggestion, or with a part of an effect; and the session.
    pub(super) fn successor(self) -> (Session, Option<Scored>) {
        let next = self.model.as_ref().and_then(|model| {
            let suggested = self.suggestion(model).map(|(_, scored)| scored);
            let suggested = self.together(model, suggested).or(suggested).cloned();
            // What is needed shows only where little is left.
            if let Some(suggested) = &suggested
                && fall(&model.score, &suggested.score) > HUGE_FALL
            {
                return Some(suggested.clone());
            }
            let needless = self.needless(model).into_iter().find(|id| {
                // The newest may show only together with the next.
                let newest = self.wanted.last().is_some_and(|w| w.id() == *id);
                !(newest && suggested.is_some())
            });
            if let Some(id) = needless {
                let index = self.wanted.iter().position(|w| w.id() == id)?;
                return self.without.get(index).cloned();
            }
            suggested.or_else(|| self.simpler.clone())
        });
        (self.session, next)
    }
}
