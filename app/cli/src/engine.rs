//! Which engine diagnoses: the first, or the second, which is on trial.

use clap::ValueEnum;
use hysteron_core::criticism::{self, second};
use hysteron_core::diagnosis::{CriticismError, Diagnosis, Limits, StepReport};
use hysteron_core::measurement::Measurement;
use hysteron_core::progress::Progress;
use hysteron_core::user_model::UserModel;
use hysteron_work::cores;

/// The engine that is asked for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Which {
    /// Adds what helps, effect by effect.
    #[default]
    First,
    /// Fits the subsets that the screen finds, and judges them on blocks that they did not see; on trial.
    Second,
}

/// A diagnosis that goes on piece by piece.
pub enum Engine {
    First(Box<criticism::DiagnosisJob>),
    Second(Box<second::DiagnosisJob>),
}

impl Engine {
    /// A diagnosis of a measurement by one of them.
    pub fn of(
        which: Which,
        measurement: &Measurement,
        model: &UserModel,
        limits: Limits,
    ) -> Result<Self, CriticismError> {
        Ok(match which {
            Which::First => {
                let job = criticism::DiagnosisJob::with_model(measurement, model)?;
                Self::First(Box::new(job.within(limits).with_crew(&cores::all())))
            }
            Which::Second => {
                let job = second::DiagnosisJob::with_model(measurement, model)?;
                Self::Second(Box::new(job.within(limits).with_crew(&cores::all())))
            }
        })
    }

    /// Does some work.
    pub fn advance(&mut self) -> Progress<Diagnosis> {
        match self {
            Self::First(job) => job.advance(),
            Self::Second(job) => job.advance(),
        }
    }

    /// Once it is done: the reports on the baseline and on the last model.
    pub fn evidence(&self) -> Option<(&StepReport, &StepReport)> {
        match self {
            Self::First(job) => job.evidence(),
            Self::Second(job) => job.evidence(),
        }
    }
}
