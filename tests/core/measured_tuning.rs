//! From a measured relay test to the plant's point, ultimate gain, models and gains.

use std::f64::consts::PI;

use hysteron_core::tuning::measured::{MeasuredTuning, Settings, tune_record};

use crate::support::relay_rig::{Plant, Test, plants, relay_test, tests};

/// One test of the bench against the plant's own numbers.
struct Outcome {
    name: String,
    magnitude: f64,
    phase: f64,
    ultimate: Option<[f64; 2]>,
    formula: Option<[f64; 2]>,
    result: MeasuredTuning,
}

fn outcome(plant: &Plant, test: &Test, seed: u64) -> Outcome {
    let record = relay_test(plant, test, seed);
    let result = tune_record(&record, &Settings::default()).unwrap();
    let point = result
        .point
        .unwrap_or_else(|| panic!("{}, {}: {}", plant.name, test.name, result.text));
    let [magnitude, phase] = plant.response(point.omega);
    let [gain, period] = plant.ultimate();
    let turn = (point.phase_deg - phase.to_degrees() + 180.0).rem_euclid(360.0) - 180.0;
    Outcome {
        name: format!("{}, {}", plant.name, test.name),
        magnitude: point.magnitude / magnitude - 1.0,
        phase: turn,
        ultimate: result
            .ultimate
            .map(|u| [u.gain / gain - 1.0, u.period / period - 1.0]),
        formula: result
            .conventional
            .map(|c| [c.gain / gain - 1.0, c.period / period - 1.0]),
        result,
    }
}

/// All 60 of the bench.
fn bench(seed: u64) -> Vec<Outcome> {
    let mut outcomes = Vec::new();
    for plant in plants() {
        for test in tests() {
            outcomes.push(outcome(&plant, &test, seed + outcomes.len() as u64));
        }
    }
    outcomes
}

fn quantile(mut values: Vec<f64>, share: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    values[((values.len() as f64 * share) as usize).min(values.len() - 1)]
}

#[test]
fn blind_relay_tests_show_the_point_and_the_ultimate_gain() {
    let outcomes = bench(std::env::var("TUNE_SEED").map_or(1, |s| s.parse().unwrap()));
    for o in &outcomes {
        let p = |v: Option<[f64; 2]>| {
            v.map_or("-".to_owned(), |v| {
                format!("{:+.1} {:+.1}", 100.0 * v[0], 100.0 * v[1])
            })
        };
        let point = o.result.point.unwrap();
        println!(
            "{:55} |P| {:+6.2} % ({:.2}) phase {:+6.2} ({:.2})  at {:.0}  Ku Tu {:12} formula {:12} {} {:.4}",
            o.name,
            100.0 * o.magnitude,
            100.0 * point.std_error_magnitude / point.magnitude,
            o.phase,
            point.std_error_phase_deg,
            point.phase_deg,
            p(o.ultimate),
            p(o.formula),
            o.result.models[0].structure.id(),
            o.result.models[0].left,
        );
    }
    let magnitudes: Vec<f64> = outcomes.iter().map(|o| o.magnitude.abs()).collect();
    let phases: Vec<f64> = outcomes.iter().map(|o| o.phase.abs()).collect();
    println!(
        "|P| {:.4} {:.4} phase {:.2} {:.2}",
        quantile(magnitudes.clone(), 0.5),
        quantile(magnitudes.clone(), 0.95),
        quantile(phases.clone(), 0.5),
        quantile(phases.clone(), 0.95)
    );
    let _ = PI;
}
