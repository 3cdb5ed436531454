//! Which effects explain a record? Exact fits of the few subsets that the screen found, judged on blocks that they did
//! not see.
//!
//! Subsets are fitted by their size. A larger one is taken where it is better than the best smaller one and each of its
//! effects is needed; then every other effect that may is tried in the place of each.

mod heat;
mod hidden_body;
mod judge;
mod levels;
mod rival;
mod seldom;
mod sketch;
mod swap;
mod task;
mod trial;
mod tuning;
mod weigh;

use std::collections::VecDeque;

use super::contradicted::released;
use super::screen::Screened;
use super::session::Session;
use crate::effect::{Effect, EffectId};
use crate::message::Message;
use heat::Heat;
use hidden_body::is_hidden_body;
pub(super) use judge::{Difference, difference, outweighs_in_either_half};
use rival::Rival;
use sketch::{Sketch, first_guess};
pub(super) use swap::may_replace;
use task::Task;
pub(super) use trial::Trial;
pub(super) use tuning::LEAST_FALL;
use tuning::{FITTED, FITTED_HIDDEN};

/// The model with these effects, to which others are added.
pub(super) fn begun(
    session: &Session,
    screened: &Screened,
    held: &[&'static dyn Effect],
) -> Option<Trial> {
    Task::Base(held.to_vec()).run(session, screened, &[])
}

/// A trial with one more effect, from these values of the effect and of the body.
pub(super) fn with_one(
    session: &Session,
    trial: &Trial,
    effect: &'static dyn Effect,
    body: &[f64],
    own: &[f64],
) -> Option<Trial> {
    let sketch = Sketch::with_values(&trial.scored.fit, effect, body, own);
    let fit = sketch.fitted(session);
    fit.cost.is_finite().then(|| Trial::new(session, fit))
}

/// What is under way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Stage {
    /// Fitting the model that effects are added to.
    Base,
    /// Fitting subsets of a level.
    Fit(Level),
    /// Doing without each effect of the subset that leads.
    Check(Level),
    /// Fitting what few machines have.
    Seldom,
    /// Doing without each effect of the best of those.
    CheckSeldom(usize),
    /// Fitting the best without each effect that others are to replace.
    TakeOut,
    /// Trying others in the place of each effect.
    Swap,
    /// Fitting the models on the way to the best.
    Path,
    /// Everything is known.
    Done,
}

/// Subsets that are compared with each other first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Level {
    /// Number of effects that are added.
    size: usize,
    /// One of them brings a hidden body. Their fits are the longest by far, and the freest: of each size they come
    /// last, where everything that acts on the body that is measured leaves more than noise.
    hidden: bool,
}

impl Level {
    fn next(self) -> Self {
        Self {
            size: self.size + usize::from(self.hidden),
            hidden: !self.hidden,
        }
    }
}

/// A search that goes on piece by piece.
pub(super) struct Explain {
    held: Vec<&'static dyn Effect>,
    pub trials: Vec<Trial>,
    tasks: VecDeque<Task>,
    /// Models in a race on the scout.
    heat: Heat,
    /// Trials of which it is known what each effect adds; and what each hidden body.
    extended: [Vec<usize>; 2],
    /// Cost on the scout up to which they are fitted.
    limit: f64,
    stage: Stage,
    /// The subset of each size that leads; and of those with a hidden body.
    leads: [Vec<Option<usize>>; 2],
    /// Leads of the present size that were looked at.
    looked_at: Vec<usize>,
    pub best: usize,
    /// Sizes in a row that brought nothing; and of those with a hidden body.
    misses: [usize; 2],
    pub rivals: Vec<Rival>,
    /// Sets of effects that were tried in the place of a best model, in order: another best one may come to the same.
    replacements: Vec<Vec<EffectId>>,
    swaps: usize,
    done: usize,
}

impl Explain {
    /// Explains what a model with these effects leaves.
    pub fn new(held: Vec<&'static dyn Effect>) -> Self {
        let tasks = VecDeque::from([Task::Base(held.clone())]);
        Self {
            held,
            trials: Vec::new(),
            tasks,
            heat: Heat::default(),
            extended: [Vec::new(), Vec::new()],
            limit: f64::INFINITY,
            stage: Stage::Base,
            leads: [Vec::new(), Vec::new()],
            looked_at: Vec::new(),
            best: 0,
            misses: [0, 0],
            rivals: Vec::new(),
            replacements: Vec::new(),
            swaps: 0,
            done: 0,
        }
    }

