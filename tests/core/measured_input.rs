//! An input that a sensor with noise has read: the noise does not act, and nothing that clips it is missing.

use std::fmt::Write as _;

use crate::support::controlled::level_under_controller;
use crate::support::diagnosis::classes;
use crate::support::file::diagnose;
use crate::support::score::diagnose as diagnosed;
use hysteron_core::criticism::screen;
use hysteron_core::diagnosis::{Diagnosis, InputVerdict};
use hysteron_core::rig::Random;

const INERTIA: f64 = 2e-3;
const VISCOUS: f64 = 4e-3;
const STEP: f64 = 2e-3;
const FINE: usize = 20;

/// A motor whose current is switched between levels at random or swings, read with noise.
fn record(seed: u64, noise: f64, switched: bool) -> String {
    let mut random = Random::new(seed);
    let (mut x, mut v, mut level) = (0.0, 0.0, 0.0);
    let mut csv = "t [s],u [N m],x1 [rad]\n".to_owned();
    for k in 0..4000 {
        let t = f64::from(k) * STEP;
        if k % 40 == 0 {
            level = 0.1 * random.sign();
        }
        let torque = if switched {
            level
        } else {
            0.06 * (f64::sin(6.0 * t) + f64::sin(17.0 * t))
        };
        let read = torque + noise * random.normal();
        writeln!(csv, "{t},{read},{}", x + 2e-4 * random.normal()).unwrap();
        for _ in 0..FINE {
            let h = STEP / FINE as f64;
            v += h * (torque - VISCOUS * v) / INERTIA;
            x += h * v;
        }
    }
    csv
}

#[track_caller]
fn has_its_inertia(diagnosis: &Diagnosis) {
    let last = diagnosis.steps.last().expect("a step");
    let found = last.parameters[0].value;
    assert!((found / INERTIA - 1.0).abs() < 0.02, "{found}");
}

#[test]
fn nothing_that_clips_the_noise_of_a_sensor_is_named() {
    for (seed, noise) in [(2, 1e-2), (4, 2e-2)] {
        let d = diagnose(&record(seed, noise, true));
        let text = d.verdict.text.to_string();
        assert!(classes(&d).is_empty(), "{seed}: {text}");
        assert!(text.contains("its readings were averaged"), "{text}");
        has_its_inertia(&d);
    }
}

/// Of an input that swings the noise cannot be taken off; what it does to the motion is known.
#[test]
fn what_the_noise_of_an_input_leaves_is_no_missing_effect() {
    for (seed, noise) in [(1, 2e-3), (2, 5e-3)] {
        let d = diagnose(&record(seed, noise, false));
        let text = d.verdict.text.to_string();
        assert!(
            classes(&d).is_empty() && d.verdict.complete,
            "{seed}: {text}"
        );
        has_its_inertia(&d);
    }
}

/// A tank that keeps what is pumped into it, under a controller: its level moves against what that answers to.
#[test]
fn a_plant_that_integrates_is_told_in_a_closed_loop() {
    let record = level_under_controller();
    let check = screen(&record).input_check;
    assert_eq!(check.verdict, InputVerdict::ClosedLoop, "{}", check.text);
    assert!(check.plant_told, "{}", check.text);
    let diagnosis = diagnosed(&record).expect("a diagnosis");
    let last = diagnosis.steps.last().expect("a step");
    let rate = last.parameters.iter().find(|p| p.name == "K/T");
    let rate = rate.unwrap_or_else(|| panic!("{}", diagnosis.verdict.text));
    assert!((rate.value / 0.02 - 1.0).abs() < 0.02, "{}", rate.value);
}
