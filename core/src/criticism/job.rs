//! Long computations as resumable jobs: threads natively, a worker on the web, a loop in tests.

use super::{Diagnosis, StepReport};
use crate::effect::EffectId;
use crate::measurement::Measurement;

/// How far a job has come.
#[derive(Clone, Debug, PartialEq)]
pub enum Progress<T> {
    /// Not finished: share done, 0 to 1, and what it is doing, in plain words.
    Running {
        /// Share done, 0 to 1.
        fraction: f64,
        /// What it is doing, in plain words.
        text: String,
    },
    /// Finished.
    Done(T),
}

/// Why a measurement cannot be criticised.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CriticismError {
    /// The input never changes, so nothing can be learnt from it.
    #[error("the input is constant over the whole file: an experiment must move it")]
    ConstantInput,
}

/// Fits one model and tries every effect on top of it.
#[derive(Debug)]
pub struct StepJob {}

impl StepJob {
    /// The baseline plus `effects` (in the order in which the user added them) on `measurement`.
    pub fn new(_measurement: &Measurement, _effects: &[EffectId]) -> Result<Self, CriticismError> {
        Err(CriticismError::ConstantInput)
    }

    /// Does a small piece of work.
    pub fn advance(&mut self) -> Progress<StepReport> {
        Progress::Running {
            fraction: 0.0,
            text: String::new(),
        }
    }
}

/// From the baseline to the verdict.
#[derive(Debug)]
pub struct DiagnosisJob {}

impl DiagnosisJob {
    /// Prepares a diagnosis.
    pub fn new(_measurement: &Measurement) -> Result<Self, CriticismError> {
        Err(CriticismError::ConstantInput)
    }

    /// Does a small piece of work.
    pub fn advance(&mut self) -> Progress<Diagnosis> {
        Progress::Running {
            fraction: 0.0,
            text: String::new(),
        }
    }
}
