//! The search as a job of its own, for limits that a user changes.

use super::TRYING;
use super::bench::Hypothesis;
use super::design::Design;
use crate::criticism::input_noise::prepared;
use crate::diagnosis::{CriticismError, FittedModel, Limits, NextExperiment};
use crate::measurement::Measurement;
use crate::progress::Progress;
use crate::user_model::UserModel;

/// Looks for the experiment again, within other limits.
pub struct ExperimentJob(Option<Design>);

impl ExperimentJob {
    /// `models` as an earlier proposal on this measurement named them, `today` likewise; `model` is what the user
    /// knows.
    ///
    /// # Errors
    /// What a diagnosis of the measurement would say; a model that lacks a parameter.
    pub fn new(
        measurement: &Measurement,
        model: &UserModel,
        models: &[FittedModel],
        limits: Limits,
        today: f64,
    ) -> Result<Self, CriticismError> {
        let (session, _) = prepared(measurement, model)?;
        let models = models
            .iter()
            .map(|said| Hypothesis::of(&session, said))
            .collect::<Result<_, _>>()?;
        Ok(Self(Design::new(&session, models, limits, today)))
    }

    /// Does a small piece of work; `None` where the limits leave no room for an experiment.
    pub fn advance(&mut self) -> Progress<Option<NextExperiment>> {
        match &mut self.0 {
            Some(design) => {
                if design.advance() {
                    return Progress::Running {
                        fraction: design.progress(),
                        text: TRYING.into(),
                    };
                }
                Progress::Done(self.0.take().and_then(Design::finish))
            }
            None => Progress::Done(None),
        }
    }
}
