//! The screen names what a rig hides, questions the input, and says what a record cannot tell.

use hysteron_core::criticism::screen;
use hysteron_core::diagnosis::{InputVerdict, Screening};
use hysteron_core::measurement::{ImportOptions, Measurement, Quantity, import};
use hysteron_core::rig::process::{Excitation as ProcessExcitation, ProcessRig};
use hysteron_core::rig::{DriveRig, Excitation, Friction, Load, Stranger};

use crate::support::controlled::{positioned, process, under_controller};
use crate::support::diagnosis::classes;
use crate::support::score::diagnose;
use crate::support::servo::servo;
use crate::support::shared::shared;

const SINES: Excitation = Excitation::Multisine { amplitude: 0.05 };

fn drive(excitation: Excitation) -> DriveRig {
    DriveRig {
        seed: 7,
        excitation,
        ..DriveRig::default()
    }
}

fn ids(screening: &Screening) -> Vec<Vec<&'static str>> {
    let subsets = screening.subsets.iter();
    subsets
        .map(|s| s.effects.iter().map(|e| e.as_str()).collect())
        .collect()
}

/// A controller that holds the output gives an input that tells nothing of the plant: none is said.
#[test]
fn a_controller_is_not_taken_for_the_plant() {
    let Some(bytes) = shared("failing/closed-loop-heater.csv") else {
        return;
    };
    let measurement = import("closed-loop-heater.csv", &bytes, &ImportOptions::default());
    let found = screen(&measurement.expect("a record"));
    assert_eq!(found.input_check.verdict, InputVerdict::ClosedLoop);
    assert!(
        found
            .input_check
            .text
            .to_string()
            .contains("u = -1.84 y + 185"),
        "{}",
        found.input_check.text
    );
    assert_eq!(ids(&found), Vec::<Vec<&str>>::new());
}

/// A ball-screw axis: mass within 5 % of what its authors identified, and with the sign of its input turned that is
/// said.
#[test]
fn a_real_axis_has_its_mass() {
    let screened = |path: &str| {
        let measurement = import(path, &shared(path)?, &ImportOptions::default());
        Some(screen(&measurement.expect("a record")))
    };
    if let Some(found) = screened("real/emps.csv") {
        let mass = found.body[0].value;
        assert!((mass / 95.1 - 1.0).abs() < 0.05, "{mass}");
    }
    if let Some(found) = screened("failing/emps-wrong-sign-250Hz.csv") {
        assert_eq!(
            found.input_check.verdict,
            InputVerdict::Sign,
            "{}",
            found.input_check.text
        );
    }
}

/// The only subset, with a value of it to this share.
fn check(measurement: &Measurement, effect: &str, symbol: &str, value: f64, within: f64) {
    let found = screen(measurement);
    assert_eq!(ids(&found), [[effect]], "{}", found.input_check.text);
    let own = found.subsets[0].parameters.iter();
    let mut own = own.filter(|p| p.effect.is_some_and(|e| e.as_str() == effect));
    let parameter = own
        .find(|p| p.name == symbol)
        .expect("a parameter of the effect");
    let off = (parameter.value / value - 1.0).abs();
    assert!(off < within, "{symbol}: {} for {value}", parameter.value);
    assert_eq!(found.input_check.verdict, InputVerdict::Ok);
}

#[test]
fn effects_of_a_drive_are_named_alone() {
    let sines = drive(SINES);
    let coulomb = DriveRig {
        friction: Friction::dry(0.03),
        ..sines
    };
    check(&coulomb.measure(), "coulomb_friction", "c", 0.03, 0.05);
    let cogging = DriveRig {
        cogging: (0.03, 6.0, 0.4),
        ..sines
    };
    check(&cogging.measure(), "cogging", "a", 0.03, 0.05);
    let spring = DriveRig {
        stranger: Some(Stranger::Spring { stiffness: 0.5 }),
        ..sines
    };
    check(&spring.measure(), "return_spring", "k", 0.5, 0.02);
    let stairs = drive(Excitation::Staircase { top: 0.3 });
    let load = DriveRig {
        constant_load: 0.015,
        ..stairs
    };
    check(&load.measure(), "constant_load", "F0", 0.015, 0.05);
    let asymmetry = DriveRig {
        gain_asymmetry: 0.06,
        ..stairs
    };
    check(&asymmetry.measure(), "gain_asymmetry", "a", 0.06, 0.05);
}

