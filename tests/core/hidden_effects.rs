//! Hidden effects are found, nothing is found where nothing is, what cannot be told apart is said so.

use crate::support::diagnosis::{classes, finish};
use crate::support::rig::Rig;
use hysteron_core::criticism::DiagnosisJob;
use hysteron_core::diagnosis::Diagnosis;
use hysteron_core::measurement::{Measurement, import_csv};

fn diagnose(measurement: &Measurement) -> Diagnosis {
    finish(DiagnosisJob::new(measurement).unwrap())
}

/// Checks the classes found, in any order, and main parameters to 5 %.
fn check(
    name: &str,
    measurement: &Measurement,
    missing: &[&[&str]],
    parameters: &[(&str, &str, f64)],
) {
    let d = diagnose(measurement);
    let mut found = classes(&d);
    let mut wanted: Vec<Vec<&str>> = missing.iter().map(|class| class.to_vec()).collect();
    found.sort();
    wanted.sort();
    assert_eq!(found, wanted, "{name}: {}", d.verdict.text);
    let last = d.steps.last().unwrap();
    assert!(
        last.error <= 1.2 * d.noise_floor,
        "{name}: final error {}",
        last.error
    );
    assert!(
        d.verdict.complete && !d.verdict.unknown,
        "{name}: {}",
        d.verdict.text
    );
    for (effect, symbol, truth) in parameters {
        let value = last
            .parameters
            .iter()
            .find(|p| p.effect.is_some_and(|e| e.as_str() == *effect) && p.name == *symbol)
            .map(|p| p.value);
        let value = value.unwrap_or_else(|| panic!("{name}: no parameter {symbol} of {effect}"));
        assert!(
            (value / truth - 1.0).abs() < 0.05,
            "{name}: {symbol} = {value}, truth {truth}"
        );
    }
}

fn file(name: &str, missing: &[&[&str]], parameters: &[(&str, &str, f64)]) {
    file_in("tests/data", name, missing, parameters);
}

fn file_in(folder: &str, name: &str, missing: &[&[&str]], parameters: &[(&str, &str, f64)]) {
    let path = format!("{}/../{folder}/{name}.csv", env!("CARGO_MANIFEST_DIR"));
    let measurement = import_csv(name, &std::fs::read(path).unwrap(), None).unwrap();
    check(name, &measurement, missing, parameters);
}

/// These two act alike under a relay with two opposite levels.
const OFFSET: &[&str] = &["gain_asymmetry", "constant_load"];

#[test]
fn nothing_is_added_where_nothing_is_missing() {
    file("drive-01", &[], &[]);
    file("process-01", &[], &[]);
}

#[test]
fn coulomb_friction() {
    file(
        "drive-02",
        &[&["coulomb_friction"]],
        &[("coulomb_friction", "c", 0.04)],
    );
}

#[test]
fn input_delay() {
    file(
        "drive-04",
        &[&["input_delay"]],
        &[("input_delay", "tau", 0.8e-3)],
    );
    file(
        "process-02",
        &[&["input_delay"]],
        &[("input_delay", "tau", 6.0)],
    );
}

#[test]
fn actuator_lag() {
    file(
        "drive-06",
        &[&["actuator_lag"]],
        &[("actuator_lag", "T_a", 0.9e-3)],
    );
}

#[test]
fn gain_asymmetry_and_constant_load_are_one_class_under_a_symmetric_relay() {
    file("drive-05", &[OFFSET], &[]);
    file("drive-07", &[OFFSET], &[]);
}

#[test]
fn two_effects_at_once() {
    let truth = [
        ("coulomb_friction", "c", 0.05),
        ("input_delay", "tau", 0.6e-3),
    ];
    file(
        "drive-12",
        &[&["coulomb_friction"], &["input_delay"]],
        &truth,
    );
}

#[test]
fn a_gap_is_found_and_no_friction_where_there_is_none() {
    file_in(
        "assets/measurements",
        "drive-10",
        &[&["backlash"]],
        &[("backlash", "beta", 0.006)],
    );
}

#[test]
fn a_gap_of_which_one_end_is_met_is_found_and_the_dry_friction_besides() {
    let truth = [
        ("backlash", "beta", 0.0095),
        ("coulomb_friction", "c", 0.03),
    ];
    file_in(
        "assets/measurements",
        "drive-03",
        &[&["backlash"], &["coulomb_friction"]],
        &truth,
    );
}

#[test]
fn a_clean_rig_stays_clean() {
    for seed in 1..=12 {
        check(
            "clean",
            &Rig {
                seed,
                ..Rig::default()
            }
            .measure(),
            &[],
            &[],
        );
    }
}

#[test]
fn the_rig_gives_away_each_hidden_effect() {
    for seed in 21..=23 {
        let spread = 0.5 + 0.25 * (seed % 4) as f64;
        let rig = Rig {
            seed,
            relay_asymmetry: 0.05 * (seed % 3) as f64,
            ..Rig::default()
        };
        // A symmetric relay lets viscous stand in for dry friction to some per cent: an asymmetric one
        // tells them apart.
        let (c, tau, lag, a) = (
            0.04 * spread,
            0.7e-3 * spread,
            0.8e-3 * spread,
            0.06 * spread,
        );
        check(
            "friction",
            &Rig {
                coulomb: c,
                relay_asymmetry: 0.1,
                ..rig
            }
            .measure(),
            &[&["coulomb_friction"]],
            &[("coulomb_friction", "c", c)],
        );
        check(
            "delay",
            &Rig { delay: tau, ..rig }.measure(),
            &[&["input_delay"]],
            &[("input_delay", "tau", tau)],
        );
        check(
            "lag",
            &Rig { lag, ..rig }.measure(),
            &[&["actuator_lag"]],
            &[("actuator_lag", "T_a", lag)],
        );
        let stairs = Rig {
            staircase: true,
            ..rig
        };
        let asymmetric = Rig {
            gain_asymmetry: a,
            ..stairs
        }
        .measure();
        check(
            "asymmetry",
            &asymmetric,
            &[&["gain_asymmetry"]],
            &[("gain_asymmetry", "a", a)],
        );
        let loaded = Rig {
            constant_load: 0.3 * c,
            ..stairs
        }
        .measure();
        check(
            "load",
            &loaded,
            &[&["constant_load"]],
            &[("constant_load", "F0", 0.3 * c)],
        );
    }
}

#[test]
fn the_rig_gives_away_pairs() {
    let pair = |name: &str, rig: Rig, missing: &[&[&str]], parameters: &[(&str, &str, f64)]| {
        check(name, &rig.measure(), missing, parameters);
    };
    let rig = Rig {
        seed: 31,
        ..Rig::default()
    };
    pair(
        "friction and lag",
        Rig {
            coulomb: 0.05,
            lag: 0.5e-3,
            ..rig
        },
        &[&["coulomb_friction"], &["actuator_lag"]],
        &[
            ("coulomb_friction", "c", 0.05),
            ("actuator_lag", "T_a", 0.5e-3),
        ],
    );
    pair(
        "delay and load",
        Rig {
            delay: 0.6e-3,
            constant_load: 0.02,
            relay_asymmetry: 0.0,
            ..rig
        },
        &[&["input_delay"], OFFSET],
        &[("input_delay", "tau", 0.6e-3)],
    );
}

#[test]
fn the_same_file_gives_the_same_answer() {
    let measurement = Rig {
        seed: 5,
        coulomb: 0.03,
        samples: 3000,
        ..Rig::default()
    }
    .measure();
    assert_eq!(diagnose(&measurement), diagnose(&measurement));
}
