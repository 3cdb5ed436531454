//! Records of real machines and processes whose owners know what acts in them, and a sister of one that is made here.
//!
//! The records are not part of the project, see [`crate::support::shared`].

use std::fmt::Write as _;

use crate::support::diagnosis::{classes, diagnose_shared, finish};
use crate::support::parameter::parameter;
use hysteron_core::criticism::DiagnosisJob;
use hysteron_core::diagnosis::Diagnosis;
use hysteron_core::measurement::import_csv;

fn diagnose(name: &str, csv: &[u8]) -> Diagnosis {
    let record = import_csv(name, csv, None).unwrap();
    finish(DiagnosisJob::new(&record).unwrap())
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

/// A robot servo with an arm, in volts: neither the arm's weight nor friction that grows with load explains it without
/// the other.
#[test]
fn an_arm_has_weight_and_its_gears_rub_the_more_the_more_they_carry() {
    let Some(d) = diagnose_shared("failing/servo-xl330-volts.csv") else {
        return;
    };
    check(&d, &[SPRING, &["load_dependent_friction"]]);
    check_near(&d, "J1", 0.07, 0.15);
}

/// An electronic oscillator with a hardening spring, nine samples to a period: J 5.37e-6, d 2.25e-4, k 0.99, k3 3.9. It
/// moves in metres: the weight of an arm goes with the sine of an angle, and is not in the class of the spring.
#[test]
fn an_oscillator_has_its_hardening_spring() {
    let Some(d) = diagnose_shared("failing/silverbox-as-drive.csv") else {
        return;
    };
    check(&d, &[&["hardening_spring"], &["return_spring"]]);
    check_near(&d, "J1", 5.37e-6, 0.05);
    check_near(&d, "k3", 3.9, 0.05);
}

/// A motor that turns one way, with measured torque.
#[test]
fn a_motor_that_turns_one_way_does_not_tell_its_friction() {
    let Some(d) = diagnose_shared("failing/one-way-drive.csv") else {
        return;
    };
    check(&d, &[&["constant_load", "coulomb_friction", "dead_zone"]]);
}

/// A motor on a staircase of volts, with a speed that is noisy at rest: V = 0.0457 w + 0.734. It turns one way only, and
/// rests where a load would turn it back.
#[test]
fn a_staircase_of_volts_shows_dry_friction_or_a_dead_zone() {
    let Some(d) = diagnose_shared("failing/stair-noisy-speed.csv") else {
        return;
    };
    check(&d, &[&["coulomb_friction", "dead_zone"]]);
    check_near(&d, "c", 0.734, 0.1);
    check_near(&d, "d1", 0.0457, 0.05);
}

/// The lower of two tanks, which runs over at 10 V: no model of one storage fits, and nothing false is named.
#[test]
fn a_tank_below_another_is_unknown_and_its_limit_is_said() {
    let Some(d) = diagnose_shared("failing/tanks-estimation.csv") else {
        return;
    };
    check(&d, &[]);
    assert!(d.verdict.unknown, "{}", d.verdict.text);
    assert!(
        d.verdict.text.to_string().contains("for 47 samples"),
        "{}",
        d.verdict.text
    );
}

/// Its output stays where the input left it: K/T is about -8 per s.
#[test]
fn a_process_that_integrates_has_a_rate_and_no_gain() {
    let Some(d) = diagnose_shared("failing/integrating-process-pulses.csv") else {
        return;
    };
    // Much is left that nothing explains: there a lag may stand for the dead time.
    let [class] = classes(&d).try_into().unwrap();
    assert!(class.contains(&"input_delay"), "{}", d.verdict.text);
    check_near(&d, "K/T", -8.0, 0.1);
    assert!(
        d.verdict.text.to_string().contains("integrates"),
        "{}",
        d.verdict.text
    );
}

/// An industrial servo in one move: friction of 5.5 % at 27 rad/s, 7.2 at 61, 8.9 at 102 and 9.4 at 174.
#[test]
fn friction_that_flattens_with_speed_is_found_in_one_move() {
    let Some(d) = diagnose_shared("failing/servo-single-move.csv") else {
        return;
    };
    let found = classes(&d).concat();
    assert!(found.contains(&"flattening_friction"), "{}", d.verdict.text);
}

/// Length of the arm's record in samples of 5 ms, and steps of the simulation in one.
const SAMPLES: u32 = 2500;
const STEPS: u32 = 50;

/// Weight of the arm, N m, and share of what the gears carry that they rub with.
const WEIGHT: f64 = 5.7;
const SHARE: f64 = 0.3;

/// Where the arm is sent, rad, every one and a half seconds.
const PLACES: [f64; 10] = [0.6, -0.4, 0.9, 0.1, -0.8, 0.5, -0.2, 0.7, -0.6, 0.3];

fn target(t: f64) -> f64 {
    let move_number = (t / 1.5) as usize;
    let to = PLACES[move_number % 10];
    let from = if move_number == 0 {
        0.0
    } else {
        PLACES[(move_number - 1) % 10]
    };
    let share = ((t - 1.5 * move_number as f64) / 0.6).min(1.0);
    from + (to - from) * share * share * (3.0 - 2.0 * share)
}

/// An arm of 0.07 kg m^2 on gears that hold it between moves, with an encoder of 4096 counts a turn; the motor has a
/// dry friction of its own, N m.
fn arm(dry: f64) -> String {
    let (inertia, viscous, count) = (0.07, 0.5, 1.53e-3);
    let mut csv = "t [s],u [N m],x1 [rad]\n".to_owned();
    let (mut x, mut v) = (0.0_f64, 0.0_f64);
    for sample in 0..SAMPLES {
        let t = 5e-3 * f64::from(sample);
        let seen = (x / count).round() * count;
        let u = (16.0 * (target(t) - seen)).clamp(-7.4, 7.4);
        writeln!(csv, "{t:.4},{u:.5},{seen:.5}").unwrap();
        let step = 5e-3 / f64::from(STEPS);
        for _ in 0..STEPS {
            let weight = -WEIGHT * libm::sin(x);
            let friction = dry + SHARE * (u - weight).abs();
            let drive = u + weight - viscous * v;
            let way = if v == 0.0 { drive } else { v };
            let moved = v + (drive - friction.copysign(way)) / inertia * step;
            // It stays where it turns round, and where its drive does not overcome friction.
            let stays = if v == 0.0 {
                drive.abs() <= friction
            } else {
                moved * v < 0.0
            };
            v = if stays { 0.0 } else { moved };
            x += v * step;
        }
    }
    csv
}

#[test]
fn so_do_those_of_an_arm_that_is_made_here() {
    let d = diagnose("arm", arm(0.0).as_bytes());
    check(&d, &[&["gravity"], &["load_dependent_friction"]]);
    assert!(d.verdict.complete, "{}", d.verdict.text);
    check_near(&d, "J1", 0.07, 0.01);
    check_near(&d, "a", WEIGHT, 0.01);
    check_near(&d, "m", SHARE, 0.02);
}

/// Half a step of the encoder hides most of it, but it does not bend the rest.
#[test]
fn a_little_dry_friction_beside_it_does_not_hide_what_the_gears_do() {
    let d = diagnose("arm", arm(0.1).as_bytes());
    let found = classes(&d).concat();
    for effect in ["gravity", "load_dependent_friction"] {
        assert!(found.contains(&effect), "{effect}: {}", d.verdict.text);
    }
    check_near(&d, "J1", 0.07, 0.01);
    check_near(&d, "a", WEIGHT, 0.03);
    check_near(&d, "m", SHARE, 0.03);
}

/// A motor and a load behind a gap that bounces, under a random binary torque and without a drifting test: made by
/// another simulator, with bodies of 2e-3 kg m^2, a half gap of 60 mrad and a contact of 300 N m/rad.
#[test]
fn a_gap_is_measured_under_a_random_binary_torque() {
    let Some(d) = diagnose_shared("measurements-2/prbs-backlash.csv") else {
        return;
    };
    check(&d, &[&["backlash"]]);
    assert!(d.verdict.complete, "{}", d.verdict.text);
    for (symbol, known) in [
        ("J1", 2e-3),
        ("J2", 2e-3),
        ("beta", 0.06),
        ("c2", 0.015),
        ("K", 300.0),
    ] {
        check_near(&d, symbol, known, 0.02);
    }
}