/// Motor and load of a record in which a load behind a gap is moved: inertia of both to a fifth, the half gap to a
/// third. That is enough to begin an exact simulation, and no more: what bounces is taken for what does not.
fn check_gap(found: &Screening, inertia: f64, load: f64, half_gap: f64) {
    let subset = &found.subsets[0];
    let ids: Vec<&str> = subset.effects.iter().map(|e| e.as_str()).collect();
    assert!(ids.contains(&"backlash"), "{ids:?}");
    let value = |name: &str| {
        let mut parameters = subset.parameters.iter();
        parameters
            .find(|p| p.name == name)
            .expect("a parameter")
            .value
    };
    for (name, truth, within) in [
        ("J1", inertia, 0.2),
        ("J2", load, 0.2),
        ("beta", half_gap, 0.33),
    ] {
        let off = (value(name) / truth - 1.0).abs();
        assert!(off < within, "{name}: {} for {truth}", value(name));
    }
}

/// The moves of a servo show a load that nobody measured, without a relay and without a simulation: on a rig that steps
/// as the project's own does not, and on the project's own.
#[test]
fn a_load_behind_a_gap_shows_in_the_moves_of_a_servo() {
    for (name, half_gap) in [("servo-backlash", 0.05), ("servo-backlash-dry", 0.06)] {
        let path = format!("measurements-2/{name}.csv");
        if let Some(bytes) = shared(&path) {
            let measurement = import(&path, &bytes, &ImportOptions::default());
            let found = screen(&measurement.expect("a record"));
            check_gap(&found, 2e-3, 2e-3, half_gap);
        }
    }
    let rig = DriveRig {
        seed: 11,
        excitation: servo(2.0, 0.8, 25.0),
        load: Some(Load {
            half_gap: 0.05,
            stiffness: 300.0,
            damping: 0.05,
            inertia: 9e-4,
            viscous: 2e-3,
            coulomb: 0.01,
        }),
        sampling: 1e-3,
        samples: 8000,
        ..DriveRig::default()
    };
    check_gap(&screen(&rig.measure()), rig.inertia, 9e-4, 0.05);
}

#[test]
fn effects_of_a_process_are_named() {
    let stairs = ProcessRig {
        seed: 7,
        excitation: ProcessExcitation::Staircase { top: 1.0 },
        ..ProcessRig::default()
    };
    let late = ProcessRig {
        dead_time: 6.0,
        ..stairs
    };
    check(&late.measure(), "input_delay", "tau", 6.0, 0.05);
    let clean = screen(&stairs.measure());
    assert_eq!(ids(&clean), [Vec::<&str>::new()]);
}

#[test]
fn a_turned_sign_is_said() {
    let mut measurement = drive(SINES).measure();
    for u in &mut measurement.input.values {
        *u = -*u;
    }
    let found = screen(&measurement);
    assert_eq!(
        found.input_check.verdict,
        InputVerdict::Sign,
        "{}",
        found.input_check.text
    );
}

#[test]
fn an_input_of_another_record_explains_nothing() {
    let mut measurement = drive(SINES).measure();
    let other = DriveRig {
        seed: 8,
        ..drive(SINES)
    };
    measurement.input = other.measure().input;
    let found = screen(&measurement);
    assert_eq!(
        found.input_check.verdict,
        InputVerdict::DoesNotExplain,
        "{}",
        found.input_check.text
    );
}

/// What a stop does is far stronger than the input, and no reason to doubt that.
#[test]
fn a_stop_does_not_hide_what_the_input_does() {
    for seed in [1, 2, 3] {
        let free = DriveRig {
            seed,
            ..drive(SINES)
        };
        let mut measurement = free.measure();
        // Thrown back, twelve times in the record: the velocity turns round within a sample.
        let n = measurement.len();
        let hits = n / 12;
        for output in &mut measurement.outputs {
            if output.quantity == Quantity::Velocity {
                for (i, v) in output.values.iter_mut().enumerate() {
                    if i % hits < hits / 10 {
                        *v *= -3.0;
                    }
                }
            }
        }
        measurement
            .outputs
            .retain(|o| o.quantity == Quantity::Velocity);
        let found = screen(&measurement);
        assert_eq!(
            found.input_check.verdict,
            InputVerdict::Ok,
            "{}",
            found.input_check.text
        );
    }
}

/// A step at the end of a record: whether the output follows cannot be told, so that nothing is said against the input.
#[test]
fn a_step_too_late_to_be_followed_is_not_doubted() {
    let stairs = ProcessRig {
        excitation: ProcessExcitation::Staircase { top: 1.0 },
        ..ProcessRig::default()
    };
    let mut measurement = stairs.measure();
    let n = measurement.len();
    for (i, u) in measurement.input.values.iter_mut().enumerate() {
        *u = f64::from(u8::from(i > n - n / 30));
    }
    for output in &mut measurement.outputs {
        let first = output.values[0];
        output.values.fill(first);
        for (i, y) in output.values.iter_mut().enumerate() {
            *y += 0.01 * f64::from((i % 7) as u8);
        }
    }
    let found = screen(&measurement);
    assert_ne!(
        found.input_check.verdict,
        InputVerdict::DoesNotExplain,
        "{}",
        found.input_check.text
    );
}

