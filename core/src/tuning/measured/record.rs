//! Time, input and output of a test.

use serde::{Deserialize, Serialize};

use crate::measurement::Measurement;
use crate::message::{Message, says};
use crate::msg;
use crate::order::{distinct, median, range};

/// Fewest samples from which a model can be had.
const FEWEST: usize = 20;

/// Ends of a record over which an output is taken: one part of so many.
const ENDS: usize = 20;

/// Share of its range by which an output that goes somewhere differs from begin to end.
const GOES: f64 = 0.5;

/// A record of one input and one output. The input is held: `input[i]` acts from `time[i]` to `time[i + 1]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// Name shown to the user.
    pub name: String,
    /// Times, s, strictly increasing.
    pub time: Vec<f64>,
    /// Input of the plant, in `input_unit`.
    pub input: Vec<f64>,
    /// Output of the plant, in `output_unit`.
    pub output: Vec<f64>,
    /// Unit of the input; `1` for a plain number.
    pub input_unit: String,
    /// Unit of the output; `1` for a plain number.
    pub output_unit: String,
}

/// Why a record cannot be used.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, thiserror::Error)]
pub enum RecordError {
    /// Too few samples.
    TooShort(usize),
    /// Columns of different length.
    Lengths(usize, usize, usize),
    /// A value that is no number, or time that does not increase.
    Sample(usize),
    /// The output never moves.
    Still(f64),
    /// The input never moves.
    NoInput(f64),
    /// The relay never switches while the output goes somewhere.
    NeverSwitched {
        /// The input.
        input: f64,
        /// Output at the begin.
        from: f64,
        /// Output at the end.
        to: f64,
    },
    /// A number read off a test that cannot be.
    Reading {
        /// Its name.
        name: Box<Message>,
        /// What it was.
        value: f64,
        /// What it may be.
        range: Box<Message>,
    },
}

impl RecordError {
    /// In words.
    pub fn message(&self) -> Message {
        match self {
            Self::TooShort(given) => msg!(
                "{} samples are too few: a relay test needs {} or more",
                given,
                FEWEST
            ),
            Self::Lengths(first, second, third) => msg!(
                "time, input and output have {}, {} and {} values: they must have equally many",
                first,
                second,
                third
            ),
            Self::Sample(given) => msg!(
                "sample {} is not a number, or its time is not after that of the sample before",
                given
            ),
            Self::Still(given) => msg!(
                "the output is {} from the first sample to the last: there is nothing to learn from it",
                given
            ),
            Self::NoInput(given) => msg!(
                "the input is {} from the first sample to the last: a test needs an input that changes, so also \
                 record the command to the heater or valve",
                given
            ),
            Self::NeverSwitched { input, from, to } => msg!(
                "the input is {} from the first sample to the last, while the output goes from {} to {}: the relay \
                 never switched, since {} is short of its threshold; a lower target, a stronger input or a longer \
                 test lets it switch",
                input,
                from,
                to,
                to
            ),
            Self::Reading { name, value, range } => {
                msg!("{} is {}: it must be {}", &**name, value, &**range)
            }
        }
    }
}

says!(RecordError);

impl Record {
    /// Input and first output of a measurement.
    pub fn of(measurement: &Measurement) -> Self {
        let (output, unit) = measurement
            .outputs
            .first()
            .map_or((Vec::new(), "1".to_owned()), |c| {
                (c.values.clone(), c.unit.clone())
            });
        Self {
            name: measurement.name.clone(),
            time: measurement.time.clone(),
            input: measurement.input.values.clone(),
            output,
            input_unit: measurement.input.unit.clone(),
            output_unit: unit,
        }
    }

    /// Checks it.
    ///
    /// # Errors
    /// The first thing that makes it useless.
    pub fn validate(&self) -> Result<(), RecordError> {
        let lengths = [self.time.len(), self.input.len(), self.output.len()];
        if lengths[0] != lengths[1] || lengths[0] != lengths[2] {
            return Err(RecordError::Lengths(lengths[0], lengths[1], lengths[2]));
        }
        let wrong = (0..lengths[0]).find(|&i| {
            let late = i == 0 || self.time[i] > self.time[i - 1];
            !(late
                && self.time[i].is_finite()
                && self.input[i].is_finite()
                && self.output[i].is_finite())
        });
        if let Some(i) = wrong {
            return Err(RecordError::Sample(i));
        }
        if lengths[0] < FEWEST {
            return Err(RecordError::TooShort(lengths[0]));
        }
        if self.output.iter().all(|y| *y == self.output[0]) {
            return Err(RecordError::Still(self.output[0]));
        }
        if self.input.iter().all(|u| *u == self.input[0]) {
            return Err(self.without_switch());
        }
        Ok(())
    }

    /// Why an input that stays where it is tells nothing.
    fn without_switch(&self) -> RecordError {
        let n = self.output.len();
        let part = (n / ENDS).max(1);
        let of = |part: &[f64]| median(&mut part.to_vec());
        let (from, to) = (of(&self.output[..part]), of(&self.output[n - part..]));
        let (low, high) = range(&self.output);
        if (to - from).abs() < GOES * (high - low) {
            return RecordError::NoInput(self.input[0]);
        }
        RecordError::NeverSwitched {
            input: self.input[0],
            from: rounded(from),
            to: rounded(to),
        }
    }

    /// Usual distance of neighbouring outputs that differ.
    pub(super) fn sensor_step(&self) -> f64 {
        median(&mut self.sensor_steps())
    }

    /// Distances of neighbouring outputs that differ: one fewer than there are values.
    pub(super) fn sensor_steps(&self) -> Vec<f64> {
        let values = distinct(self.output.clone());
        values.windows(2).map(|v| v[1] - v[0]).collect()
    }

    /// Length, s.
    pub(super) fn span(&self) -> f64 {
        match (self.time.first(), self.time.last()) {
            (Some(a), Some(b)) => b - a,
            _ => 0.0,
        }
    }

    /// Its first samples.
    pub(super) fn first(&self, count: usize) -> Self {
        let of = |values: &[f64]| values.iter().copied().take(count).collect();
        Self {
            time: of(&self.time),
            input: of(&self.input),
            output: of(&self.output),
            ..self.clone()
        }
    }

    /// Samples from a time up to another.
    pub(super) fn between(&self, from: f64, to: f64) -> std::ops::Range<usize> {
        let at = |t: f64| self.time.partition_point(|s| *s < t);
        at(from)..at(to).max(at(from))
    }

    /// Median time between samples, s.
    pub(super) fn sampling(&self) -> f64 {
        let mut steps: Vec<f64> = self.time.windows(2).map(|t| t[1] - t[0]).collect();
        median(&mut steps)
    }
}

/// To four significant digits, as it is said.
fn rounded(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}
