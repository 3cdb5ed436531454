//! A process that swings before it settles: a mass on a spring, a pendulum, a coil with a capacitor. The records are of
//! a rig that knows nothing of the model.

use crate::support::diagnosis::{classes, finish};
use hysteron_core::criticism::DiagnosisJob;
use hysteron_core::diagnosis::Diagnosis;
use hysteron_core::measurement::Measurement;
use hysteron_core::rig::process::{Excitation, ProcessRig};

/// Period of the free swing, s, and what damps it.
const PERIOD: f64 = 20.0;
const DAMPING: f64 = 2.0;

fn rig(excitation: Excitation) -> ProcessRig {
    ProcessRig {
        seed: 11,
        excitation,
        swing_period: PERIOD,
        time_constant: DAMPING,
        ..ProcessRig::default()
    }
}

/// The diagnosis of a record that swings, and of nothing else.
#[track_caller]
fn swings(record: &Measurement) -> Diagnosis {
    let d = finish(DiagnosisJob::new(record).unwrap());
    assert_eq!(classes(&d), [["underdamped"]], "{}", d.verdict.text);
    assert!(d.verdict.complete, "{}", d.verdict.text);
    let parameters = &d.steps.last().unwrap().parameters;
    for (name, truth) in [("P", PERIOD), ("T", DAMPING), ("K", 2.0)] {
        let found = parameters.iter().find(|p| p.name == name).unwrap();
        let (value, error) = (found.value, found.std_error);
        let off = (value - truth).abs();
        assert!(
            off < (3.0 * error).max(0.02 * truth),
            "{name} {value} ± {error}"
        );
    }
    d
}

#[test]
fn a_process_that_swings_is_told_with_its_period_and_its_damping() {
    let stairs = rig(Excitation::Staircase { top: 1.0 }).measure();
    swings(&stairs);
    // A record may begin anywhere: how fast the output moves then is a state that is found.
    let mut cut = stairs;
    let from = 330;
    cut.time.drain(..from);
    cut.input.values.drain(..from);
    cut.outputs[0].values.drain(..from);
    swings(&cut);
}

#[test]
fn it_is_told_from_its_relay_loop_and_cycles_there() {
    let relay = Excitation::Relay {
        gain: 1.0,
        hysteresis: 0.1,
    };
    let d = swings(&rig(relay).measure());
    let off = d.steps.last().unwrap().relay_loop.expect("a relay loop");
    assert!(off.period.is_some() && off.amplitude.is_some(), "{off:?}");
}

/// Damped by more than stops a swing it is two lags, and nothing is said of a swing.
#[test]
fn what_does_not_swing_is_two_lags() {
    let two_lags = ProcessRig {
        swing_period: 0.0,
        second_lag: 6.0,
        time_constant: 8.0,
        ..rig(Excitation::Binary { level: 1.0 })
    };
    let d = finish(DiagnosisJob::new(&two_lags.measure()).unwrap());
    assert_eq!(
        classes(&d),
        [["second_lag", "sensor_lag"]],
        "{}",
        d.verdict.text
    );
}
