//! One step of a diagnosis: fits one model and tries every effect on top of it.

use super::fingerprint::fingerprints;
use super::judge::{
    alike, helps_clearly, is_certain, may_hide, nested, part_does, same_body, tied,
};
use super::knowledge::contradictions;
use super::missing::missing_parts;
use super::next_experiment::{Design, Rival, TRYING, designs};
use super::race::Race;
use super::residual_test::residual_tests;
use super::score::Score;
use super::search::Search;
use super::select::{delta_bic, helps, is_noise, is_plain_noise, outweighs};
use super::session::{Scored, Session};
use super::verdict::{Class, add_experiments, add_idle, add_imitations, add_rest, verdict};
use super::{
    Candidate, Contradiction, CriticismError, Limits, NextExperiment, Progress, Step, StepReport,
};
use crate::crew::Crew;
use crate::effect::{self, Effect, EffectId};
use crate::measurement::Measurement;
use crate::user_model::UserModel;

/// Error of a perfect model in noise units.
pub(super) const NOISE_FLOOR: f64 = 1.0;

/// The effect that is tried together with others where nothing helps by itself.
const COMPANION: EffectId = EffectId::new("constant_load");

/// Times that a model is fitted once more from where an effect on top of it led, and the share of its cost below
/// which that is another valley.
const MAX_VISITS: usize = 2;
const BETTER_VALLEY: f64 = 0.92;

