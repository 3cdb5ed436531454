//! Do the stated errors of a measured relay test cover the truth as often as they claim?

#![allow(
    clippy::disallowed_macros,
    reason = "the core does not print; its bench does"
)]

use std::collections::BTreeMap;

use hysteron_core::tuning::measured::{FittedModel, Record, Settings, Structure, tune_record};

use crate::support::relay_rig::{Plant, Test, plants, relay_test, tests};

/// Seeds of the regular run; `HYSTERON_COVERAGE_SEEDS=from,to` asks for others.
const SEEDS: [u64; 2] = [1, 2];

/// Smallest share of the intervals of two standard errors that hold the truth.
const COVERED: f64 = 0.9;

/// The structure that holds a plant of the bench exactly, if there is one.
fn own_structure(plant: &Plant) -> Option<Structure> {
    match (
        plant.lags.len(),
        plant.integrates,
        plant.zero == 0.0,
        plant.dead_time > 0.0,
    ) {
        (0, true, true, true) => Some(Structure::Integrator),
        (1, true, true, true) => Some(Structure::IntegratorLag),
        (1, false, true, true) => Some(Structure::Fopdt),
        (2, false, true, true) => Some(Structure::Sopdt),
        (2, false, false, true) => Some(Structure::SopdtZero),
        _ => None,
    }
}

/// The bench's tests that have an error to state, and two whose load wanders at random.
fn uncertain_tests() -> Vec<Test> {
    let mut all: Vec<Test> = tests().into_iter().filter(|t| t.noise > 0.0).collect();
    let noisy = all[0].clone();
    all.push(Test {
        name: "wandering load",
        wander: 0.05,
        noise: 0.01,
        ..noisy.clone()
    });
    all.push(Test {
        name: "wandering load, biased",
        wander: 0.1,
        noise: 0.01,
        holds: 0.3,
        ..noisy
    });
    all
}

/// Errors in standard errors, by test and quantity.
type Pulls = BTreeMap<(String, &'static str), Vec<f64>>;

fn pulls_of(plant: &Plant, test: &Test, record: &Record, pulls: &mut Pulls) {
    let result = tune_record(record, &Settings::default()).unwrap();
    let mut add = |quantity, value: f64, truth: f64, error: f64| {
        let pull = (value - truth) / error.max(1e-9 * truth.abs());
        let kept = pulls.entry((test.name.to_owned(), quantity)).or_default();
        kept.push(pull);
    };
    if let Some(point) = result.point {
        let [magnitude, phase] = plant.response(point.omega);
        let turned = (point.phase_deg - phase.to_degrees() + 180.0).rem_euclid(360.0) - 180.0;
        add("|P|", point.magnitude, magnitude, point.std_error_magnitude);
        add("phase", turned, 0.0, point.std_error_phase_deg);
    }
    if let Some(u) = result.ultimate {
        let [gain, period] = plant.ultimate();
        add("Ku", u.gain, gain, u.std_error_gain);
        add("Tu", u.period, period, u.std_error_period);
    }
    // A gain that is not known to half its value is not told.
    let told = |m: &&FittedModel| m.gain.std_error < 0.5 * m.gain.value.abs();
    let own = own_structure(plant);
    let Some(model) = (result.models.iter().filter(told)).find(|m| Some(m.structure) == own) else {
        return;
    };
    add("K", model.gain.value, plant.gain, model.gain.std_error);
    for (name, (fitted, own)) in ["T", "T2"]
        .into_iter()
        .zip(model.time_constants.iter().zip(&plant.lags))
    {
        add(name, fitted.value, *own, fitted.std_error);
    }
    add(
        "L",
        model.dead_time.value,
        plant.dead_time,
        model.dead_time.std_error,
    );
}

fn pulls(from: u64, to: u64) -> Pulls {
    let (plants, tests) = (plants(), uncertain_tests());
    let of = |first: u64| {
        let mut pulls = Pulls::new();
        for seed in (from..to).filter(|s| s % 2 == first) {
            for (i, plant) in plants.iter().enumerate() {
                for (k, test) in tests.iter().enumerate() {
                    let own = 1000 * seed + (i * tests.len() + k) as u64;
                    let record = relay_test(plant, test, own);
                    pulls_of(plant, test, &record, &mut pulls);
                }
            }
        }
        pulls
    };
    let mut all = Pulls::new();
    std::thread::scope(|scope| {
        let other = scope.spawn(|| of(1));
        for part in [of(0), other.join().unwrap()] {
            for (key, more) in part {
                all.entry(key).or_default().extend(more);
            }
        }
    });
    all
}

/// Share of the pulls within so many standard errors.
fn within(pulls: &[f64], errors: f64) -> f64 {
    pulls.iter().filter(|p| p.abs() <= errors).count() as f64 / pulls.len().max(1) as f64
}

#[test]
fn stated_errors_cover() {
    let [from, to] = std::env::var("HYSTERON_COVERAGE_SEEDS").map_or(SEEDS, |s| {
        let parts: Vec<u64> = s.split(',').map(|p| p.parse().unwrap()).collect();
        [parts[0], parts[1]]
    });
    let pulls = pulls(from, to);
    let mut by_quantity: BTreeMap<&str, Vec<f64>> = BTreeMap::new();
    for ((test, quantity), values) in &pulls {
        by_quantity.entry(quantity).or_default().extend(values);
        let mut sizes: Vec<f64> = values.iter().map(|v| v.abs()).collect();
        sizes.sort_by(f64::total_cmp);
        println!(
            "{test:30} {quantity:6} {:4} cases  within 1: {:3.0} %  within 2: {:3.0} %  median {:.2}  worst {:.1}",
            values.len(),
            100.0 * within(values, 1.0),
            100.0 * within(values, 2.0),
            sizes[sizes.len() / 2],
            sizes[sizes.len() - 1],
        );
    }
    for (quantity, values) in &by_quantity {
        println!(
            "all {quantity:6} {:5} cases  within 1: {:3.0} %  within 2: {:3.0} %",
            values.len(),
            100.0 * within(values, 1.0),
            100.0 * within(values, 2.0),
        );
    }
    for (quantity, values) in by_quantity {
        let share = within(&values, 2.0);
        assert!(share >= COVERED, "{quantity}: {share}");
    }
}
