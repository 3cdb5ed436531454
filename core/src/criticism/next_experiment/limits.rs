//! How far an experiment may go where nothing is said.

use crate::diagnosis::Limits;
use crate::measurement::{Kind, Measurement, Quantity};
use crate::order::range;

/// How many times as fast (as far, for a process) as measured an experiment may go where nothing is said.
const FASTER: f64 = 2.0;

/// The travel that was measured, times this, where a slide has ends.
const FARTHER: f64 = 1.2;

impl Limits {
    /// What the measurement itself did: the same input, length and sampling; no more than twice as fast, and for
    /// a slide hardly farther.
    pub fn of(measurement: &Measurement) -> Self {
        let largest = |values: &[f64]| values.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        let time = &measurement.time;
        let duration = match (time.first(), time.last()) {
            (Some(first), Some(last)) => last - first,
            _ => 0.0,
        };
        let step = duration / time.len().saturating_sub(1).max(1) as f64;
        let position = measurement.output(Quantity::Position).map(|c| &c.values);
        let seen = match measurement.kind {
            Kind::Drive => measurement.output(Quantity::Velocity),
            Kind::Process => measurement.output(Quantity::Output),
        };
        let speed = seen.map_or_else(
            || position.map_or(0.0, |x| fastest(x, step)),
            |c| largest(&c.values),
        );
        let slides = measurement.motion() == crate::measurement::Motion::Translational;
        Self {
            input: largest(&measurement.input.values),
            side: side(&measurement.input.values),
            duration,
            step,
            speed: (speed > 0.0).then_some(FASTER * speed),
            travel: position
                .filter(|_| slides)
                .map(|x| FARTHER * extent(x))
                .filter(|t| *t > 0.0),
        }
    }
}

/// Share of the largest input that may go the other way, by the noise of a measured one.
const OTHER_WAY: f64 = 0.02;

/// The only way in which an input goes, 1 or -1; 0 where it goes both ways.
fn side(input: &[f64]) -> i8 {
    let (low, high) = range(input);
    let little = OTHER_WAY * high.abs().max(low.abs());
    match (low < -little, high > little) {
        (false, true) => 1,
        (true, false) => -1,
        _ => 0,
    }
}

/// Largest less smallest value.
pub(super) fn extent(values: &[f64]) -> f64 {
    let (low, high) = range(values);
    high - low
}

/// Largest mean speed over some twenty samples, free of the steps of an encoder.
fn fastest(position: &[f64], step: f64) -> f64 {
    const APART: usize = 20;
    let moved = position.windows(APART + 1).map(|w| (w[APART] - w[0]).abs());
    moved.fold(0.0, f64::max) / (APART as f64 * step)
}