/// What a step is doing.
enum Stage {
    /// Fitting the model itself, effect by effect; `next` is the one to add then.
    Build { search: Search, next: usize },
    /// Trying every effect on top.
    Try(Race),
    /// Fitting the model once more from where an effect on top of it led.
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
    tried: Vec<(&'static dyn Effect, Scored)>,
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
        let present = model.present();
        let added = effects.iter().filter(|id| !present.contains(id));
        let wanted = present
            .iter()
            .chain(added)
            .filter(|id| **id != effect::VISCOUS_FRICTION)
            .map(|id| {
                session
                    .find(*id)
                    .ok_or(CriticismError::WrongEffect { effect: *id })
            })
            .collect::<Result<Vec<_>, _>>()?;
        session.check_units(&wanted)?;
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
            tried: Vec::new(),
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
        self.session
            .library()
            .filter(|e| {
                own.is_some_and(|own| !nested(*own, *e) || own.has_part(e.id()))
                    && self
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
        let over = match &mut self.stage {
            Stage::Build { search, .. } | Stage::Revisit(search) | Stage::Remove { search, .. } => {
                let (data, scales) = (&session.data, &session.scales);
                !search.scan(data, &session.scout, scales) && !search.iterate(data, scales)
            }
            Stage::Try(race) | Stage::Swap { race, .. } => !race.advance(session),
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
                let search = self.wanted.get(next).map(|effect| {
                    let probe = self.session.probe(&scored.fit);
                    Search::adding(&self.session.data, &scored.fit, *effect, &probe, None, None)
                });
                self.session
                    .baseline
                    .get_or_insert_with(|| scored.score.clone());
                if search.is_none() {
                    self.wanted.clone_from(&scored.fit.structure.effects);
                }
                self.model = Some(scored);
                match search {
                    Some(search) => Stage::Build {
                        search,
                        next: next + 1,
                    },
                    None => self.try_stage(),
                }
            }
            Stage::Try(race) => {
                let fits = race.finish();
                self.tried = fits
                    .into_iter()
                    .map(|(effect, fit)| (effect, self.session.scored(fit)))
                    .collect();
                self.contradicted = self.contradictions();
                self.revisit_stage()
            }
            Stage::Revisit(search) => {
                let again = self.finished(&search);
                match (again, &self.model) {
                    (Some(again), Some(model))
                        if again.fit.cost < BETTER_VALLEY * model.fit.cost =>
                    {
                        self.model = Some(again);
                        self.try_stage()
                    }
                    _ => self.remove_stage(0),
                }
            }
            Stage::Remove { index, search } => {
                let scored = self.finished(&search);
                self.without.extend(scored);
                self.remove_stage(index + 1)
            }
            Stage::Swap { place, race } => {
                let fits = race.finish();
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

    /// A part of an effect that leaves nothing but noise is not widened to the whole.
    fn try_stage(&self) -> Stage {
        self.model.as_ref().map_or(Stage::Report, |model| {
            let mut others = self.others();
            if is_plain_noise(&model.score) {
                others.retain(|e| !self.widens(*e));
            }
            Stage::Try(Race::new(&self.session, &model.fit, others, None))
        })
    }

    /// Where the model with an effect on top costs much less, the model itself may have stopped in a worse valley than it
    /// need have: it is fitted again from where the effect led.
    fn revisit_stage(&mut self) -> Stage {
        let search = self.model.as_ref().and_then(|model| {
            let costs = self.tried.iter().map(|(_, with)| &with.fit);
            let best = costs.min_by(|a, b| a.cost.total_cmp(&b.cost))?;
            let bends = !model.fit.structure.effects.is_empty();
            let lower = best.cost < BETTER_VALLEY * model.fit.cost;
            (bends && lower && self.visits < MAX_VISITS)
                .then(|| Search::revisiting(&model.fit, best))
        });
        self.visits += usize::from(search.is_some());
        search.map_or_else(|| self.remove_stage(0), Stage::Revisit)
    }

    /// Whether an effect contains one that is in the model.
    fn widens(&self, effect: &dyn Effect) -> bool {
        let parts = effect.contains();
        self.wanted.iter().any(|w| parts.contains(&w.id()))
    }

    fn remove_stage(&self, index: usize) -> Stage {
        match &self.model {
            Some(model) if index < self.wanted.len() => Stage::Remove {
                index,
                search: Search::removing(&model.fit, index),
            },
            _ => self.swap_stage(0),
        }
    }

    /// Swaps are tried only for a final model: nothing helps it, and all in it is needed.
    fn swap_stage(&self, place: usize) -> Stage {
        let Some(model) = &self.model else {
            return Stage::Report;
        };
        if !self.contradicted.is_empty()
            || self.suggestion(model).is_some()
            || !self.needless(model).is_empty()
        {
            return Stage::Report;
        }
        // What the user says is in the model is not up for exchange.
        let mut rest = (place..self.wanted.len()).skip_while(|k| self.is_present(*k));
        let place = rest.next().unwrap_or(self.wanted.len());
        match self.without.get(place) {
            Some(without) => Stage::Swap {
                place,
                race: Race::new(
                    &self.session,
                    &without.fit,
                    self.rivals(place),
                    Some((&model.fit, place)),
                ),
            },
            None => self.design_stage(model),
        }
    }

    /// One search for each effect in whose place others could stand; none where the model does not explain the
    /// record, or is not the last.
    fn design_stage(&self, model: &Scored) -> Stage {
        let explains = is_noise(&model.score, self.session.first(model));
        if !explains || self.simpler.is_some() {
            return Stage::Report;
        }
        let designs = designs(
            &self.session,
            model,
            &self.wanted,
            &self.rivals,
            self.limits,
        );
        if designs.is_empty() {
            Stage::Report
        } else {
            Stage::Design(designs)
        }
    }

    /// Whether the effect at `place` is part of the user's model.
    fn is_present(&self, place: usize) -> bool {
        let id = self.wanted.get(place).map(|e| e.id());
        id.is_some_and(|id| self.session.knowledge.has(id))
    }

    fn judge_swaps(&mut self, place: usize, fits: Vec<(&'static dyn Effect, super::fit::Fit)>) {
        let Some(model) = &self.model else {
            return;
        };
        let own = self.wanted[place];
        let mut class = Class::default();
        for (effect, fit) in fits {
            let swapped = self.session.scored(fit);
            if own.has_part(effect.id()) {
                let fewer = |s: &Scored| s.fit.values.len() > swapped.fit.values.len();
                if part_does(model, &swapped, place, self.session.first(model))
                    && self.simpler.as_ref().is_none_or(fewer)
                {
                    self.simpler = Some(swapped);
                }
            } else if alike(model, &swapped) && same_body(model, &swapped) {
                class.push(effect);
                self.rivals.push(Rival {
                    place,
                    effect: effect.id(),
                    model: swapped,
                });
            }
        }
        self.classes.resize_with(place, Class::default);
        self.classes.push(class);
    }

    /// Known values that the data contradict more than they want any effect.
    fn contradictions(&self) -> Vec<Contradiction> {
        let Some(model) = &self.model else {
            return Vec::new();
        };
        let best = self
            .suggestion(model)
            .map_or(f64::INFINITY, |(_, s)| s.score.error);
        contradictions(&self.session, model, best)
    }

    /// The effect to add next: the best that helps; of equals the one with fewer parameters, or that stands
    /// first in the registry.
    fn suggestion(&self, model: &Scored) -> Option<&(&'static dyn Effect, Scored)> {
        if !self.contradicted.is_empty() {
            return None;
        }
        let first = self.session.first(model);
        let helping = || {
            self.tried
                .iter()
                .filter(|(e, _)| !self.barred.contains(&e.id()))
                .filter(|(_, s)| helps_clearly(model, s, first))
        };
        let best = helping().min_by(|a, b| a.1.score.error.total_cmp(&b.1.score.error))?;
        helping()
            .filter(|(e, s)| {
                if best.0.has_part(e.id()) {
                    let place = best.1.fit.structure.effects.len() - 1;
                    part_does(&best.1, s, place, first)
                } else {
                    let (own, most) = (s.fit.values.len(), best.1.fit.values.len());
                    alike(s, &best.1) && (own < most || (own == most && tied(s, &best.1)))
                }
            })
            .min_by_key(|(_, s)| s.fit.values.len())
            .or(Some(best))
    }

    /// Effects without which the held-back error does not rise; those of the user's model stay.
    fn needless(&self, model: &Scored) -> Vec<EffectId> {
        if !self.contradicted.is_empty() {
            return Vec::new();
        }
        let (_, own) = self.idle(model);
        own
    }

    /// Effects without which the held-back error does not rise: of the user's model, and others.
    fn idle(&self, model: &Scored) -> (Vec<EffectId>, Vec<EffectId>) {
        // Where nothing but noise is left, and more without an effect, it is needed wherever it acts.
        let explains = |without: &Score| {
            is_plain_noise(&model.score)
                && !is_plain_noise(without)
                && outweighs(without.error, model.score.error)
        };
        let idle = |without: &Score| !helps(without, &model.score) && !explains(without);
        self.wanted
            .iter()
            .zip(&self.without)
            .filter(|(_, without)| idle(&without.score))
            .map(|(e, _)| e.id())
            .partition(|id| self.session.knowledge.has(*id))
    }

    fn progress(&self) -> (f64, String) {
        let wanted = self.wanted.len().max(1) as f64;
        match &self.stage {
            Stage::Build { search, .. } => (0.1 * search.scanned(), "Fitting the model".to_owned()),
            Stage::Try(race) => {
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

    fn report(&self) -> Option<StepReport> {
        let model = self.model.as_ref()?;
        let suggestion = self.suggestion(model).map(|(e, _)| e.id());
        let needless = self.needless(model);
        let whole = self.session.completed(model);
        let parameters = self.session.parameters(&whole);
        let findings = self.session.findings(&whole);
        let verdict = (suggestion.is_none() && needless.is_empty()).then(|| {
            let places = (0..self.wanted.len()).filter(|k| !self.is_present(*k));
            let mut places: Vec<usize> = places.collect();
            places.sort_by_key(|k| self.found(self.wanted[*k]));
            let (added, classes): (Vec<_>, Vec<_>) = places
                .into_iter()
                .map(|k| {
                    (
                        self.wanted[k],
                        self.classes.get(k).cloned().unwrap_or_default(),
                    )
                })
                .unzip();
            let mut verdict = verdict(
                &added,
                &classes,
                &parameters,
                &whole,
                is_noise(&whole.score, self.session.first(&whole)),
                self.contradicted.clone(),
            );
            let first = self.session.first(&whole).error;
            add_rest(&mut verdict, &whole.score, first, &findings);
            add_imitations(&mut verdict, &self.barred);
            add_idle(&mut verdict, &self.idle(model).0);
            add_experiments(&mut verdict, &self.experiments);
            verdict
        });
        let unknown = verdict.as_ref().is_some_and(|v| v.unknown);
        let tried: Vec<(EffectId, &Scored)> = self.tried.iter().map(|(e, s)| (e.id(), s)).collect();
        // Effects are compared on a part of a long record: their errors are put in proportion to all of it.
        let share = whole.score.error / model.score.error;
        let mut candidates = self.candidates(model, suggestion);
        for candidate in candidates.iter_mut().filter(|_| share.is_finite()) {
            candidate.error *= share;
        }
        Some(StepReport {
            fingerprints: fingerprints(&self.session, model, &tried, &findings),
            missing: if unknown {
                missing_parts(&self.session, &whole)
            } else {
                Vec::new()
            },
            step: Step {
                effects: self.session.effects(&model.fit),
                error: whole.score.error,
                error_fit: whole.score.error_fit,
                parameters,
                findings,
                tests: residual_tests(self.session.whole(), &whole.fit.motion),
                candidates,
            },
            noise_floor: NOISE_FLOOR,
            replay: self.session.replay(&whole.fit),
            atlas: self.session.atlas(&whole.fit),
            suggestion,
            needless,
            verdict,
        })
    }

    /// Every effect tried, best first; the suggested one leads.
    fn candidates(&self, model: &Scored, suggestion: Option<EffectId>) -> Vec<Candidate> {
        let length = model.fit.values.len();
        let first = self.session.first(model);
        let mut candidates: Vec<Candidate> = self
            .tried
            .iter()
            .map(|(effect, scored)| {
                let worse = scored.score.fit_cost > model.score.fit_cost;
                let equivalent_to = self
                    .tried
                    .iter()
                    .filter(|(other, o)| {
                        !nested(*other, *effect)
                            && helps_clearly(model, scored, first)
                            && helps_clearly(model, o, first)
                            && alike(scored, o)
                    })
                    .map(|(other, _)| other.id())
                    .collect();
                Candidate {
                    effects: vec![effect.id()],
                    // Every effect contains "none of it", so it never has to make things worse.
                    error: if worse {
                        model.score.error
                    } else {
                        scored.score.error
                    },
                    delta_bic: if worse {
                        effect.parameters().len() as f64 * libm::log(model.score.fit_count)
                    } else {
                        delta_bic(&model.score, length, &scored.score, scored.fit.values.len())
                    },
                    significant: helps_clearly(model, scored, first),
                    parameters: self
                        .session
                        .parameters(scored)
                        .into_iter()
                        .filter(|p| p.effect == Some(effect.id()))
                        .collect(),
                    equivalent_to,
                }
            })
            .collect();
        let untried: Vec<Candidate> = self
            .others()
            .into_iter()
            .filter(|e| self.tried.iter().all(|(tried, _)| tried.id() != e.id()))
            .map(|e| as_its_best_part(e, &candidates, model))
            .collect();
        candidates.extend(untried);
        candidates.sort_by(|a, b| {
            let first = |c: &Candidate| suggestion.is_none_or(|s| c.effects[0] != s);
            first(a).cmp(&first(b)).then(a.error.total_cmp(&b.error))
        });
        candidates
    }

    /// The model to go on from: with the suggestion, without the first needless effect, or with a part of
    /// one; and the session.
    pub(super) fn successor(self) -> (Session, Option<Scored>) {
        let next = self.model.as_ref().and_then(|model| {
            let suggested = self.suggestion(model).map(|(_, scored)| scored.clone());
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

    /// In a last model that leaves more than noise, this `error` on the whole record, the effect that explains
    /// least, if that is less than what is left or its size is not known to differ from 0, and the model without it:
    /// it may as well imitate a part of what no effect explains.
    pub(super) fn imitation(&self, error: f64) -> Option<(EffectId, Scored)> {
        self.wanted
            .iter()
            .zip(&self.without)
            .enumerate()
            .filter(|(_, (e, _))| !self.session.knowledge.has(e.id()))
            // Where a long record was thinned, all of it decides.
            .map(|(place, (e, without))| {
                let completed = self.session.completed(without).score.error;
                (place, e.id(), without, completed)
            })
            .filter(|(place, _, without, completed)| {
                let certain = |model| is_certain(without, model, *place);
                !outweighs(*completed, error) || !self.model.as_ref().is_none_or(certain)
            })
            .min_by(|a, b| a.3.total_cmp(&b.3))
            .map(|(_, id, without, _)| (id, without.clone()))
    }

    /// Models with an effect that lowers the error much, though not beyond chance while the rest is as
    /// correlated as it is: the best first. Two missing effects may hide each other so.
    pub(super) fn faint(&self, count: usize) -> Vec<Scored> {
        let Some(model) = self.model.as_ref().filter(|_| self.contradicted.is_empty()) else {
            return Vec::new();
        };
        let mut seen: Vec<&Scored> = self
            .tried
            .iter()
            .map(|(_, s)| s)
            .filter(|s| may_hide(model, s))
            .collect();
        seen.sort_by(|a, b| a.score.error.total_cmp(&b.score.error));
        seen.truncate(count);
        // A constant load hides behind almost anything that repeats.
        let loaded = self.tried.iter().find(|(e, _)| e.id() == COMPANION);
        seen.extend(loaded.map(|(_, s)| s));
        seen.into_iter().cloned().collect()
    }

    /// Models with another effect that would help too, the best first: where the suggestion may turn
    /// out to lead astray.
    pub(super) fn alternatives(&self, count: usize) -> Vec<Scored> {
        let Some(model) = &self.model else {
            return Vec::new();
        };
        let Some((suggested, _)) = self.suggestion(model) else {
            return Vec::new();
        };
        let first = self.session.first(model);
        let mut others: Vec<&Scored> = self
            .tried
            .iter()
            .filter(|(e, s)| !nested(*e, *suggested) && helps_clearly(model, s, first))
            .map(|(_, s)| s)
            .collect();
        others.sort_by(|a, b| a.score.error.total_cmp(&b.score.error));
        others.into_iter().take(count).cloned().collect()
    }
}

/// An effect that was not worth a fit, among the `candidates` that were: it does at least what the best of its parts
/// does, and was not seen to do more.
fn as_its_best_part(
    effect: &'static dyn Effect,
    candidates: &[Candidate],
    model: &Scored,
) -> Candidate {
    let more = |from: usize| {
        let values = effect.parameters().len().saturating_sub(from);
        values as f64 * libm::log(model.score.fit_count)
    };
    let part = candidates
        .iter()
        .filter(|c| c.effects.iter().all(|id| effect.has_part(*id)))
        .min_by(|a, b| a.error.total_cmp(&b.error));
    Candidate {
        effects: vec![effect.id()],
        error: part.map_or(model.score.error, |p| p.error),
        delta_bic: part.map_or(more(0), |p| p.delta_bic + more(p.parameters.len())),
        significant: part.is_some_and(|p| p.significant),
        parameters: Vec::new(),
        equivalent_to: Vec::new(),
    }
}
