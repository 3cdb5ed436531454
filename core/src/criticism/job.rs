//! Long computations as resumable jobs: threads natively, a worker on the web, a loop in tests.

use super::Diagnosis;
use super::step::{NOISE_FLOOR, StepJob};
use crate::effect::EffectId;
use crate::measurement::Measurement;

/// Most effects that a diagnosis adds; a model that needs more is not this one.
const MAX_EFFECTS: usize = 6;

/// Most models that a diagnosis visits, so that adding and removing cannot go round for ever.
const MAX_STEPS: usize = 12;

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
    /// An output never changes.
    #[error(
        "the column {name} is constant over the whole file: there is nothing to compare the model with"
    )]
    ConstantOutput {
        /// Its name in the file.
        name: String,
    },
    /// An effect that makes no sense for this kind of system.
    #[error("{effect} cannot be added to this kind of system")]
    WrongEffect {
        /// The effect.
        effect: EffectId,
    },
}

/// From the baseline to the verdict: adds what helps, removes what is not needed, until nothing does.
pub struct DiagnosisJob {
    job: Option<StepJob>,
    diagnosis: Diagnosis,
}

impl DiagnosisJob {
    /// Prepares a diagnosis.
    pub fn new(measurement: &Measurement) -> Result<Self, CriticismError> {
        Ok(Self {
            job: Some(StepJob::new(measurement, &[])?),
            diagnosis: Diagnosis {
                schema: 1,
                kind: measurement.kind,
                samples: measurement.len(),
                noise_floor: NOISE_FLOOR,
                steps: Vec::new(),
                verdict: super::Verdict {
                    missing: Vec::new(),
                    complete: false,
                    unknown: false,
                    next_experiment: None,
                    text: String::new(),
                },
                seconds: 0.0,
            },
        })
    }

    /// Does a small piece of work.
    pub fn advance(&mut self) -> Progress<Diagnosis> {
        let Some(job) = &mut self.job else {
            return Progress::Done(self.diagnosis.clone());
        };
        let report = match job.advance() {
            Progress::Running { fraction, text } => {
                let done = self.diagnosis.steps.len() as f64;
                // The number of steps is not known: each takes half of what is left.
                let fraction = 1.0 - 0.5_f64.powf(done + fraction);
                return Progress::Running { fraction, text };
            }
            Progress::Done(report) => report,
        };
        let effects = report.step.effects.len();
        self.diagnosis.steps.push(report.step);
        if let Some(verdict) = report.verdict {
            self.diagnosis.verdict = verdict;
            self.job = None;
            return Progress::Done(self.diagnosis.clone());
        }
        let ended = self.diagnosis.steps.len() >= MAX_STEPS || effects > MAX_EFFECTS;
        let next = self
            .job
            .take()
            .filter(|_| !ended)
            .and_then(StepJob::successor);
        match next {
            Some((session, model)) => self.job = Some(StepJob::from_fit(session, model)),
            None => self.diagnosis.verdict = super::verdict::undecided(&self.diagnosis.steps),
        }
        Progress::Running {
            fraction: 1.0 - 0.5_f64.powf(self.diagnosis.steps.len() as f64),
            text: "Next".to_owned(),
        }
    }
}
