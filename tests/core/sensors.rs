//! Sensors that are not what the text books say: noise with a memory, values that jump. Nothing of that is said to be
//! missing from the machine, and nothing that is missing hides behind it.

use crate::support::diagnosis::{classes, finish};
use hysteron_core::criticism::DiagnosisJob;
use hysteron_core::diagnosis::Diagnosis;
use hysteron_core::measurement::Measurement;
use hysteron_core::rig::{DriveRig, Excitation, Friction, Random, Recorded, Stranger};

/// Of the velocity, rad/s.
const NOISE: f64 = 0.02;

/// A drive with a tachometer, without noise but for its last digit.
fn drive(friction: f64, stranger: Option<Stranger>) -> Measurement {
    let rig = DriveRig {
        excitation: Excitation::Multisine { amplitude: 0.08 },
        friction: Friction::dry(friction),
        velocity_noise: NOISE / 50.0,
        recorded: Recorded::VelocityOnly,
        samples: 8000,
        stranger,
        ..DriveRig::default()
    };
    rig.measure()
}

/// A normal value, by the sum of twelve even ones.
fn normal(random: &mut Random) -> f64 {
    (0..12).map(|_| random.between(-0.5, 0.5)).sum()
}

/// The same record with a noise of which each value remembers this share of the one before.
fn with_noise(mut record: Measurement, memory: f64, seed: u64) -> Measurement {
    let mut random = Random::new(seed);
    let fresh = NOISE * (1.0 - memory * memory).sqrt();
    let mut noise = 0.0;
    for value in &mut record.outputs[0].values {
        noise = memory * noise + fresh * normal(&mut random);
        *value += noise;
    }
    record
}

fn diagnose(record: &Measurement) -> Diagnosis {
    finish(DiagnosisJob::new(record).unwrap())
}

/// Checks that with these effects nothing else is missing.
fn check(d: &Diagnosis, missing: &[&str]) {
    let wanted: Vec<Vec<&str>> = missing.iter().map(|e| vec![*e]).collect();
    assert_eq!(classes(d), wanted, "{}", d.verdict.text);
    assert!(d.verdict.complete, "{}", d.verdict.text);
    let last = d.steps.last().unwrap();
    assert!(
        last.error < 1.1 * d.noise_floor,
        "{} of {}",
        last.error,
        d.noise_floor
    );
}

/// The effects are found, and the verdict says these words.
fn check_said(record: &Measurement, missing: &[&str], words: &str) {
    let d = diagnose(record);
    check(&d, missing);
    assert!(
        d.verdict.text.to_string().contains(words),
        "{}",
        d.verdict.text
    );
}

#[test]
fn noise_that_remembers_is_no_missing_effect_and_hides_none() {
    for (friction, missing) in [(0.0, vec![]), (0.01, vec!["coulomb_friction"])] {
        let d = diagnose(&with_noise(drive(friction, None), 0.6, 3));
        check(&d, &missing);
        // A share of 0.6 makes neighbours differ by less than their noise is.
        assert!(d.noise_floor > 1.15, "{}", d.noise_floor);
        assert!(
            d.verdict.text.to_string().contains("is correlated"),
            "{}",
            d.verdict.text
        );
        assert!(d.steps.last().unwrap().findings.is_empty());
    }
}

#[test]
fn white_noise_has_a_floor_of_one() {
    let d = diagnose(&with_noise(drive(0.0, None), 0.0, 4));
    check(&d, &[]);
    assert!((d.noise_floor - 1.0).abs() < f64::EPSILON);
    assert!(
        !d.verdict.text.to_string().contains("is correlated"),
        "{}",
        d.verdict.text
    );
}

/// What acts once is not noise, however small and short it is.
#[test]
fn a_faint_stranger_does_not_pass_for_noise_that_remembers() {
    let push = Stranger::Pulse {
        torque: 6e-3,
        from: 0.8,
        length: 0.1,
    };
    let d = diagnose(&with_noise(drive(0.0, Some(push)), 0.0, 5));
    let error = d.steps.last().unwrap().error_fit;
    assert!((1.15..2.0).contains(&error), "{error}: {}", d.verdict.text);
    assert!(d.verdict.unknown, "{}", d.verdict.text);
}

#[test]
fn single_values_that_jump_are_left_out_and_said() {
    for (friction, missing) in [(0.0, vec![]), (0.01, vec!["coulomb_friction"])] {
        let mut record = with_noise(drive(friction, None), 0.0, 6);
        for (place, jump) in [(700, 40.0), (2900, -25.0), (2990, 300.0), (6100, 15.0)] {
            record.outputs[0].values[place] += jump * NOISE;
        }
        check_said(&record, &missing, "4 outliers");
    }
}

/// A bus that is slower than the log: each reading comes four times.
#[test]
fn of_a_channel_that_holds_its_readings_only_the_fresh_ones_count() {
    for (friction, missing) in [(0.0, vec![]), (0.01, vec!["coulomb_friction"])] {
        let mut record = with_noise(drive(friction, None), 0.0, 7);
        for readings in record.outputs[0].values.chunks_mut(4) {
            let fresh = readings[0];
            readings.fill(fresh);
        }
        check_said(&record, &missing, "between 2000 readings");
    }
}

#[test]
fn two_values_in_a_row_beyond_all_others_are_left_out_and_said() {
    for (friction, missing) in [(0.0, vec![]), (0.01, vec!["coulomb_friction"])] {
        let mut record = with_noise(drive(friction, None), 0.0, 8);
        let values = &mut record.outputs[0].values;
        let highest = values.iter().fold(0.0_f64, |high, v| high.max(*v));
        values[3100] = 2.0 * highest;
        values[3101] = 2.1 * highest;
        check_said(&record, &missing, "2 outliers");
    }
}

#[test]
fn of_a_sensor_at_its_limit_only_the_rest_counts() {
    for (friction, missing) in [(0.0, &[][..]), (0.03, &["coulomb_friction"])] {
        let mut record = with_noise(drive(friction, None), 0.0, 4);
        let values = &mut record.outputs[0].values;
        let most = values.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
        for value in values {
            *value = value.clamp(-0.6 * most, 0.6 * most);
        }
        check_said(&record, missing, "its sensor was at its limit");
    }
}
