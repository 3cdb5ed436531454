//! What a record tells of itself: noise and steps of its sensors however they are printed, the operating point of a
//! process, and which ways it went.

#![allow(
    clippy::large_types_passed_by_value,
    reason = "definitions of rigs are plain values"
)]

use std::fmt::Write as _;

use crate::support::diagnosis::{classes, diagnose_shared, finish};
use crate::support::shared::shared;
use hysteron_core::criticism::{DiagnosisJob, noise_level};
use hysteron_core::diagnosis::Diagnosis;
use hysteron_core::measurement::{Channel, Kind, Measurement, Quantity, import_csv};
use hysteron_core::rig::Random;
use hysteron_core::rig::process::{self, ProcessRig};
use proptest::prelude::*;

fn diagnose(record: &Measurement) -> Diagnosis {
    finish(DiagnosisJob::new(record).unwrap())
}

fn parameter(d: &Diagnosis, name: &str) -> (f64, f64) {
    let last = d.steps.last().unwrap();
    let found = last.parameters.iter().find(|p| p.name == name);
    let found = found.unwrap_or_else(|| panic!("no {name}: {}", d.verdict.text));
    (found.value, found.std_error)
}

/// The effects found, each with what does the same in such a record.
fn check(d: &Diagnosis, missing: &[&[&str]]) {
    let mut found = classes(d);
    found.sort();
    assert_eq!(found, missing, "{}", d.verdict.text);
}

const LAG: &[&str] = &["second_lag", "sensor_lag"];
const ONE_WAY: &[&str] = &["coulomb_friction", "constant_load", "dead_zone"];

/// A heater: 0 to 100 %, in a room of 21 degrees.
fn heater(rig: ProcessRig, seed: u64) -> Measurement {
    let excitation = process::Excitation::Staircase { top: 50.0 };
    let rig = ProcessRig {
        seed,
        excitation,
        gain: 0.6,
        samples: 1500,
        constant_load: 50.0,
        ..rig
    };
    let mut record = rig.measure();
    // From about the middle of its range to a range from 0; the room is where the output would rest without input.
    for u in &mut record.input.values {
        *u += 50.0;
    }
    let mut random = Random::new(seed);
    for y in &mut record.outputs[0].values {
        *y += 21.0 + 0.04 * random.normal();
    }
    record
}

#[test]
fn a_heater_in_a_room_has_an_ambient_and_nothing_missing() {
    let d = diagnose(&heater(ProcessRig::default(), 3));
    check(&d, &[]);
    assert!(d.verdict.complete, "{}", d.verdict.text);
    let (ambient, error) = parameter(&d, "ambient");
    assert!(
        (ambient - 21.0).abs() < 4.0 * error.max(0.02),
        "{ambient} ± {error}"
    );
    let lag = ProcessRig {
        second_lag: 7.0,
        ..ProcessRig::default()
    };
    let d = diagnose(&heater(lag, 4));
    check(&d, &[LAG]);
    // A heater cannot cool: what tells the two apart keeps to its range.
    for proposal in &d.verdict.experiments {
        assert_eq!(proposal.limits.side, 1);
    }
}

/// An input that changes at nearly every sample leaves no smooth stretch that would show the noise: what the model leaves
/// does.
#[test]
fn noise_is_no_more_than_what_a_model_leaves() {
    let (mut random, level) = (Random::new(9), 0.05);
    let (mut y, mut input, mut output) = (0.0, Vec::new(), Vec::new());
    for _ in 0..200 {
        let u = random.sign();
        input.push(u);
        output.push(y + level * random.normal());
        y += (7.0 * u - y) * (1.0 - (-0.15_f64).exp());
    }
    let channel = |quantity, values| Channel {
        quantity,
        name: String::new(),
        unit: "1".to_owned(),
        values,
    };
    let record = Measurement {
        name: "quick".to_owned(),
        kind: Kind::Process,
        time: (0..200).map(|k| 0.1 * f64::from(k)).collect(),
        input: channel(Quantity::Input, input),
        outputs: vec![channel(Quantity::Output, output)],
        reference: vec![],
        warnings: vec![],
    };
    let seen = noise_level(&record.outputs[0].values, &record.input.values);
    assert!(seen > 2.0 * level, "{seen}");
    let d = diagnose(&record);
    check(&d, &[]);
    let found = d.noise[0].value;
    assert!((found / level - 1.0).abs() < 0.2, "{found}");
}

#[test]
fn a_load_that_comes_on_with_the_record_is_no_ambient() {
    let rig = ProcessRig {
        excitation: process::Excitation::Staircase { top: 1.0 },
        constant_load: 0.1,
        ..ProcessRig::default()
    };
    let d = diagnose(&rig.measure());
    check(&d, &[&["constant_load"]]);
    assert_eq!(parameter(&d, "ambient").0, 0.0);
}

