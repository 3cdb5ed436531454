//! How far an experiment may go.

use serde::{Deserialize, Serialize};

use crate::message::{Message, says};
use crate::msg;

/// Bounds of an experiment. Every value is above 0.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Limits {
    /// Largest input in either direction, in its unit.
    pub input: f64,
    /// Whether the input goes one way only, from 0 to that size (1) or to its negative (-1), as a heater does; 0: both
    /// ways.
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
pub struct LimitError {
    text: String,
    expected: &'static str,
}

impl LimitError {
    /// In words.
    pub fn message(&self) -> Message {
        msg!(
            "limit '{}': expected {}",
            Message::name(self.text.clone()),
            &self.expected
        )
    }
}

says!(LimitError);

impl Limits {
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
    pub(crate) fn level(&self, share: f64) -> f64 {
        match self.side {
            0 => share * self.input,
            side => f64::from(side) * self.input * 0.5 * (share + 1.0),
        }
    }

    /// Whether every value can be.
    pub(crate) fn are_sound(&self) -> bool {
        let good = |v: f64| v.is_finite() && v > 0.0;
        good(self.input)
            && good(self.duration)
            && good(self.step)
            && self.speed.is_none_or(good)
            && self.travel.is_none_or(good)
    }
}
