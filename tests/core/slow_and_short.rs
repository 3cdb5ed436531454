//! Processes of which a record shows little: far slower than it is long, or in few samples.

use std::fmt::Write as _;

use crate::support::diagnosis::classes;
use crate::support::file::diagnose;
use hysteron_core::diagnosis::Diagnosis;
use hysteron_core::rig::Random;

const NOISE: f64 = 0.05;

/// A tank that fills at this `rate` per second and unit of its input, and empties with this time constant, s; its input
/// is `switched` every so many of its samples, ten seconds apart. As a file.
fn tank(seed: u64, rate: f64, time_constant: f64, switched: usize, samples: usize) -> String {
    let mut random = Random::new(seed);
    let mut level = 0.0;
    let mut csv = "t [s],u [%],y [m]\n".to_owned();
    for k in 0..samples {
        let u = if (k / switched).is_multiple_of(2) {
            20.0
        } else {
            -20.0
        };
        let shown = level + NOISE * random.normal();
        writeln!(csv, "{},{u},{shown:.5}", 10 * k).unwrap();
        for _ in 0..100 {
            level += 0.1 * (rate * u - level / time_constant);
        }
    }
    csv
}

fn check_nothing_is_missing(d: &Diagnosis) {
    assert_eq!(classes(d), [[""; 0]; 0], "{}", d.verdict.text);
    assert!(d.verdict.complete, "{}", d.verdict.text);
}

/// Time constants of ten records and more.
#[test]
fn nothing_is_missing_from_a_process_far_slower_than_its_record() {
    for time_constant in [2.1e4, 4e4, 1e6, f64::INFINITY] {
        for seed in 0..3 {
            check_nothing_is_missing(&diagnose(&tank(seed, 1e-3, time_constant, 20, 200)));
        }
    }
}

/// A residual of few values is as large as its noise to a tenth or two only, and so is what is known of that.
#[test]
fn few_samples_are_not_taken_for_more_than_noise() {
    let unknown = (0..40)
        .filter(|seed| diagnose(&tank(*seed, 1e-2, 300.0, 30, 120)).verdict.unknown)
        .count();
    assert!(unknown <= 2, "{unknown} of 40");
}