#[test]
fn an_output_that_stays_where_the_input_leaves_it_integrates() {
    let mut random = Random::new(5);
    let (mut y, mut input, mut output) = (3.0, Vec::new(), Vec::new());
    for i in 0..1200 {
        let u = match i % 400 {
            50..70 => 1.0,
            250..275 => -1.0,
            _ => 0.0,
        };
        input.push(u);
        output.push(y + 0.01 * random.normal());
        y += -0.4 * u * 0.1;
    }
    let mut record = ProcessRig::default().measure();
    record.time = (0..1200).map(|i| 0.1 * f64::from(i)).collect();
    record.input.values = input;
    record.outputs[0].values = output;
    let d = diagnose(&record);
    check(&d, &[]);
    let (rate, error) = parameter(&d, "K/T");
    assert!((rate + 0.4).abs() < 4.0 * error, "{rate} ± {error}");
    assert!(
        d.verdict.text.to_string().contains("integrates"),
        "{}",
        d.verdict.text
    );
}

/// A drive with dry friction that is switched between levels which all turn it forward, as a file.
fn forward_drive(step: f64, seed: u64) -> String {
    let (inertia, viscous, friction) = (9e-4, 2e-3, 0.03);
    let mut random = Random::new(seed);
    let mut v = 0.0;
    let mut csv = "t [s],u [N m],v1 [rad/s]\n".to_owned();
    for i in 0..6000 {
        let t = step * f64::from(i);
        let level = [0.08, 0.2, 0.05, 0.14, 0.1, 0.24][(t / 0.4) as usize % 6];
        writeln!(csv, "{t:.4},{level},{:.5}", v + 0.02 * random.normal()).unwrap();
        let rest = (level - friction) / viscous;
        v = rest + (v - rest) * (-viscous / inertia * step).exp();
    }
    csv
}

#[test]
fn a_drive_that_turns_one_way_does_not_tell_friction_from_a_load() {
    for step in [5e-4, 2e-3] {
        let record = import_csv("forward", forward_drive(step, 7).as_bytes(), None).unwrap();
        let d = diagnose(&record);
        check(&d, &[ONE_WAY]);
        let next = d.verdict.next_experiment.unwrap();
        assert!(next.to_string().contains("both ways"), "{next}");
    }
}

/// Values on a lattice, printed with so many digits.
fn printed(values: &mut [f64], step: f64, digits: i32) {
    let unit = 10_f64.powi(-digits);
    for v in values {
        *v = ((*v / step).round() * step / unit).round() * unit;
    }
}

