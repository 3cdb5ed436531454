//! What one experiment cannot tell apart, the proposed one does: it is carried out on a rig of other physics, and
//! then only the truth is left.

#![allow(
    clippy::large_types_passed_by_value,
    reason = "definitions of rigs are plain values"
)]

use crate::support::diagnosis::{classes, finish};
use crate::support::proposed;
use hysteron_core::criticism::{DiagnosisJob, ExperimentJob};
use hysteron_core::diagnosis::{CriticismError, Diagnosis, Limits, NextExperiment, Program};
use hysteron_core::measurement::Measurement;
use hysteron_core::progress::Progress;
use hysteron_core::rig::process::{self, ProcessRig};
use hysteron_core::rig::{self, DriveRig, SAMPLING, relay};
use hysteron_core::user_model::UserModel;

/// These two act alike where the input has two opposite levels.
const OFFSET: [&str; 2] = ["gain_asymmetry", "constant_load"];

fn diagnose(measurement: &Measurement, limits: Limits) -> Diagnosis {
    finish(DiagnosisJob::new(measurement).unwrap().within(limits))
}

/// The only proposal, after a check that the record cannot tell the class.
fn proposal(measurement: &Measurement, limits: Limits, class: &[&str]) -> NextExperiment {
    let first = diagnose(measurement, limits);
    assert_eq!(classes(&first), [class], "{}", first.verdict.text);
    let [proposal] = first.verdict.experiments.as_slice() else {
        panic!("one proposal: {:?}", first.verdict);
    };
    assert_eq!(
        first.verdict.next_experiment.as_ref(),
        Some(&proposal.text),
        "in words"
    );
    proposal.clone()
}

/// A rig at which a person can carry out what is proposed.
trait Bench: Copy {
    fn measure(&self) -> Measurement;
    /// The same rig, with other noise.
    fn set(self, proposal: &NextExperiment) -> Self;
}

impl Bench for DriveRig {
    fn measure(&self) -> Measurement {
        self.measure()
    }

    fn set(self, proposal: &NextExperiment) -> Self {
        Self {
            seed: self.seed + 1000,
            excitation: rig::Excitation::Proposed(proposed::of(proposal)),
            samples: (proposal.duration / SAMPLING).round() as usize,
            ..self
        }
    }
}

impl Bench for ProcessRig {
    fn measure(&self) -> Measurement {
        self.measure()
    }

    fn set(self, proposal: &NextExperiment) -> Self {
        Self {
            seed: self.seed + 1000,
            excitation: process::Excitation::Proposed(proposed::of(proposal)),
            samples: (proposal.duration / process::SAMPLING).round() as usize,
            ..self
        }
    }
}

/// Diagnoses the new record: only the truth is left, with its value.
fn check_truth(measurement: &Measurement, truth: &str, value: f64) {
    let second = diagnose(measurement, Limits::of(measurement));
    assert_eq!(classes(&second), [[truth]], "{}", second.verdict.text);
    assert!(second.verdict.complete, "{}", second.verdict.text);
    assert!(second.verdict.experiments.is_empty() && second.verdict.next_experiment.is_none());
    let last = second.steps.last().unwrap();
    let own =
        |p: &&hysteron_core::diagnosis::Parameter| p.effect.is_some_and(|e| e.as_str() == truth);
    let found = last.parameters.iter().find(own).unwrap().value;
    assert!((found / value - 1.0).abs() < 0.05, "{found} for {value}");
}

/// The record of `rig` cannot tell the class; the proposed one tells the truth.
fn check(rig: impl Bench, class: &[&str], truth: &str, value: f64) {
    let record = rig.measure();
    let proposal = proposal(&record, Limits::of(&record), class);
    assert!(proposal.sufficient, "{}", proposal.text);
    assert!(
        proposal.separation > 5.0 * proposal.today,
        "{}",
        proposal.text
    );
    check_truth(&rig.set(&proposal).measure(), truth, value);
}

#[test]
fn gain_asymmetry_of_a_drive_is_told_from_a_constant_load() {
    let rig = DriveRig {
        seed: 71,
        gain_asymmetry: 0.06,
        excitation: relay(0.0),
        ..DriveRig::default()
    };
    check(rig, &OFFSET, "gain_asymmetry", 0.06);
}

