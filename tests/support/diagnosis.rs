//! A diagnosis from its begin to its end, and what it found.

use hysteron_core::criticism::{Diagnosis, DiagnosisJob, Progress};
use hysteron_core::measurement::Measurement;

/// Runs a diagnosis to its end.
pub fn finish(mut job: DiagnosisJob) -> Diagnosis {
    loop {
        if let Progress::Done(diagnosis) = job.advance() {
            return diagnosis;
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

/// The record if only one sample in so many had been written down.
pub fn thinned(mut record: Measurement, every: usize) -> Measurement {
    let kept = |values: &mut Vec<f64>| *values = values.iter().copied().step_by(every).collect();
    kept(&mut record.time);
    kept(&mut record.input.values);
    record.outputs.iter_mut().for_each(|c| kept(&mut c.values));
    record
        .reference
        .iter_mut()
        .for_each(|c| kept(&mut c.values));
    record
}
