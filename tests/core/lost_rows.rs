//! Records in which rows are missing: what the input did there is not known.

use std::ops::Range;

use crate::support::diagnosis::{classes, finish};
use crate::support::value::check_value;
use hysteron_core::criticism::DiagnosisJob;
use hysteron_core::diagnosis::Diagnosis;
use hysteron_core::measurement::Measurement;
use hysteron_core::rig::{DriveRig, Excitation, Friction};

const SAMPLES: usize = 6000;
const LEVEL: f64 = 0.04;

/// A drive with dry friction that is tracked while its input changes with every sample.
fn record() -> Measurement {
    DriveRig {
        friction: Friction::dry(LEVEL),
        excitation: Excitation::Multisine { amplitude: 0.3 },
        samples: SAMPLES,
        ..DriveRig::default()
    }
    .measure()
}

fn without(mut record: Measurement, lost: &[Range<usize>]) -> Measurement {
    let kept: Vec<bool> = (0..record.time.len())
        .map(|k| !lost.iter().any(|range| range.contains(&k)))
        .collect();
    let cut = |values: &mut Vec<f64>| {
        let mut kept = kept.iter();
        values.retain(|_| *kept.next().unwrap());
    };
    cut(&mut record.time);
    cut(&mut record.input.values);
    for output in &mut record.outputs {
        cut(&mut output.values);
    }
    record
}

fn check(d: &Diagnosis, said: &str) {
    assert_eq!(classes(d), [["coulomb_friction"]], "{}", d.verdict.text);
    assert!(d.verdict.complete, "{}", d.verdict.text);
    assert!(
        d.verdict.text.to_string().contains(said),
        "{}",
        d.verdict.text
    );
    check_value(d, "c", LEVEL);
}

#[test]
fn a_few_lost_rows_are_no_effect() {
    let four = [700..701, 1501..1504, 3002..3003, 4444..4474];
    for (lost, said) in [
        (&four[1..2], "missing in one place"),
        (&four, "missing in 4 places"),
    ] {
        let d = finish(DiagnosisJob::new(&without(record(), lost)).unwrap());
        check(&d, said);
    }
}

/// Two records one after the other, some time apart.
#[test]
fn nor_is_a_pause() {
    let mut pause = record();
    for time in &mut pause.time[2500..] {
        *time += 0.7;
    }
    check(&finish(DiagnosisJob::new(&pause).unwrap()), "in one place");
}

#[test]
fn where_none_is_lost_none_is_said() {
    let d = finish(DiagnosisJob::new(&record()).unwrap());
    assert!(
        !d.verdict.text.to_string().contains("Rows"),
        "{}",
        d.verdict.text
    );
}
