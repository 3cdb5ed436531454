//! A slow process that was looked at for a few of its time constants: what is left hangs together, so that a record of
//! a thousand samples holds a handful of independent stretches.

use crate::support::diagnosis::{classes, diagnose_shared, finish, step};
use crate::support::parameter::parameter;
use crate::support::pulses::{OTHER_GAIN, reversed_twice};
use hysteron_core::criticism::{DiagnosisJob, StepJob};
use hysteron_core::diagnosis::Diagnosis;
use hysteron_core::measurement::{Measurement, import_csv};
use hysteron_core::rig::process::{Excitation, ProcessRig, Stranger};

/// A process of two minutes that is watched for three, with a load that swings as slowly besides.
fn record(constant_load: f64, swing: f64, period: f64) -> Measurement {
    let rig = ProcessRig {
        time_constant: 120.0,
        samples: 1000,
        excitation: Excitation::Staircase { top: 1.0 },
        constant_load,
        stranger: Some(Stranger::Swing {
            amplitude: swing,
            period,
        }),
        ..ProcessRig::default()
    };
    rig.measure()
}

fn diagnose(constant_load: f64, swing: f64, period: f64) -> Diagnosis {
    finish(DiagnosisJob::new(&record(constant_load, swing, period)).unwrap())
}

#[test]
fn what_takes_away_nearly_all_is_named_though_the_rest_hangs_together() {
    let d = diagnose(1.5, 0.3, 180.0);
    assert_eq!(classes(&d), [["constant_load"]], "{}", d.verdict.text);
    assert!(d.verdict.unknown, "the load swings as well");
    let load = parameter(&d, "F0");
    assert!(
        (load.value - 1.5).abs() < 2.0 * load.std_error,
        "{} +- {}",
        load.value,
        load.std_error
    );
}

#[test]
fn a_load_that_swings_once_or_twice_is_no_effect() {
    let d = diagnose(0.0, 0.4, 120.0);
    assert!(
        d.verdict.missing.is_empty() && d.verdict.unknown,
        "{}",
        d.verdict.text
    );
    assert!(
        d.verdict.text.to_string().contains("drifts slowly"),
        "{}",
        d.verdict.text
    );
}

#[test]
fn what_may_be_chance_is_said_as_that() {
    let record = import_csv("pulses", reversed_twice(4).as_bytes(), None).unwrap();
    let d = finish(DiagnosisJob::new(&record).unwrap());
    assert!(
        d.verdict.missing.is_empty() && d.verdict.unknown,
        "{}",
        d.verdict.text
    );
    assert!(
        d.verdict.text.to_string().contains("Perhaps ")
            && d.verdict.text.to_string().contains("to rule out chance"),
        "{}",
        d.verdict.text
    );
    let candidates = &d.steps.last().unwrap().candidates;
    let offered = candidates.iter().find(|c| c.promising && !c.significant);
    // What is offered can be added, and leaves what was said.
    let offered = offered.expect("an offer");
    let with = step(StepJob::new(&record, &offered.effects).unwrap());
    let change = (with.step.error / offered.error - 1.0).abs();
    assert!(change < 0.05, "{} for {}", with.step.error, offered.error);
}

/// Twice as long, the moments bend a model that has one gain in all of the record: every stretch speaks for two.
#[test]
fn what_bends_all_of_a_record_is_no_chance() {
    let record = import_csv("pulses", reversed_twice(8).as_bytes(), None).unwrap();
    let d = finish(DiagnosisJob::new(&record).unwrap());
    assert_eq!(classes(&d), [["gain_asymmetry"]], "{}", d.verdict.text);
    let asymmetry = parameter(&d, "a").value;
    let gains = (1.0 - asymmetry) / (1.0 + asymmetry);
    assert!((gains / OTHER_GAIN - 1.0).abs() < 0.05, "{gains}");
}

/// A student's heater whose input steps eight times: what a dead time or a second lag explains is in the few stretches
/// that hold a step, and a room wanders in all others.
#[test]
fn a_lag_in_a_few_steps_is_said_as_a_class_that_may_be_chance() {
    let Some(d) = diagnose_shared("failing/heater-steps-second-lag.csv") else {
        return;
    };
    let text = d.verdict.text.to_string();
    assert!(d.verdict.missing.is_empty(), "{text}");
    let perhaps = text.split("Perhaps ").nth(1).expect(&text);
    for name in ["Input delay", "Second lag"] {
        assert!(perhaps.contains(name), "{text}");
    }
}
