//! Axes that move now and then, and rest for most of the record.

use std::fmt::Write as _;

use crate::support::diagnosis::classes;
use crate::support::file::diagnose;
use crate::support::value::check_value;

const INERTIA: f64 = 4e-3;
const VISCOUS: f64 = 0.01;

/// Time between samples, s, their number, and steps of the rig between two.
const STEP: f64 = 2e-3;
const SAMPLES: usize = 10_000;
const STEPS: usize = 20;

/// Step of the encoder, rad.
const COUNT: f64 = std::f64::consts::TAU / 20_000.0;

/// Way of one move, rad, how long it takes, and how long until the next begins, s.
const WAY: f64 = 1.0;
const MOVE: f64 = 0.3;
const EVERY: f64 = 2.0;

/// Where an index table is to be: one way, move after move.
fn wanted(t: f64) -> f64 {
    let (moves, since) = ((t / EVERY).floor(), t % EVERY);
    let s = (since / MOVE).min(1.0);
    WAY * (moves + s * s * (3.0 - 2.0 * s))
}

/// An index table with dry friction of this level, N m, under a position controller, as a file: its friction holds it
/// exactly, by what force there is.
fn indexing(level: f64) -> String {
    let (mut x, mut v, mut sum) = (0.0, 0.0, 0.0);
    let mut csv = "t [s],u [N m],x1 [rad]\n".to_owned();
    let (h, mut before) = (STEP / STEPS as f64, 0.0);
    for k in 0..SAMPLES {
        let t = k as f64 * STEP;
        let shown = (x / COUNT).floor() * COUNT;
        let off = wanted(t) - shown;
        sum += STEP * off;
        let torque = (10.0 * off + 0.3 * (off - before) / STEP + 20.0 * sum).clamp(-1.0, 1.0);
        before = off;
        writeln!(csv, "{t},{torque},{shown}").unwrap();
        for _ in 0..STEPS {
            let free = v + h * (torque - VISCOUS * v) / INERTIA;
            let held = h * level / INERTIA;
            v = free.signum() * (free.abs() - held).max(0.0);
            x += h * v;
        }
    }
    csv
}

#[test]
fn dry_friction_is_found_in_the_few_moves_of_an_index_table() {
    for level in [0.1, 0.2, 0.3] {
        let d = diagnose(&indexing(level));
        assert_eq!(classes(&d), [["coulomb_friction"]], "{}", d.verdict.text);
        assert!(d.verdict.complete, "{}", d.verdict.text);
        check_value(&d, "c", level);
        check_value(&d, "J1", INERTIA);
    }
}

#[test]
fn nothing_is_found_where_it_does_not_rub() {
    let d = diagnose(&indexing(0.0));
    assert_eq!(classes(&d), [[""; 0]; 0], "{}", d.verdict.text);
    assert!(d.verdict.complete, "{}", d.verdict.text);
}
