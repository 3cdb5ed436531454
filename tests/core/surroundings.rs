//! Processes that begin at rest, not at zero but where their surroundings are: a heater in a warm room.

use std::fmt::Write as _;

use crate::support::diagnosis::{classes, step};
use crate::support::file::diagnose;
use crate::support::value::check_value;
use hysteron_core::criticism::StepJob;
use hysteron_core::diagnosis::Diagnosis;
use hysteron_core::effect::EffectId;
use hysteron_core::measurement::import_csv;
use hysteron_core::rig::Random;

const DELAY: EffectId = EffectId::new("input_delay");

/// What it is at rest, its gain, and its time constant, s.
const ROOM: f64 = 20.0;
const GAIN: f64 = 0.8;
const TIME_CONSTANT: f64 = 40.0;

const NOISE: f64 = 0.05;
const SAMPLES: usize = 1500;

/// Steps between two samples, one second apart.
const STEPS: usize = 200;

/// A heater behind a wall and a dead time, switched by a relay, as a file; before the relay it is off for so many
/// samples.
fn heater(seed: u64, wall: f64, dead_time: f64, off: usize) -> String {
    let step = 1.0 / STEPS as f64;
    let mut random = Random::new(seed);
    let (mut inner, mut outer) = (ROOM, ROOM);
    let mut late = vec![0.0; (dead_time / step) as usize + 1];
    let mut on = true;
    let mut csv = "t [s],u [%],y [1]\n".to_owned();
    for k in 0..SAMPLES {
        let shown = outer + NOISE * random.normal();
        on = if on { shown < 55.0 } else { shown < 45.0 };
        let heat = if on && k >= off { 60.0 } else { 0.0 };
        writeln!(csv, "{k},{heat},{shown:.4}").unwrap();
        for i in 0..STEPS {
            let place = (k * STEPS + i) % late.len();
            late[place] = heat;
            let acting = late[(place + 1) % late.len()];
            let driven = ROOM + GAIN * acting;
            // Euler's rule in steps of a few thousandths of the time constants.
            outer +=
                step * if wall > 0.0 {
                    inner - outer
                } else {
                    driven - outer
                } / TIME_CONSTANT;
            inner += step
                * if wall > 0.0 {
                    (driven - inner) / wall
                } else {
                    0.0
                };
        }
    }
    csv
}

fn check(d: &Diagnosis, missing: &[&[&str]], parameters: &[(&str, f64)]) {
    let mut found = classes(d);
    found.sort();
    assert_eq!(found, missing, "{}", d.verdict.text);
    assert!(d.verdict.complete, "{}", d.verdict.text);
    for (symbol, truth) in parameters {
        check_value(d, symbol, *truth);
    }
}

/// The room's warmth has filled the wall already: the wall is no sensor that is late.
#[test]
fn what_stores_heat_on_the_way_is_as_warm_as_the_room_at_first() {
    for seed in 1..4 {
        let d = diagnose(&heater(seed, 10.0, 0.0, 5));
        let missing: &[&str] = &["second_lag", "sensor_lag"];
        check(&d, &[missing], &[("K", GAIN), ("ambient", ROOM)]);
    }
}

/// It came on with the record, which shows in how late the output begins, little as that is.
#[test]
fn a_thin_wall_is_as_warm_as_the_room_though_the_heater_is_on_from_the_first() {
    for (seed, wall) in [(7, 6.0), (8, 10.0), (9, 15.0)] {
        let d = diagnose(&heater(seed, wall, 0.0, 0));
        let missing: &[&str] = &["second_lag", "sensor_lag"];
        check(&d, &[missing], &[("K", GAIN), ("ambient", ROOM)]);
    }
}

/// It lies still while the dead time lasts: the heater came on with the record.
#[test]
fn an_input_that_comes_on_with_the_record_was_off_before() {
    for (seed, off) in [(1, 0), (2, 0), (3, 0), (4, 5)] {
        let d = diagnose(&heater(seed, 0.0, 8.0, off));
        let truth = [
            ("K", GAIN),
            ("T", TIME_CONSTANT),
            ("tau", 8.0),
            ("ambient", ROOM),
        ];
        check(&d, &[&["input_delay"]], &truth);
    }
}

/// A record that was cut out of a longer one, when the input had been what it is for longer than the dead time.
#[test]
fn an_output_that_is_on_its_way_at_first_was_driven_before() {
    let whole = heater(5, 0.0, 8.0, 0);
    let rows: Vec<&str> = whole.lines().collect();
    let heat = |row: &str| row.split(',').nth(1).map(str::to_owned);
    let steady = |k: &usize| (k - 12..k + 3).all(|i| heat(rows[i]) == heat(rows[*k]));
    let effects = [DELAY];
    for cut in (400..rows.len()).filter(steady).step_by(9).take(6) {
        let part = [&rows[..1], &rows[cut..]].concat().join("\n");
        let record = import_csv("heater", part.as_bytes(), None).unwrap();
        let report = step(StepJob::new(&record, &effects).unwrap());
        assert!(report.step.error < 1.1, "row {cut}: {}", report.step.error);
    }
}

/// A record that was cut out of a longer one: the wall holds what the heater gave before, of which the record says
/// nothing.
#[test]
fn a_wall_that_is_warm_at_first_is_as_warm_as_the_record_shows() {
    let classes: &[&str] = &["second_lag", "sensor_lag"];
    for (seed, cut) in [(11, 300), (12, 340), (13, 380)] {
        let whole = heater(seed, 10.0, 0.0, 0);
        let rows: Vec<&str> = whole.lines().collect();
        // It is switched off some seconds before the record begins.
        let switched = |k: &usize| {
            let heat = |row: &str| row.split(',').nth(1) == Some("0");
            heat(rows[*k]) && !heat(rows[*k - 1])
        };
        let begin = (cut..rows.len()).find(switched).unwrap() + 5;
        let part = [&rows[..1], &rows[begin..]].concat().join("\n");
        let d = diagnose(&part);
        check(&d, &[classes], &[("K", GAIN), ("ambient", ROOM)]);
        let record = import_csv("heater", part.as_bytes(), None).unwrap();
        for effect in [EffectId::new("second_lag"), EffectId::new("sensor_lag")] {
            let effects = [effect];
            let report = step(StepJob::new(&record, &effects).unwrap());
            let first = report.replay.channels[0].modelled[..20].iter();
            let measured = record.outputs[0].values.iter();
            let square: f64 = first.zip(measured).map(|(m, y)| (m - y).powi(2)).sum();
            let left = (square / 20.0).sqrt();
            assert!(left < 2.0 * NOISE, "{effect:?}, row {begin}: {left}");
        }
    }
}
