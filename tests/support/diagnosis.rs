//! A diagnosis from its begin to its end, and what it found.

use hysteron_core::criticism::{DiagnosisJob, StepJob};
use hysteron_core::diagnosis::{Diagnosis, StepReport};
use hysteron_core::measurement::import_csv;
use hysteron_core::progress::Progress;

use crate::support::shared::shared;

/// Runs a diagnosis to its end.
pub fn finish(mut job: DiagnosisJob) -> Diagnosis {
    loop {
        if let Progress::Done(diagnosis) = job.advance() {
            return diagnosis;
        }
    }
}

/// Diagnoses a record beside the project, see [`shared`].
pub fn diagnose_shared(path: &str) -> Option<Diagnosis> {
    let record = import_csv(path, &shared(path)?, None).unwrap();
    Some(finish(DiagnosisJob::new(&record).unwrap()))
}

/// Runs one step to its end.
pub fn step(mut job: StepJob) -> StepReport {
    loop {
        if let Progress::Done(report) = job.advance() {
            return report;
        }
    }
}

/// The classes of missing effects, in the order found.
pub fn classes(diagnosis: &Diagnosis) -> Vec<Vec<&str>> {
    let missing = diagnosis.verdict.missing.iter();
    missing
        .map(|class| class.iter().map(|e| e.as_str()).collect())
        .collect()
}
