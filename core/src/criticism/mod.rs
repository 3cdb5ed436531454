//! Where does the model fail, which effect is missing, how much, how sure?

mod job;
mod report;

pub use job::{CriticismError, DiagnosisJob, Progress, StepJob};
pub use report::{
    Candidate, Diagnosis, Finding, Parameter, Replay, ReplayChannel, Step, StepReport, Verdict,
};
