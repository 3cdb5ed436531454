//! A relay loop as the judge of a model: a cart, its position counted by an encoder, between two thresholds of a relay.

use std::fmt::Write as _;

use crate::support::diagnosis::{classes, finish};
use crate::support::shared::shared;
use hysteron_core::criticism::DiagnosisJob;
use hysteron_core::diagnosis::Diagnosis;
use hysteron_core::measurement::import_csv;

/// Sampling time of the relay and the record, s, and steps of the simulation in one.
const STEP: f64 = 1.0 / 150.0;
const STEPS: u32 = 50;

/// Samples of a record.
const SAMPLES: u32 = 2500;

/// Force of the motor, N, mass, kg, count of the encoder, m, and where the relay switches, m.
const FORCE: f64 = 13.4;
const MASS: f64 = 6.3;
const COUNT: f64 = 8.8e-5;
const THRESHOLD: f64 = 2e-3;

#[derive(Clone, Copy)]
struct Cart {
    /// N s/m.
    viscous: f64,
    /// N.
    dry: f64,
    /// Samples from a switch to the next of a square wave; a relay without.
    clock: Option<u32>,
}

impl Cart {
    fn measure(self) -> String {
        let mut csv = "t [s],u [N],x1 [m]\n".to_owned();
        let (mut x, mut v) = (0.0_f64, 0.0_f64);
        let mut forward = true;
        for sample in 0..SAMPLES {
            let seen = (x / COUNT).round() * COUNT;
            forward = match self.clock {
                // A square wave that swings about the start begins with half a push.
                Some(half) => (sample + half / 2) / half % 2 == 0,
                None if forward => seen <= THRESHOLD,
                None => seen < -THRESHOLD,
            };
            let u = if forward { FORCE } else { -FORCE };
            let t = STEP * f64::from(sample);
            writeln!(csv, "{t:.5},{u},{seen:.6}").unwrap();
            let step = STEP / f64::from(STEPS);
            for _ in 0..STEPS {
                let drive = u - self.viscous * v;
                let way = if v == 0.0 { drive } else { v };
                let moved = v + (drive - self.dry.copysign(way)) / MASS * step;
                // It stops where it turns round.
                let stops = v != 0.0 && moved * v < 0.0;
                let after = if stops && self.dry > 0.0 { 0.0 } else { moved };
                x += 0.5 * (v + after) * step;
                v = after;
            }
        }
        csv
    }

    fn diagnosed(self) -> Diagnosis {
        diagnose("cart", self.measure().as_bytes())
    }
}

fn diagnose(name: &str, csv: &[u8]) -> Diagnosis {
    let record = import_csv(name, csv, None).unwrap();
    finish(DiagnosisJob::new(&record).unwrap())
}

/// That a model makes the cycle that was measured to so much.
fn check_cycle(d: &Diagnosis, most: f64) {
    let error = d.steps.last().and_then(|s| s.relay_loop).expect("a loop");
    let (period, amplitude) = (error.period.unwrap(), error.amplitude.unwrap());
    assert!(
        period.abs() < most && amplitude.abs() < most,
        "{error:?}: {}",
        d.verdict.text
    );
    let said = "Left to run in its own relay loop, ";
    assert!(
        d.verdict.text.to_string().contains(said),
        "{}",
        d.verdict.text
    );
}

#[test]
fn dry_friction_of_a_cart_in_a_relay_loop_is_found_and_makes_its_cycle() {
    let cart = Cart {
        viscous: 0.0,
        dry: 3.0,
        clock: None,
    };
    let d = cart.diagnosed();
    // Of an input whose size never changes, friction takes the same share.
    let class = ["coulomb_friction", "load_dependent_friction"];
    assert_eq!(classes(&d), [class], "{}", d.verdict.text);
    check_cycle(&d, 0.05);
}

#[test]
fn viscous_friction_of_such_a_cart_is_nothing_missing_and_makes_its_cycle() {
    let cart = Cart {
        viscous: 19.0,
        dry: 0.0,
        clock: None,
    };
    let d = cart.diagnosed();
    assert!(d.verdict.missing.is_empty(), "{}", d.verdict.text);
    check_cycle(&d, 0.02);
}

/// Its motion passes the same values at every switch, as that of a relay loop does.
#[test]
fn a_square_wave_is_no_relay_loop() {
    for half in [33, 34] {
        let cart = Cart {
            viscous: 19.0,
            dry: 0.0,
            clock: Some(half),
        };
        let d = cart.diagnosed();
        assert!(d.steps.iter().all(|s| s.relay_loop.is_none()));
        assert!(
            !d.verdict.text.to_string().contains("relay loop"),
            "{}",
            d.verdict.text
        );
    }
}

/// A thermostat of two storages: with the second one the process makes its cycle, and without a far other one.
#[test]
fn a_process_makes_its_cycle_with_its_second_lag_only() {
    let Some(csv) = shared("measurements-2/thermostat-lag.csv") else {
        return;
    };
    let d = diagnose("thermostat-lag.csv", &csv);
    check_cycle(&d, 0.03);
    let first = d.steps[0].relay_loop.expect("a loop");
    assert!(
        first.period.is_some_and(|p| p.abs() > 0.4),
        "{first:?}: {}",
        d.verdict.text
    );
}

/// A cart of 6.28 kg whose owner knows dry friction of 2.8 to 3.2 N and no other. Neither dry nor viscous friction
/// explains the motion within a cycle, or does better, and both make the cycle.
#[test]
fn friction_of_a_real_cart_may_be_dry() {
    for file in [
        "cart-0m20-position-only.csv",
        "cart-0m20-velocity-printed.csv",
    ] {
        let Some(csv) = shared(&format!("failing/{file}")) else {
            return;
        };
        let d = diagnose(file, &csv);
        let class = vec!["viscous_friction", "coulomb_friction"];
        assert!(classes(&d).contains(&class), "{file}: {}", d.verdict.text);
        check_cycle(&d, 0.05);
        assert!(d.verdict.next_experiment.is_some());
    }
}
