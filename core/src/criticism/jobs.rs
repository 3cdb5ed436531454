//! Long computations as resumable jobs: threads natively, a worker on the web, a loop in tests.

use super::contradicted::contradictions;
use super::explain::Explain;
use super::input_noise::prepared;
use super::next_experiment::{Design, TRYING};
use super::screen::Screened;
use super::session::Session;
use super::tell::Tell;
use crate::crew::Crew;
use crate::diagnosis::{CriticismError, Diagnosis, Limits, StepReport};
use crate::effect::EffectId;
use crate::measurement::Measurement;
use crate::message::Message;
use crate::progress::Progress;
use crate::user_model::UserModel;

/// The search for what explains a record, and for the experiment that tells apart what this one cannot.
struct Search {
    session: Session,
    screened: Screened,
    explain: Explain,
    designs: Option<Vec<Design>>,
    tell: Tell,
}

impl Search {
    fn new(
        measurement: &Measurement,
        effects: &[EffectId],
        model: &UserModel,
    ) -> Result<Self, CriticismError> {
        let (session, screened) = prepared(measurement, model)?;
        let held = session.chosen(model, effects)?;
        let explain = Explain::new(held);
        Ok(Self {
            explain,
            session,
            screened,
            designs: None,
            tell: Tell::within(Limits::of(measurement)),
        })
    }

    /// Does some work; true while there is more.
    fn advance(&mut self) -> bool {
        if self.explain.advance(&mut self.session, &self.screened) {
            return true;
        }
        let designs = self.designs.get_or_insert_with(|| {
            self.tell.contradicted = self
                .explain
                .trials
                .get(self.explain.best)
                .map_or_else(Vec::new, |best| contradictions(&self.session, best));
            self.tell.compare_frictions(&self.session, &self.explain);
            self.tell.designs(&self.session, &self.explain)
        });
        let Some(design) = designs.first_mut() else {
            return false;
        };
        if !design.advance() {
            self.tell.experiments.extend(designs.remove(0).finish());
        }
        true
    }

    fn progress(&self) -> (f64, Message) {
        match self.designs.as_ref().and_then(|d| d.first()) {
            Some(design) => (design.progress(), TRYING.into()),
            None => self.explain.progress(),
        }
    }
}

/// Fits one model and tries what could be added; where nothing helps, gives the verdict.
pub struct StepJob(Search);

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
        Search::new(measurement, effects, model).map(Self)
    }

    /// The same with other limits of the next experiment than [`Limits::of`] the measurement.
    #[must_use]
    pub fn within(mut self, limits: Limits) -> Self {
        self.0.tell = Tell::within(limits);
        self
    }

    /// The same with the independent parts of the work done by `crew`.
    #[must_use]
    pub fn with_crew(mut self, crew: &Crew) -> Self {
        self.0.session.employ(crew);
        self
    }

    /// Does some work.
    pub fn advance(&mut self) -> Progress<StepReport> {
        if self.0.advance() {
            let (fraction, text) = self.0.progress();
            return Progress::Running { fraction, text };
        }
        let Search {
            session,
            explain,
            tell,
            ..
        } = &self.0;
        let held = explain.held_ids();
        match tell.report(session, explain, &held) {
            Some(report) => Progress::Done(report),
            None => Progress::Running {
                fraction: 1.0,
                text: Message::default(),
            },
        }
    }
}

/// From the baseline to the verdict.
pub struct DiagnosisJob {
    search: Search,
    diagnosis: Diagnosis,
    /// Effects in the order in which they are added.
    order: Option<Vec<EffectId>>,
    /// Effects of the next model that is told.
    told: usize,
    first: Option<StepReport>,
    last: Option<StepReport>,
}

impl DiagnosisJob {
    /// Prepares a diagnosis.
    pub fn new(measurement: &Measurement) -> Result<Self, CriticismError> {
        Self::with_model(measurement, &UserModel::blank(measurement.kind))
    }

    /// Prepares a diagnosis that begins with what the user knows.
    pub fn with_model(
        measurement: &Measurement,
        model: &UserModel,
    ) -> Result<Self, CriticismError> {
        let search = Search::new(measurement, &[], model)?;
        let input_check = search.session.input_check.clone();
        Ok(Self {
            diagnosis: Diagnosis::begun(measurement.kind, measurement.len(), input_check),
            told: search.explain.held_ids().len(),
            search,
            order: None,
            first: None,
            last: None,
        })
    }

    /// The same with other limits of the next experiment than [`Limits::of`] the measurement.
    #[must_use]
    pub fn within(mut self, limits: Limits) -> Self {
        self.search.tell = Tell::within(limits);
        self
    }

    /// The same with the independent parts of the work done by `crew`.
    #[must_use]
    pub fn with_crew(mut self, crew: &Crew) -> Self {
        self.search.session.employ(crew);
        self
    }

    /// The same as if the library had none of these effects: what is said then of a machine that has them?
    #[must_use]
    pub fn lacking(mut self, effects: &[EffectId]) -> Self {
        self.search.session.lacking = effects.to_vec();
        self
    }

    /// Does some work.
    pub fn advance(&mut self) -> Progress<Diagnosis> {
        if self.search.advance() {
            let (fraction, text) = self.search.progress();
            return Progress::Running {
                fraction: 0.9 * fraction,
                text,
            };
        }
        let Search {
            session,
            explain,
            tell,
            ..
        } = &self.search;
        if explain.trials.is_empty() {
            return Progress::Done(self.diagnosis.clone());
        }
        let order = self.order.get_or_insert_with(|| explain.order());
        let told = self.told;
        if told > order.len() {
            return Progress::Done(self.diagnosis.clone());
        }
        self.told += 1;
        if let Some(report) = tell.report(session, explain, &order[..told]) {
            self.diagnosis.steps.push(report.step.clone());
            self.diagnosis.noise.clone_from(&report.noise);
            if self.first.is_none() {
                self.first = Some(report.without_curves());
            }
            if told == order.len() {
                self.diagnosis.noise_floor = report.noise_floor;
                if let Some(verdict) = &report.verdict {
                    self.diagnosis.verdict.clone_from(verdict);
                }
                self.last = Some(report);
            }
        }
        Progress::Running {
            fraction: 0.95,
            text: "Done".into(),
        }
    }

    /// Once it is done: the reports on the baseline (without its curves) and on the last model.
    pub fn evidence(&self) -> Option<(&StepReport, &StepReport)> {
        self.first.as_ref().zip(self.last.as_ref())
    }
}
