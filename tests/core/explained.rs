//! What is hidden on rigs that are not the model is found, and nothing else.

use crate::support::case::{Case, Hidden};
use crate::support::diagnosis::{classes, finish, step};
use crate::support::{drive_cases, process_cases};
use hysteron_core::criticism::{DiagnosisJob, StepJob};
use hysteron_core::diagnosis::Diagnosis;
use hysteron_core::measurement::Measurement;

/// A seed to develop on.
const SEED: u64 = 5;

fn case(name: &str) -> Case {
    let mut all = drive_cases::drive_cases(SEED);
    all.extend(process_cases::process_cases(SEED));
    all.into_iter().find(|c| c.name == name).unwrap()
}

fn diagnose(measurement: &Measurement) -> Diagnosis {
    finish(DiagnosisJob::new(measurement).unwrap())
}

#[test]
fn what_is_hidden_is_found_and_nothing_else() {
    for name in [
        "clean, multisine",
        "Coulomb, multisine",
        "delay, multisine",
        "load, staircase",
        "Coulomb and load",
        "cogging, multisine",
        "gravity",
        "spring",
        "clean process, relay",
        "second lag, binary",
        "dead time, relay",
        "outflow",
    ] {
        let case = case(name);
        let diagnosis = diagnose(&case.measure());
        let Hidden::Known { truths, .. } = &case.hidden else {
            panic!("{name}: nothing is hidden");
        };
        let found = classes(&diagnosis);
        let verdict = &diagnosis.verdict;
        assert!(verdict.complete && !verdict.unknown, "{name}: {verdict:?}");
        assert_eq!(found.len(), truths.len(), "{name}: {found:?}");
        for truth in truths {
            let is_named = found.iter().any(|class| class.contains(&truth.effect));
            assert!(is_named, "{name}: {found:?}");
        }
    }
}

#[test]
fn a_step_offers_what_the_diagnosis_adds_first() {
    let measurement = case("Coulomb and load").measure();
    let diagnosis = diagnose(&measurement);
    let report = step(StepJob::new(&measurement, &[]).unwrap());
    let first = diagnosis.steps[1].effects.last().copied();
    assert!(first.is_some());
    assert_eq!(report.suggestion, first);
    assert!(report.verdict.is_none());
}