#[test]
fn a_constant_load_on_a_drive_is_told_from_gain_asymmetry() {
    let rig = DriveRig {
        seed: 72,
        constant_load: 0.03,
        excitation: relay(0.0),
        ..DriveRig::default()
    };
    check(rig, &OFFSET, "constant_load", 0.03);
}

const BINARY: process::Excitation = process::Excitation::Binary { level: 1.0 };

#[test]
fn gain_asymmetry_of_a_process_is_told_from_a_constant_load() {
    let rig = ProcessRig {
        seed: 73,
        gain_asymmetry: 0.1,
        excitation: BINARY,
        ..ProcessRig::default()
    };
    check(rig, &OFFSET, "gain_asymmetry", 0.1);
}

#[test]
fn a_constant_load_on_a_process_is_told_from_gain_asymmetry() {
    let rig = ProcessRig {
        seed: 74,
        constant_load: 0.1,
        excitation: BINARY,
        ..ProcessRig::default()
    };
    check(rig, &OFFSET, "constant_load", 0.1);
}

/// A lag before a linear process and one behind it commute: no input can tell them.
#[test]
fn what_no_input_can_tell_is_said_so() {
    let rig = ProcessRig {
        seed: 75,
        sensor_lag: 4.0,
        excitation: BINARY,
        ..ProcessRig::default()
    };
    let record = rig.measure();
    let proposal = proposal(&record, Limits::of(&record), &["second_lag", "sensor_lag"]);
    // It would take two million samples and more.
    assert!(
        !proposal.sufficient && proposal.separation < 5e-3,
        "{proposal:?}"
    );
    assert!(
        proposal
            .text
            .to_string()
            .contains("Measure another quantity"),
        "{}",
        proposal.text
    );
}

/// The limits of the user hold for input, speed and length, and tight ones are named as what stands in the way.
#[test]
fn an_experiment_keeps_to_the_limits() {
    let rig = ProcessRig {
        seed: 76,
        gain_asymmetry: 0.1,
        excitation: BINARY,
        ..ProcessRig::default()
    };
    let record = rig.measure();
    let mut limits = Limits::of(&record);
    limits.set("input=0.5, speed=0.8").unwrap();
    let first = proposal(&record, limits, &OFFSET);
    let largest = match &first.program {
        Program::Relay {
            gains, asymmetry, ..
        } => gains
            .iter()
            .fold(0.0_f64, |m, k| m.max(k * (1.0 + asymmetry))),
        Program::Levels { levels, .. } => levels.iter().fold(0.0_f64, |m, u| m.max(u.abs())),
        Program::Multisine { sines } => sines.iter().map(|s| s.amplitude).sum(),
    };
    assert!(largest <= 0.5, "{}", first.text);
    assert!(
        first.speed <= 0.8 && first.duration <= limits.duration,
        "{first:?}"
    );
    assert!(first.sufficient, "{}", first.text);
    // Asked again with hardly any input, by the models that the proposal names.
    limits.set("input=0.01, speed=none").unwrap();
    let blank = UserModel::blank(record.kind);
    let again = |models: &[_]| ExperimentJob::new(&record, &blank, models, limits, first.today);
    let mut job = again(&first.models).unwrap();
    let faint = loop {
        if let Progress::Done(found) = job.advance() {
            break found.expect("an experiment");
        }
    };
    assert!(!faint.sufficient, "{}", faint.text);
    assert!(
        faint.text.to_string().contains("larger input"),
        "{}",
        faint.text
    );
    let mut poor = first.models.clone();
    poor[0].parameters.clear();
    let error = again(&poor).err();
    assert!(matches!(error, Some(CriticismError::NoValue { .. })));
}

#[test]
fn limits_are_read_and_wrong_ones_are_refused_with_what_would_be_right() {
    let record = DriveRig {
        samples: 500,
        ..DriveRig::default()
    }
    .measure();
    let mut limits = Limits::of(&record);
    assert!((limits.step - SAMPLING).abs() < 1e-12 && (limits.input - 0.55).abs() < 1e-12);
    limits.set("duration=2, speed = none").unwrap();
    assert_eq!((limits.duration, limits.speed), (2.0, None));
    for (text, expected) in [
        ("duration", "NAME=VALUE"),
        ("input=-1", "a number above 0"),
        ("speed=fast", "a number above 0, or none"),
        ("colour=3", "one of input, duration"),
    ] {
        let error = limits.set(text).unwrap_err().to_string();
        assert!(error.contains(expected), "{error}");
    }
}
