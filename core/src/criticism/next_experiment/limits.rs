//! How far an experiment may go.

use serde::{Deserialize, Serialize};

use crate::measurement::{Kind, Measurement, Quantity};
use crate::order::range;

/// How many times as fast (as far, for a process) as measured an experiment may go where nothing is said.
const FASTER: f64 = 2.0;

/// The travel that was measured, times this, where a slide has ends.
const FARTHER: f64 = 1.2;

/// Bounds of an experiment. Every value is above 0.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Limits {
    /// Largest input in either direction, in its unit.
    pub input: f64,
    /// Whether the input goes one way only, from 0 to that size (1) or to its negative (-1), as a heater does; 0: both ways.
    #[serde(default)]
    pub side: i8,
    /// Longest record, s.
    pub duration: f64,
    /// Sampling time, s.
    pub step: f64,
    /// Largest velocity of a drive, or output of a process, in its unit.
    pub speed: Option<f64>,
    /// Largest travel of a drive between its ends, rad or m.
    pub travel: Option<f64>,
}

/// What is wrong with a limit.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("limit '{text}': expected {expected}")]
pub struct LimitError {
    text: String,
    expected: &'static str,
}

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
        let slides = measurement.motion() == crate::effect::Motion::Translational;
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

    /// Takes limits as a user writes them, `input=0.5, duration=10, step=2e-4, speed=20, travel=none` in SI units;
    /// what is not named stays.
    pub fn set(&mut self, text: &str) -> Result<(), LimitError> {
        let error = |part: &str, expected| LimitError {
            text: part.trim().to_owned(),
            expected,
        };
        for part in text.split(',').filter(|p| !p.trim().is_empty()) {
            let Some((name, value)) = part.split_once('=') else {
                return Err(error(part, "NAME=VALUE"));
            };
            let (name, value) = (name.trim(), value.trim());
            let number = value
                .parse::<f64>()
                .ok()
                .filter(|v| v.is_finite() && *v > 0.0);
            match (name, number) {
                ("input", Some(v)) => self.input = v,
                ("side", None) if value == "both" => self.side = 0,
                ("duration", Some(v)) => self.duration = v,
                ("step", Some(v)) => self.step = v,
                ("speed", Some(v)) => self.speed = Some(v),
                ("travel", Some(v)) => self.travel = Some(v),
                ("speed", None) if value == "none" => self.speed = None,
                ("travel", None) if value == "none" => self.travel = None,
                ("speed" | "travel", None) => return Err(error(part, "a number above 0, or none")),
                ("input" | "duration" | "step", None) => {
                    return Err(error(part, "a number above 0"));
                }
                _ => {
                    return Err(error(
                        part,
                        "one of input, duration, step, speed, travel with its value in SI units, or side=both",
                    ));
                }
            }
        }
        Ok(())
    }

    /// A level between the lowest and the highest input, from -1 to 1.
    pub(super) fn level(&self, share: f64) -> f64 {
        match self.side {
            0 => share * self.input,
            side => f64::from(side) * self.input * 0.5 * (share + 1.0),
        }
    }

    /// Whether every value can be.
    pub(super) fn are_sound(&self) -> bool {
        let good = |v: f64| v.is_finite() && v > 0.0;
        good(self.input)
            && good(self.duration)
            && good(self.step)
            && self.speed.is_none_or(good)
            && self.travel.is_none_or(good)
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
