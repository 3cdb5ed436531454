//! Records of real machines and processes whose owners know what acts in them, and a sister of one that is made here.
//!
//! The records are not part of the project, see [`shared`].

use std::fmt::Write as _;

use crate::support::diagnosis::{classes, finish};
use crate::support::parameter::parameter;
use crate::support::shared::shared;
use hysteron_core::criticism::DiagnosisJob;
use hysteron_core::diagnosis::Diagnosis;
use hysteron_core::measurement::import_csv;

fn diagnose(name: &str, csv: &[u8]) -> Diagnosis {
    let record = import_csv(name, csv, None).unwrap();
    finish(DiagnosisJob::new(&record).unwrap())
}

fn diagnose_shared(file: &str) -> Option<Diagnosis> {
    let csv = shared(&format!("failing/{file}"))?;
    Some(diagnose(file, &csv))
}

/// That these classes are missing, and no other.
fn check(d: &Diagnosis, missing: &[&[&str]]) {
    let mut found = classes(d);
    for class in &mut found {
        class.sort_unstable();
    }
    found.sort();
    assert_eq!(found, missing, "{}", d.verdict.text);
}

fn check_near(d: &Diagnosis, symbol: &str, known: f64, tolerance: f64) {
    let p = parameter(d, symbol);
    assert!(
        (p.value / known - 1.0).abs() < tolerance,
        "{symbol} {} ± {}, known {known}",
        p.value,
        p.std_error
    );
}

const SPRING: &[&str] = &["gravity", "return_spring"];

/// A robot servo with an arm, in volts: neither the arm's weight nor friction that grows with load explains it without the other.
#[test]
fn an_arm_has_weight_and_its_gears_rub_the_more_the_more_they_carry() {
    let Some(d) = diagnose_shared("servo-xl330-volts.csv") else {
        return;
    };
    check(&d, &[SPRING, &["load_dependent_friction"]]);
}

/// An electronic oscillator with a hardening spring, nine samples to a period: J 5.37e-6, d 2.25e-4, k 0.99, k3 3.9.
#[test]
fn an_oscillator_has_its_hardening_spring() {
    let Some(d) = diagnose_shared("silverbox-as-drive.csv") else {
        return;
    };
    check(&d, &[SPRING, &["hardening_spring"]]);
    check_near(&d, "J1", 5.37e-6, 0.05);
    check_near(&d, "k3", 3.9, 0.05);
}

/// A motor that turns one way, with measured torque.
#[test]
fn a_motor_that_turns_one_way_does_not_tell_its_friction() {
    let Some(d) = diagnose_shared("one-way-drive.csv") else {
        return;
    };
    check(&d, &[&["coulomb_friction", "constant_load", "dead_zone"]]);
}

/// An industrial servo in one move: friction of 5.5 % at 27 rad/s, 7.2 at 61, 8.9 at 102 and 9.4 at 174.
#[test]
fn friction_that_flattens_with_speed_is_found_in_one_move() {
    let Some(d) = diagnose_shared("servo-single-move.csv") else {
        return;
    };
    let found = classes(&d).concat();
    assert!(found.contains(&"flattening_friction"), "{}", d.verdict.text);
}

/// Thermal chambers with a second lag of 39 to 45 s: one at rest at first, one whose heater was on until then.
#[test]
fn a_heater_that_was_on_before_the_record_hides_no_second_lag() {
    for (file, other) in [
        ("incubator-exp1.csv", Some("sensor_lag")),
        ("incubator-exp2-mean-3-decimals.csv", None),
    ] {
        let Some(d) = diagnose_shared(file) else {
            continue;
        };
        let lag: Vec<&str> = ["second_lag"].into_iter().chain(other).collect();
        check(&d, &[&lag]);
    }
}
