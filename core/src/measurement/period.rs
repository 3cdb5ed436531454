//! The time from one sample to the next, where a file has no times.

use std::fmt;
use std::str::FromStr;

use super::column::shorten;
use super::unit::{Measures, parse};
use crate::message::{Message, says};
use crate::msg;

/// Shortest and longest period, s: beyond these the times of a long record are no numbers to calculate with.
const LEAST: f64 = 1e-12;
const MOST: f64 = 1e12;

/// The time from one sample to the next, as in `4s`, `0.5 ms`, `2 min` or `100 Hz`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Period {
    seconds: f64,
}

/// Not a number with a unit of time or frequency.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub struct PeriodError {
    /// What was found.
    pub text: String,
}

impl PeriodError {
    /// In words.
    pub fn message(&self) -> Message {
        msg!(
            "'{}' is not a sampling period; expected a number and its unit, such as 4s, 0.5ms, 2min or 100Hz",
            Message::name(self.text.clone())
        )
    }
}

says!(PeriodError);

impl Period {
    /// A period of so many seconds, if samples can have it.
    pub fn from_seconds(seconds: f64) -> Option<Self> {
        (LEAST..=MOST)
            .contains(&seconds)
            .then_some(Self { seconds })
    }

    /// It in s.
    pub fn seconds(self) -> f64 {
        self.seconds
    }

    /// A number in this unit, of time or of frequency.
    pub(super) fn in_unit(number: f64, unit: &str) -> Option<Self> {
        let seconds = match (parse(unit), frequency(unit)) {
            (Some((Measures::Time, factor)), _) => number * factor,
            (_, Some(factor)) => 1.0 / (number * factor),
            _ => return None,
        };
        Self::from_seconds(seconds)
    }

    /// The times of so many samples, s: the first is 0.
    pub(super) fn times(self, samples: usize) -> Vec<f64> {
        (0..samples).map(|i| i as f64 * self.seconds).collect()
    }
}

/// Factor to 1/s of a unit of frequency.
fn frequency(unit: &str) -> Option<f64> {
    match unit.trim().to_lowercase().as_str() {
        "hz" | "1/s" => Some(1.0),
        "khz" => Some(1e3),
        "mhz" => Some(1e6),
        _ => None,
    }
}

impl fmt::Display for Period {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} s", self.seconds)
    }
}

impl FromStr for Period {
    type Err = PeriodError;

    fn from_str(text: &str) -> Result<Self, PeriodError> {
        let text = text.trim();
        // The e of an exponent stands before a digit or a sign, which no unit begins with.
        let unit = text.char_indices().find(|(i, c)| {
            let exponent = matches!(c, 'e' | 'E')
                && text[i + 1..].starts_with(|n: char| n.is_ascii_digit() || n == '-' || n == '+');
            c.is_alphabetic() && !exponent || text[*i..].starts_with("1/s") && *i > 0
        });
        let (number, unit) = text.split_at(unit.map_or(text.len(), |(i, _)| i));
        let number = number.trim().replace(',', ".");
        let period = number.parse().ok().and_then(|n| Self::in_unit(n, unit));
        period.ok_or_else(|| PeriodError {
            text: shorten(text),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_period_has_a_unit_of_time_or_of_frequency() {
        for (text, seconds) in [
            ("4s", 4.0),
            ("4 s", 4.0),
            ("0.5 ms", 5e-4),
            ("2min", 120.0),
            ("100 Hz", 0.01),
            ("1kHz", 1e-3),
            ("1e-3 s", 1e-3),
            ("2,5 us", 2.5e-6),
            ("10 1/s", 0.1),
        ] {
            let period: Period = text.parse().unwrap_or_else(|e| panic!("{text}: {e}"));
            assert!((period.seconds() / seconds - 1.0).abs() < 1e-12, "{text}");
        }
        for text in [
            "", "4", "s", "-4 s", "0 s", "inf s", "nan s", "4 rad", "4 s s", "1e300 s", "é", "4é",
        ] {
            let error = text.parse::<Period>().expect_err(text).to_string();
            assert!(
                error.contains("such as 4s, 0.5ms, 2min or 100Hz"),
                "{error}"
            );
        }
    }
}