#[test]
fn real_records_and_those_of_other_rigs_are_not_doubted() {
    for path in [
        "measurements-2/walk-end-stop.csv",
        "failing/heater-step-plain-header.csv",
        "failing/servo-xl330-volts.csv",
        "failing/tanks-estimation.csv",
    ] {
        let Some(bytes) = shared(path) else {
            continue;
        };
        let measurement = import(path, &bytes, &ImportOptions::default());
        let found = screen(&measurement.expect("a record"));
        assert_ne!(
            found.input_check.verdict,
            InputVerdict::DoesNotExplain,
            "{path}: {}",
            found.input_check.text
        );
    }
}

#[test]
fn a_controller_is_read_off() {
    let stairs = ProcessRig {
        excitation: ProcessExcitation::Staircase { top: 1.0 },
        ..ProcessRig::default()
    };
    let mut measurement = stairs.measure();
    let output = measurement
        .outputs
        .iter()
        .find(|o| o.quantity == Quantity::Output);
    let law = output
        .expect("an output")
        .values
        .iter()
        .map(|y| 3.0 - 1.5 * y);
    measurement.input.values = law.collect();
    let found = screen(&measurement);
    assert_eq!(found.input_check.verdict, InputVerdict::ClosedLoop);
    assert!(
        found
            .input_check
            .text
            .to_string()
            .contains("u = -1.50 y + 3.00"),
        "{}",
        found.input_check.text
    );
}

/// As they are built: between limits, with an integral that stops there.
#[test]
fn a_controller_with_limits_is_read_off_with_its_set_point() {
    let measurement = under_controller();
    let check = screen(&measurement).input_check;
    assert_eq!(check.verdict, InputVerdict::ClosedLoop, "{}", check.text);
    assert!(
        check
            .text
            .to_string()
            .contains("u = -0.400 y - 0.00500 ∫(y - "),
        "{}",
        check.text
    );
}

/// Its set point jumps by less than the loop moves in some samples.
#[test]
fn a_controller_of_a_position_is_read_off_whatever_its_set_point_does() {
    for (gain, law) in [
        (0.1, "u = -0.100 x"),
        (1.0, "u = -1.00 x"),
        (3.0, "u = -3.00 x"),
    ] {
        let check = screen(&positioned(gain)).input_check;
        assert_eq!(check.verdict, InputVerdict::ClosedLoop, "{}", check.text);
        assert!(check.text.to_string().contains(law), "{}", check.text);
        assert!(check.plant_told, "{}", check.text);
    }
}

/// Where the set point tells the plant, so does the loop what the plant has beside its lag.
#[test]
fn what_is_missing_is_looked_for_in_a_closed_loop_too() {
    let diagnosis = diagnose(&under_controller()).expect("a diagnosis");
    let check = diagnosis.input_check.as_ref().expect("a check");
    assert_eq!(check.verdict, InputVerdict::ClosedLoop);
    assert!(check.plant_told, "{}", check.text);
    let found = classes(&diagnosis);
    assert_eq!(
        found,
        [["second_lag", "sensor_lag"]],
        "{}",
        diagnosis.verdict.text
    );
}

/// That a model leaves noise says nothing of a plant that only its controller moves.
#[test]
fn a_record_that_shows_the_controller_alone_is_not_complete() {
    let measurement = process(|_, y| 3.0 + 0.4 * (45.0 - y));
    let diagnosis = diagnose(&measurement).expect("a diagnosis");
    let check = diagnosis.input_check.expect("a check");
    assert_eq!(check.verdict, InputVerdict::ClosedLoop);
    assert!(!check.plant_told, "{}", check.text);
    let verdict = &diagnosis.verdict;
    assert!(!verdict.complete && verdict.unknown, "{}", verdict.text);
}

/// A sine and its response are phases of one another, as are the terms of a controller; but it does not answer to
/// chance.
#[test]
fn an_input_that_swings_by_itself_is_no_controller() {
    let at = |k: usize, period: f64| (k as f64 * std::f64::consts::TAU / period).sin();
    let swings: [fn(f64, f64, f64) -> f64; 3] = [
        |slow, _, _| slow,
        |slow, fast, _| slow + fast,
        |_, _, ramp| ramp,
    ];
    for (number, swing) in swings.into_iter().enumerate() {
        let measurement = process(|k, _| 2.0 + swing(at(k, 400.0), at(k, 173.0), 1e-3 * k as f64));
        let check = screen(&measurement).input_check;
        assert_ne!(
            check.verdict,
            InputVerdict::ClosedLoop,
            "{number}: {}",
            check.text
        );
    }
}

#[test]
fn the_same_record_gives_the_same_bits() {
    let measurement = drive(SINES).measure();
    let [a, b] = [screen(&measurement), screen(&measurement)];
    assert_eq!(a, b);
}