    /// Does some work; true while there is more.
    pub fn advance(&mut self, session: &mut Session, screened: &Screened) -> bool {
        if self.stage == Stage::Done {
            return false;
        }
        let crew = session.data.crew.clone();
        if self.heat.is_empty() {
            let width = crew.width().min(self.tasks.len());
            let batch: Vec<Task> = self.tasks.drain(..width).collect();
            let (own, trials) = (&*session, &self.trials);
            let found = crew.gather(batch.len(), |i| batch[i].run(own, screened, trials));
            self.trials.extend(found.into_iter().flatten());
        } else if !self
            .heat
            .advance(session, self.alike(), self.places(), self.gives_up(session))
        {
            let fitted = match self.stage {
                Stage::Fit(Level { hidden: true, .. }) => FITTED_HIDDEN,
                _ => FITTED,
            };
            let best = self.heat.best(fitted * self.places(), self.limit);
            self.tasks.extend(best.into_iter().map(Task::Fit));
        }
        self.done += 1;
        while self.tasks.is_empty() && self.heat.is_empty() && self.stage != Stage::Done {
            self.go_on(session, screened);
        }
        self.stage != Stage::Done
    }

    /// Whether a race is no longer worth while.
    fn gives_up(&self, session: &Session) -> bool {
        let hidden = matches!(self.stage, Stage::Fit(level) if level.hidden);
        hidden && session.data.tried_enough(true)
    }

    /// Places of the model for which effects race.
    fn places(&self) -> usize {
        match self.stage {
            Stage::Swap => self.size(self.best).max(1),
            _ => 1,
        }
    }

    /// Cost on the scout of what may stand in the place of an effect of the best.
    fn alike(&self) -> f64 {
        match self.stage {
            Stage::Swap => self.limit,
            _ => 0.0,
        }
    }

    /// Has a trial raced with each effect that can be added, or each hidden body: with the values that the screen
    /// tells, and where it tells none with those that are found in what the trial leaves.
    fn extend(&mut self, session: &Session, screened: &Screened, from: usize, hidden: bool) {
        let extended = &mut self.extended[usize::from(hidden)];
        if extended.contains(&from) {
            return;
        }
        extended.push(from);
        let fit = &self.trials[from].scored.fit;
        let mut sketches: Vec<Sketch> =
            Sketch::again(fit).filter(|_| !hidden).into_iter().collect();
        for effect in session
            .library()
            .filter(|e| is_hidden_body(*e) == hidden && self.is_open(from, *e))
        {
            sketches.extend(Sketch::beside(session, screened, fit, effect));
        }
        Sketch::with_other_bodies(&mut sketches, fit, first_guess(session));
        self.take(session, sketches);
    }

    /// Has these scanned.
    fn take(&mut self, session: &Session, sketches: impl IntoIterator<Item = Sketch>) {
        let all = sketches
            .into_iter()
            .flat_map(|sketch| sketch.variants(session));
        self.heat.add(session, &all.collect::<Vec<_>>());
    }

    /// Share of what is to be done, roughly, and what is under way.
    pub fn progress(&self) -> (f64, Message) {
        let text = match self.stage {
            Stage::Base => "Fitting the model".into(),
            Stage::Fit(_) | Stage::Seldom => {
                self.tasks.front().map_or_else(Message::default, Task::text)
            }
            Stage::Check(_) | Stage::CheckSeldom(_) => {
                "Checking that every effect is needed".into()
            }
            Stage::TakeOut | Stage::Swap => "Checking what else could explain it".into(),
            Stage::Path | Stage::Done => "Done".into(),
        };
        let done = self.done as f64;
        (done / (done + 8.0), text)
    }

    /// Number of effects that a trial has more than the model.
    fn size(&self, trial: usize) -> usize {
        self.trials[trial]
            .effects()
            .len()
            .saturating_sub(self.held.len())
    }

    fn go_on(&mut self, session: &mut Session, screened: &Screened) {
        match self.stage {
            Stage::Base => {
                if self.trials.is_empty() {
                    self.stage = Stage::Done;
                    return;
                }
                self.best = 0;
                session.settle_sizes(&self.trials[0].scored.fit);
                session
                    .baseline
                    .get_or_insert_with(|| self.trials[0].scored.score.clone());
                self.open_level(
                    session,
                    screened,
                    Level {
                        size: 1,
                        hidden: false,
                    },
                );
            }
            Stage::Fit(level) => self.judge_level(session, screened, level),
            Stage::Check(level) => self.judge_check(session, screened, level),
            Stage::Seldom => self.judge_seldom(session),
            Stage::CheckSeldom(lead) => {
                if self.is_needed(session, lead) {
                    self.best = lead;
                }
                self.open_swaps(session);
            }
            Stage::TakeOut => self.swap(session, screened),
            Stage::Swap => self.judge_swaps(session),
            Stage::Path => self.stage = Stage::Done,
            Stage::Done => {}
        }
    }

