//! The search as a resumable job.

use super::judge::{self, Simulated};
use super::pool;
use super::search::Search;
use super::tuning::{APART, PER_PART};
use super::weak::{Seen, Weak};
use super::written::Written;
use crate::crew::Crew;
use crate::criticism::explain::{Trial, begun, with_one};
use crate::criticism::input_noise::prepared;
use crate::criticism::next_experiment::{Design, Hypothesis, TRYING};
use crate::criticism::screen::{Screened, Signals};
use crate::criticism::session::{Rest, Session};
use crate::diagnosis::{CriticismError, Discovery, Limits};
use crate::effect::{Effect, EffectId, Formula};
use crate::measurement::Measurement;
use crate::message::Message;
use crate::msg;
use crate::progress::Progress;
use crate::user_model::UserModel;

const LOOKING: &str = "Looking for a formula";

/// What is under way.
enum Stage {
    /// The model to which formulas are added.
    Base,
    /// By regression.
    Search(Box<(Weak, Search)>),
    /// Exactly.
    Simulate(Box<Weak>),
    /// What would tell the class apart.
    Design(Box<(Discovery, Option<Design>)>),
}

/// Looks for a formula of what a model leaves: the baseline, what a user knows, and effects that were added.
pub struct DiscoveryJob {
    session: Session,
    screened: Screened,
    signals: Option<Signals>,
    limits: Limits,
    held: Vec<&'static dyn Effect>,
    taken: Vec<String>,
    base: Option<Trial>,
    stage: Stage,
    open: Vec<(EffectId, &'static dyn Effect, Written)>,
    waiting: usize,
    simulated: Vec<Simulated>,
}

impl DiscoveryJob {
    /// Prepares a search beside the effects of the user's model and `effects`.
    ///
    /// # Errors
    /// What a diagnosis of the measurement would say.
    pub fn new(
        measurement: &Measurement,
        effects: &[EffectId],
        model: &UserModel,
    ) -> Result<Self, CriticismError> {
        let (session, screened) = prepared(measurement, model)?;
        let held = session.chosen(model, effects)?;
        let mut signals = Signals::new(measurement);
        // Position without noise, where samples are even.
        let smooth = session.whole().excitation.followed();
        if smooth.len() == signals.place.len() {
            signals.place = smooth.to_vec();
        }
        let own = model.effects.iter().chain(&model.candidates);
        Ok(Self {
            session,
            screened,
            signals: Some(signals),
            limits: Limits::of(measurement),
            held,
            taken: own.map(|p| p.id.as_str().to_owned()).collect(),
            base: None,
            stage: Stage::Base,
            open: Vec::new(),
            waiting: 0,
            simulated: Vec::new(),
        })
    }

    /// The same with other limits of the next experiment than [`Limits::of`] the measurement.
    #[must_use]
    pub fn within(mut self, limits: Limits) -> Self {
        self.limits = limits;
        self
    }

    /// The same with the independent parts of the work done by `crew`.
    #[must_use]
    pub fn with_crew(mut self, crew: &Crew) -> Self {
        self.session.employ(crew);
        self
    }

    /// Does some work.
    pub fn advance(&mut self) -> Progress<Discovery> {
        let crew = self.session.data.crew.clone();
        match &mut self.stage {
            Stage::Base => self.begin(),
            Stage::Search(both) => {
                let (weak, search) = both.as_mut();
                if !search.advance(weak, &crew) {
                    self.choose();
                }
                Self::running(0.1 + 0.4 * self.searched(), LOOKING)
            }
            Stage::Simulate(_) => self.simulate(&crew),
            Stage::Design(both) => {
                let (discovery, design) = both.as_mut();
                if let Some((true, share)) = design.as_mut().map(|d| (d.advance(), d.progress())) {
                    return Self::running(0.9 + 0.1 * share, TRYING);
                }
                if let Some(design) = design.take() {
                    discovery.experiment = design.finish();
                }
                Progress::Done(discovery.clone())
            }
        }
    }

    fn running(fraction: f64, text: impl Into<Message>) -> Progress<Discovery> {
        Progress::Running {
            fraction,
            text: text.into(),
        }
    }

    fn searched(&self) -> f64 {
        match &self.stage {
            Stage::Search(both) => both.1.progress(),
            _ => 1.0,
        }
    }

