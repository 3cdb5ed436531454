//! An input is doubted only where it did not act: not where runs are joined, where a body sticks or hangs on a spring,
//! where a valve is no straight line, or where a sensor is coarse.

use std::f64::consts::TAU;

use hysteron_core::criticism::screen;
use hysteron_core::diagnosis::{InputVerdict, Screening};
use hysteron_core::measurement::{Channel, Measurement, Quantity};
use hysteron_core::rig::process::{Excitation as ProcessExcitation, ProcessRig};
use hysteron_core::rig::{DriveRig, Excitation, Friction, Random, Recorded, Stranger};

/// The rows of a record for which this holds.
fn rows(mut record: Measurement, keeps: impl Fn(usize) -> bool) -> Measurement {
    let cut = |values: &mut Vec<f64>| {
        let kept = values.iter().enumerate().filter(|(k, _)| keeps(*k));
        *values = kept.map(|(_, value)| *value).collect();
    };
    cut(&mut record.time);
    cut(&mut record.input.values);
    for output in &mut record.outputs {
        cut(&mut output.values);
    }
    record
}

/// Short runs with long gaps between them.
fn joined(record: Measurement) -> Measurement {
    rows(record, |k| k % 1600 < 200)
}

fn turned(mut record: Measurement) -> Measurement {
    for u in &mut record.input.values {
        *u = -*u;
    }
    record
}

fn sines(amplitude: f64) -> DriveRig {
    DriveRig {
        seed: 7,
        excitation: Excitation::Multisine { amplitude },
        ..DriveRig::default()
    }
}

#[track_caller]
fn is(found: &Screening, verdict: InputVerdict) {
    let check = &found.input_check;
    assert_eq!(check.verdict, verdict, "{}", check.text);
}

/// That something is wrong with the input is not said.
#[track_caller]
fn is_not_doubted(record: &Measurement) {
    let check = screen(record).input_check;
    let fine = matches!(
        check.verdict,
        InputVerdict::Ok | InputVerdict::InertiaNotTold
    );
    assert!(fine, "{:?}: {}", check.verdict, check.text);
}

#[test]
fn joined_runs_tell_the_body() {
    let rig = DriveRig {
        recorded: Recorded::VelocityOnly,
        ..sines(0.05)
    };
    let found = screen(&joined(rig.measure()));
    is(&found, InputVerdict::Ok);
    let off = (found.body[0].value / rig.inertia - 1.0).abs();
    assert!(off < 0.05, "{} for {}", found.body[0].value, rig.inertia);
    is(&screen(&turned(joined(rig.measure()))), InputVerdict::Sign);
}

/// A body that its friction holds follows the input with the deflection of that.
#[test]
fn a_body_that_sticks_is_not_driven_backwards() {
    let rig = DriveRig {
        friction: Friction {
            displacement: 1e-3,
            ..Friction::dry(0.1)
        },
        ..sines(0.008)
    };
    is_not_doubted(&rig.measure());
}

/// Below its resonance a body on a spring is where the input holds it, and so accelerated against the input.
#[test]
fn a_spring_does_not_turn_the_input() {
    let rig = DriveRig {
        stranger: Some(Stranger::Spring { stiffness: 100.0 }),
        recorded: Recorded::PositionOnly,
        encoder: 2e-4,
        ..sines(0.05)
    };
    is_not_doubted(&rig.measure());
}

#[test]
fn a_spring_is_no_controller() {
    let rig = DriveRig {
        inertia: 1e-5,
        stranger: Some(Stranger::Spring { stiffness: 200.0 }),
        ..sines(0.5)
    };
    is_not_doubted(&rig.measure());
}

/// A motor whose shaft has a coarse potentiometer, and moves of its own between rests.
#[test]
fn a_coarse_position_does_not_turn_the_input() {
    for top in [0.05, 0.1] {
        let rig = DriveRig {
            viscous: 2e-2,
            friction: Friction::dry(0.01),
            encoder: TAU / 100.0,
            recorded: Recorded::PositionOnly,
            excitation: Excitation::Staircase { top },
            ..DriveRig::default()
        };
        is_not_doubted(&rig.measure());
    }
}

fn staircase() -> ProcessRig {
    ProcessRig {
        excitation: ProcessExcitation::Staircase { top: 1.0 },
        time_constant: 3.0,
        ..ProcessRig::default()
    }
}

/// A valve that opens along an S: most of its way does next to nothing.
#[test]
fn a_valve_that_is_no_straight_line_acts() {
    let mut record = staircase().measure();
    for u in &mut record.input.values {
        *u = u.signum() * u.abs().powf(0.1);
    }
    is(&screen(&record), InputVerdict::Ok);
}

/// A beam that rings: no lag follows the input as it does.
#[test]
fn a_beam_that_rings_follows_its_input() {
    let (n, mut random) = (2000, Random::new(3));
    let input: Vec<f64> = (0..n).map(|_| random.normal()).collect();
    let rings = |frequency: f64, keeps: f64| {
        let (a, b) = (2.0 * keeps * frequency.cos(), -keeps * keeps);
        let (mut before, mut last) = (0.0, 0.0);
        input
            .iter()
            .map(|u| {
                (before, last) = (last, a * last + b * before + u);
                last
            })
            .collect::<Vec<f64>>()
    };
    let (slow, fast) = (rings(0.3, 0.99), rings(0.9, 0.98));
    let noise = (0..n).map(|_| 0.05 * random.normal());
    let output: Vec<f64> = noise
        .enumerate()
        .map(|(k, e)| {
            if k == 0 {
                e
            } else {
                slow[k - 1] - fast[k - 1] + e
            }
        })
        .collect();
    let mut record = staircase().measure();
    record.time = (0..n).map(|k| 0.002 * k as f64).collect();
    record.input.values = input;
    for Channel {
        quantity, values, ..
    } in &mut record.outputs
    {
        assert_eq!(*quantity, Quantity::Output);
        values.clone_from(&output);
    }
    is(&screen(&record), InputVerdict::Ok);
    // Of another record it says nothing.
    let half = n / 2;
    record.input.values.rotate_left(half / 3);
    assert_ne!(screen(&record).input_check.verdict, InputVerdict::Ok);
}