    /// Whether the model that effects are added to leaves noise as soon as it gives up what the user knows of it.
    fn knows_wrongly(&self, session: &Session) -> bool {
        if self.best != 0 || session.knowledge.is_free() {
            return false;
        }
        Self::leaves_noise(session, &released(session, &self.trials[0]))
    }

    /// Whether an effect can be added to a trial.
    fn is_open(&self, trial: usize, effect: &dyn Effect) -> bool {
        let effects = self.trials[trial].effects();
        effects.iter().all(|own| {
            own.id() != effect.id() && !own.has_part(effect.id()) && !effect.has_part(own.id())
        })
    }

    /// Has a trial fitted without each of the effects that were added; `again` where there is one: it may not have
    /// found the valley in which this one is.
    fn take_out_of(&mut self, lead: usize, again: bool) {
        for place in self.held.len()..self.trials[lead].effects().len() {
            if again || self.without(lead, place).is_none() {
                self.tasks.push_back(Task::Without { from: lead, place });
            }
        }
    }

    fn holds(&self, trial: usize) -> bool {
        self.held.iter().all(|e| self.trials[trial].has(e.id()))
    }

    /// Effects of the best model in the order in which they are added: each leaves least beside those before.
    pub fn order(&self) -> Vec<EffectId> {
        let mut order: Vec<EffectId> = self.held.iter().map(|e| e.id()).collect();
        let mut rest: Vec<EffectId> = self.trials[self.best]
            .ids()
            .into_iter()
            .filter(|id| !order.contains(id))
            .collect();
        while !rest.is_empty() {
            let error = |id: &EffectId| {
                let with: Vec<EffectId> = order.iter().copied().chain([*id]).collect();
                self.of(&with)
                    .map_or(f64::INFINITY, |t| self.trials[t].error())
            };
            let next = (0..rest.len())
                .min_by(|a, b| error(&rest[*a]).total_cmp(&error(&rest[*b])))
                .unwrap_or(0);
            order.push(rest.remove(next));
        }
        order
    }

    /// The trial of these effects: the best model, or the one that leaves least.
    pub fn of(&self, ids: &[EffectId]) -> Option<usize> {
        let same = |t: &Trial| t.effects().len() == ids.len() && ids.iter().all(|id| t.has(*id));
        if self.trials.get(self.best).is_some_and(same) {
            return Some(self.best);
        }
        let found = (0..self.trials.len()).filter(|t| same(&self.trials[*t]));
        found.min_by(|a, b| self.trials[*a].error().total_cmp(&self.trials[*b].error()))
    }

    /// The trial with the effects of this one but that at a place.
    fn without(&self, trial: usize, place: usize) -> Option<usize> {
        let mut ids = self.trials[trial].ids();
        ids.remove(place);
        self.of(&ids)
    }

    fn open_path(&mut self, session: &Session) {
        self.stage = Stage::Path;
        let order = self.order();
        for count in self.held.len()..order.len() {
            if self.of(&order[..count]).is_none() {
                let sketch =
                    Sketch::part(session, &self.trials[self.best].scored.fit, &order[..count]);
                self.tasks.extend(sketch.map(Task::Fit));
            }
        }
        // Of the model as it was given it is asked as well which of its effects leave a trace.
        self.take_out(0..self.held.len());
    }

    /// Has the best fitted without the effect at each of these places, where that was not done yet.
    fn take_out(&mut self, places: impl IntoIterator<Item = usize>) {
        let from = self.best;
        for place in places {
            if self.without(from, place).is_none() {
                self.tasks.push_back(Task::Without { from, place });
            }
        }
    }

    /// Effects that were tried beside these alone, each with its best trial.
    pub fn with_one_more(&self, ids: &[EffectId]) -> Vec<(&'static dyn Effect, &Trial)> {
        let mut found: Vec<(&'static dyn Effect, &Trial)> = Vec::new();
        for trial in &self.trials {
            let effects = trial.effects();
            if effects.len() != ids.len() + 1 || !ids.iter().all(|id| trial.has(*id)) {
                continue;
            }
            let Some(more) = effects.iter().find(|e| !ids.contains(&e.id())) else {
                continue;
            };
            match found.iter_mut().find(|(e, _)| e.id() == more.id()) {
                Some(known) if known.1.error() > trial.error() => known.1 = trial,
                Some(_) => {}
                None => found.push((*more, trial)),
            }
        }
        found.sort_by(|a, b| a.1.error().total_cmp(&b.1.error()));
        found
    }

    /// Effects of the model that others are added to.
    pub fn held_ids(&self) -> Vec<EffectId> {
        self.held.iter().map(|e| e.id()).collect()
    }
}
