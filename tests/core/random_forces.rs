//! A body that is pushed at random between the samples: what a controller that is faster than the record, or a rough
//! way, does to it. No model can know that, and nothing is missing.

use std::fmt::Write as _;

use crate::support::diagnosis::classes;
use crate::support::file::diagnose;
use hysteron_core::rig::Random;

const INERTIA: f64 = 8e-4;
const VISCOUS: f64 = 6e-3;
const TORQUE: f64 = 0.1;

/// Time between samples, s, and noise of the velocity, rad/s.
const STEP: f64 = 5e-4;
const NOISE: f64 = 0.03;
const SAMPLES: usize = 8000;

/// Pushes between two samples.
const PUSHES: usize = 4;

/// What the body is pushed by: at random, N m, or by a spring to the ground, N m/rad.
#[derive(Clone, Copy, Default)]
struct Force {
    random: f64,
    spring: f64,
}

/// A body that two waves of torque swing, as a file.
fn record(seed: u64, force: Force) -> String {
    let mut random = Random::new(seed);
    let (mut x, mut v) = (0.0, 0.0);
    let mut csv = "t [s],u [N m],v1 [rad/s]\n".to_owned();
    let h = STEP / PUSHES as f64;
    for k in 0..SAMPLES {
        let t = k as f64 * STEP;
        let torque = TORQUE * (f64::sin(5.0 * t) + f64::sin(22.0 * t));
        let shown = v + NOISE * random.normal();
        writeln!(csv, "{t},{torque},{shown}").unwrap();
        for _ in 0..PUSHES {
            let push = force.random * random.normal() - force.spring * x;
            // The midpoint rule.
            let rate = |v: f64| (torque + push - VISCOUS * v) / INERTIA;
            let middle = v + 0.5 * h * rate(v);
            x += h * middle;
            v += h * rate(middle);
        }
    }
    csv
}

const SAID: &str = "small random forces";

#[test]
fn random_forces_are_no_missing_effect() {
    for (seed, random) in [(1, 1.6e-2), (2, 2.4e-2), (3, 2.4e-2)] {
        let d = diagnose(&record(
            seed,
            Force {
                random,
                spring: 0.0,
            },
        ));
        assert_eq!(classes(&d), [[""; 0]; 0], "{}", d.verdict.text);
        assert!(
            d.verdict.complete && !d.verdict.unknown,
            "{}",
            d.verdict.text
        );
        assert!(
            d.verdict.text.to_string().contains(SAID),
            "{}",
            d.verdict.text
        );
        let error = d.steps.last().unwrap().error;
        assert!(error > 1.2, "nothing to explain: {error}");
    }
}

/// It does what its place tells it to.
#[test]
fn a_spring_is_no_random_force_and_no_friction() {
    for (seed, spring) in [(4, 0.01), (5, 0.1), (6, 0.5)] {
        let d = diagnose(&record(
            seed,
            Force {
                random: 0.0,
                spring,
            },
        ));
        assert_eq!(classes(&d), [["return_spring"]], "{}", d.verdict.text);
        assert!(
            !d.verdict.text.to_string().contains(SAID),
            "{}",
            d.verdict.text
        );
    }
}