    /// Fits the model to which formulas are added.
    fn begin(&mut self) -> Progress<Discovery> {
        let base = begun(&self.session, &self.screened, &self.held);
        let (Some(base), Some(signals)) = (base, self.signals.take()) else {
            let discovery = Discovery::none();
            self.stage = Stage::Design(Box::new((discovery.clone(), None)));
            return Progress::Done(discovery);
        };
        self.session.settle_sizes(&base.scored.fit);
        self.session
            .baseline
            .get_or_insert_with(|| base.scored.score.clone());
        if self.session.rest(&self.session.completed(&base.scored)) != Rest::More {
            let discovery = judge::nothing_left(&base);
            self.stage = Stage::Design(Box::new((discovery.clone(), None)));
            return Progress::Done(discovery);
        }
        let seen = Seen::new(signals);
        let ids: Vec<EffectId> = self.held.iter().map(|e| e.id()).collect();
        let held = self
            .screened
            .columns(&ids, &seen.rows())
            .unwrap_or_default();
        let weak = Weak::new(seen, self.session.data.baseline, &held);
        let search = Search::new(self.session.kind(), &weak);
        self.base = Some(base);
        self.stage = Stage::Search(Box::new((weak, search)));
        Self::running(0.1, LOOKING)
    }

    /// Writes the best sums as formulas.
    fn choose(&mut self) {
        let stage = std::mem::replace(&mut self.stage, Stage::Base);
        let Stage::Search(both) = stage else {
            self.stage = stage;
            return;
        };
        let (weak, search) = *both;
        let kind = self.session.kind();
        let chosen = pool::chosen(&search, &weak, self.session.data.baseline, kind);
        let mut number = 0;
        for written in chosen {
            let name = loop {
                number += 1;
                let name = format!("formula_{number}");
                if !self.taken.contains(&name) {
                    break name;
                }
            };
            let formula = Formula {
                name: name.clone(),
                text: written.text.clone(),
            };
            if let (Some(id), Ok(effect)) = (EffectId::own(&name), formula.effect(kind)) {
                self.open.push((id, effect, written));
            }
        }
        self.waiting = self.open.len();
        self.stage = Stage::Simulate(Box::new(weak));
    }

    /// Simulates some formulas.
    fn simulate(&mut self, crew: &Crew) -> Progress<Discovery> {
        let Some(base) = &self.base else {
            return Progress::Done(Discovery::none());
        };
        if self.open.is_empty() {
            return self.conclude();
        }
        let count = crew.width().min(PER_PART).min(self.open.len()).max(1);
        let part: Vec<_> = self.open.drain(..count).collect();
        let session = &self.session;
        let trials = crew.gather(part.len(), |i| {
            let (_, effect, written) = &part[i];
            let value = |symbol: &str| {
                written
                    .values
                    .iter()
                    .find(|(s, _)| *s == symbol)
                    .map_or(0.0, |(_, v)| *v)
            };
            let own: Vec<f64> = effect
                .parameters()
                .iter()
                .map(|p| value(p.symbol))
                .collect();
            with_one(session, base, *effect, &written.body, &own)
        });
        let text = part.first().map_or_else(Message::default, |(_, _, w)| {
            msg!("Trying: {}", Message::name(&w.text))
        });
        for ((id, _, written), trial) in part.into_iter().zip(trials) {
            self.simulated
                .extend(trial.map(|trial| Simulated { id, written, trial }));
        }
        let share = 1.0 - self.open.len() as f64 / self.waiting.max(1) as f64;
        Self::running(0.5 + 0.4 * share, text)
    }

    /// Judges what was simulated.
    fn conclude(&mut self) -> Progress<Discovery> {
        let (Some(base), Stage::Simulate(weak)) = (&self.base, &self.stage) else {
            return Progress::Done(Discovery::none());
        };
        let class = judge::class(&self.session, &self.simulated);
        let head = class.first().map(|k| &self.simulated[*k].written.sum);
        let foretold = head.and_then(|sum| weak.foretold(&sum.columns(weak)));
        let discovery = judge::answer(
            &self.session,
            weak,
            base,
            &self.simulated,
            &class,
            foretold.as_deref(),
        );
        let design = self.design(&discovery, &class);
        self.stage = Stage::Design(Box::new((discovery, design)));
        Self::running(0.9, TRYING)
    }

    /// The search for what would tell the class apart, if it has more than one.
    fn design(&self, discovery: &Discovery, class: &[usize]) -> Option<Design> {
        discovery.answer?;
        let of = |k: &usize| &self.simulated[*k];
        let models: Vec<Hypothesis> = class
            .iter()
            .take(APART)
            .map(|k| Hypothesis::new(&self.session, of(k).id, &of(k).trial.scored))
            .collect();
        if models.len() < 2 {
            return None;
        }
        let least = of(class.first()?).trial.error();
        let beyond = class.iter().map(|k| {
            (of(k).trial.error().powi(2) - least.powi(2))
                .max(0.0)
                .sqrt()
        });
        Design::new(
            &self.session,
            models,
            self.limits,
            beyond.fold(0.0, f64::max),
        )
    }
}