/// Digits that resolve a step.
fn enough_digits(step: f64) -> i32 {
    (-(step / 4.0).log10()).ceil() as i32
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn noise_is_the_same_however_a_quantised_value_is_printed(
        seed in 0_u64..1000,
        step in 0.003_f64..0.3,
        more in 0_i32..6,
    ) {
        let mut random = Random::new(seed);
        let input: Vec<f64> = (0..2000).map(|i| f64::from(i / 200 % 2)).collect();
        let mut y = 0.0;
        let values: Vec<f64> = input
            .iter()
            .map(|u| {
                y += (5.0 * u - y) / 80.0;
                y + 0.02 * random.normal()
            })
            .collect();
        let (mut exact, mut short) = (values.clone(), values);
        printed(&mut exact, step, 12);
        printed(&mut short, step, enough_digits(step) + more);
        let (exact, short) = (noise_level(&exact, &input), noise_level(&short, &input));
        prop_assert!((short / exact - 1.0).abs() < 0.2, "step {step}: {short} and {exact}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 6, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn the_verdict_is_the_same_however_a_quantised_value_is_printed(
        seed in 0_u64..1000,
        step in 0.005_f64..0.1,
        more in 0_i32..5,
    ) {
        let rig = ProcessRig {
            seed,
            excitation: process::Excitation::Binary { level: 1.0 },
            dead_time: 5.0,
            samples: 1000,
            ..ProcessRig::default()
        };
        let verdict = |digits: i32| {
            let mut record = rig.measure();
            printed(&mut record.outputs[0].values, step, digits);
            diagnose(&record).verdict.missing
        };
        prop_assert_eq!(verdict(enough_digits(step) + more), verdict(12));
    }
}

/// Neither less than what the steps hide nor more than one of them.
fn check_level(file: &str, level: f64, step: f64) {
    let counted = step / 12.0_f64.sqrt();
    assert!(level > 0.4 * counted && level < step, "{file}: {level}");
}

#[test]
fn noise_and_steps_of_real_processes_are_told_in_their_own_unit() {
    let expected = [
        ("failing/incubator-exp1.csv", 1.0 / 32.0),
        ("failing/incubator-exp2-mean-3-decimals.csv", 1.0 / 32.0),
        ("measurements-2/steps-coarse-sensor.csv", 0.5),
        ("measurements-2/steps-lag-printed.csv", 0.0625),
    ];
    for (file, step) in expected {
        let Some(d) = diagnose_shared(file) else {
            continue;
        };
        let found = d.noise[0].step.unwrap();
        assert!((found / step - 1.0).abs() < 0.01, "{file}: {found}");
        check_level(file, d.noise[0].value, step);
    }
}

#[test]
fn noise_of_real_speeds_is_that_of_their_steps() {
    let expected = [
        ("failing/cart-0m20-velocity-printed.csv", 0.013_19),
        ("failing/one-way-drive.csv", 0.628_32),
    ];
    for (file, step) in expected {
        let Some(bytes) = shared(file) else {
            continue;
        };
        let record = import_csv(file, &bytes, None).unwrap();
        let speed = record.output(Quantity::Velocity).unwrap();
        let level = noise_level(&speed.values, &record.input.values);
        check_level(file, level, step);
    }
}

/// The box around it warms up while it is measured: that is no ramp of the heater.
#[test]
fn a_heater_with_a_second_storage_has_its_known_values() {
    for file in ["incubator-exp1.csv", "incubator-exp2-mean-3-decimals.csv"] {
        let Some(d) = diagnose_shared(&format!("failing/{file}")) else {
            return;
        };
        check(&d, &[LAG]);
        for (name, from, to) in [
            ("K", 127.0, 144.0),
            ("T", 490.0, 580.0),
            ("ambient", 22.0, 26.0),
        ] {
            let (value, _) = parameter(&d, name);
            assert!((from..to).contains(&value), "{file}: {name}: {value}");
        }
    }
}

/// A heater in a room whose temperature goes on a random walk with steps of this size, K.
fn in_wandering_room(rig: ProcessRig, seed: u64, step: f64) -> Measurement {
    let mut record = heater(rig, seed);
    let mut random = Random::new(100 + seed);
    let mut room = 0.0;
    for y in &mut record.outputs[0].values {
        *y += room;
        room += step * random.normal();
    }
    record
}

#[test]
fn a_room_that_wanders_is_no_effect_and_hides_none() {
    let slow = ProcessRig {
        second_lag: 4.0,
        ..ProcessRig::default()
    };
    let rigs: [(ProcessRig, &[&[&str]]); 2] = [(ProcessRig::default(), &[]), (slow, &[LAG])];
    for (rig, missing) in rigs {
        for seed in [1, 2] {
            let d = diagnose(&in_wandering_room(rig, seed, 0.03));
            check(&d, missing);
            assert!(!d.verdict.complete, "{}", d.verdict.text);
            assert!(
                d.verdict.text.to_string().contains("drifts slowly"),
                "{}",
                d.verdict.text
            );
        }
    }
}

/// A heater that is not on while the output moves tells nothing of how fast it would move that.
#[test]
fn a_process_integrates_only_if_its_rate_is_told() {
    let Some(d) = diagnose_shared("failing/heater-step-plain-header.csv") else {
        return;
    };
    check(&d, &[]);
    assert!(
        !d.verdict.text.to_string().contains("integrates"),
        "{}",
        d.verdict.text
    );
}

#[test]
fn processes_of_the_second_rig_are_right() {
    let delay: &[&str] = &["input_delay"];
    let expected: [(&str, Vec<&[&str]>); 8] = [
        ("thermostat-clean", vec![]),
        ("steps-dead-time", vec![delay]),
        ("steps-lag", vec![LAG]),
        ("thermostat-lag", vec![LAG]),
        ("prbs-lag-dead-time", vec![delay, LAG]),
        ("steps-coarse-sensor", vec![delay]),
        ("steps-lag-printed", vec![LAG]),
        ("steps-radiation", vec![&["static_curvature"]]),
    ];
    for (name, missing) in expected {
        let Some(d) = diagnose_shared(&format!("measurements-2/{name}.csv")) else {
            continue;
        };
        assert_eq!(d.kind, Kind::Process);
        check(&d, &missing);
        assert!(d.verdict.complete, "{name}: {}", d.verdict.text);
        if name != "steps-radiation" {
            let (ambient, error) = parameter(&d, "ambient");
            assert!(
                (ambient - 21.0).abs() < 4.0 * error,
                "{name}: {ambient} ± {error}"
            );
        }
    }
}

/// A drive that starts from rest under one and the same input, which is all that such a record needs to have.
#[test]
fn an_input_that_never_changes_moves_a_clean_drive() {
    let (inertia, viscous, torque) = (1e-3, 2e-3, 0.2);
    let mut random = Random::new(21);
    let mut csv = "t [s],u [N m],v1 [rad/s]\n".to_owned();
    for i in 0..1000 {
        let t = 2e-3 * f64::from(i);
        let speed = torque / viscous * (1.0 - (-viscous * t / inertia).exp());
        let _ = writeln!(csv, "{t},{torque},{}", speed + 0.01 * random.normal());
    }
    let d = diagnose(&import_csv("start.csv", csv.as_bytes(), None).unwrap());
    assert!(
        d.verdict.complete && d.verdict.missing.is_empty(),
        "{}",
        d.verdict.text
    );
    for (name, value) in [("J1", inertia), ("d1", viscous)] {
        let (found, error) = parameter(&d, name);
        assert!(
            (found - value).abs() < 4.0 * error,
            "{name} {found} +- {error}"
        );
    }
}
