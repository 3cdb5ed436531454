//! A diagnosis of what a rig writes as a file.

use hysteron_core::criticism::DiagnosisJob;
use hysteron_core::diagnosis::Diagnosis;
use hysteron_core::measurement::import_csv;

use super::diagnosis::finish;

/// Diagnoses a file with this text.
pub fn diagnose(csv: &str) -> Diagnosis {
    finish(DiagnosisJob::new(&import_csv("record", csv.as_bytes(), None).unwrap()).unwrap())
}
