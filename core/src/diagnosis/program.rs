//! What may drive an experiment: relays, levels in turn, sums of sines.

use serde::{Deserialize, Serialize};

use crate::message::Message;
use crate::msg;
use crate::uncertain::{Scale, brief_quantity, in_unit, significant};

/// One sine of a sum, `amplitude sin(2 pi frequency t + phase)`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sine {
    /// In the unit of the input.
    pub amplitude: f64,
    /// Hz.
    pub frequency: f64,
    /// rad.
    pub phase: f64,
}

/// An input, as a controller would make it sample by sample.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "type", rename_all = "snake_case")]
pub enum Program {
    /// A relay on the velocity of a drive or the output of a process, `u = -k h`.
    Relay {
        /// Gains k in the unit of the input, in turn; at least one, each above 0.
        gains: Vec<f64>,
        /// How long each gain holds, s; without meaning where there is one.
        hold: f64,
        /// Hysteresis, in the unit of what it switches on; at least 0.
        hysteresis: f64,
        /// Asymmetry a: the levels are `k (1 + a)` and `-k (1 - a)`.
        asymmetry: f64,
    },
    /// Levels one after the other, over and over.
    Levels {
        /// In the unit of the input.
        levels: Vec<f64>,
        /// How long each holds, s.
        hold: f64,
    },
    /// A sum of sines.
    Multisine {
        /// From low to high.
        sines: Vec<Sine>,
    },
}

impl Program {
    /// In words with numbers: `a relay with gain 0.5 N m and hysteresis 0.6 rad/s`. `input` and `output` are the
    /// units.
    pub fn words(&self, input: &str, output: &str) -> Message {
        let with = brief_quantity;
        match self {
            Self::Relay {
                gains,
                hold,
                hysteresis,
                asymmetry,
            } => {
                let hysteresis = with(*hysteresis, output);
                let relay = match gains.as_slice() {
                    [gain] => msg!("a relay with gain {}", with(*gain, input)),
                    [first, second] => {
                        let scale = Scale::of(first.abs().max(second.abs()), input);
                        let [first, second] = [first, second].map(|k| short(k / scale.factor));
                        msg!(
                            "a relay with gains {} and {} in turn, {} s each",
                            first,
                            in_unit(second, &scale.unit),
                            short(*hold)
                        )
                    }
                    _ => msg!(
                        "a relay with gains {} in turn, {} s each",
                        list(gains, input),
                        short(*hold)
                    ),
                };
                let mut parts = vec![relay];
                if *asymmetry != 0.0 {
                    parts.push(msg!("asymmetry {}", short(*asymmetry)));
                }
                parts.push(msg!("hysteresis {}", hysteresis));
                Message::list(", ", parts)
            }
            Self::Levels { levels, hold } => {
                let size = levels.first().map_or(0.0, |u| u.abs());
                let hold = short(*hold);
                if levels.iter().all(|u| u.abs() == size) {
                    let levels = list(&[size, -size], input);
                    msg!(
                        "two levels in a random order, each step {} s long: {}",
                        hold,
                        levels
                    )
                } else {
                    msg!(
                        "a staircase, each step {} s long: {}",
                        hold,
                        list(levels, input)
                    )
                }
            }
            Self::Multisine { sines } => {
                let ends = sines.first().zip(sines.last());
                let (low, high) = ends.map_or((0.0, 0.0), |(a, b)| (a.frequency, b.frequency));
                let size = sines.first().map_or(0.0, |s| s.amplitude);
                msg!(
                    "a sum of {} sines from {} to {} Hz, {} each",
                    sines.len(),
                    short(low),
                    short(high),
                    with(size, input)
                )
            }
        }
    }
}

/// Values with their unit at the end.
fn list(values: &[f64], unit: &str) -> String {
    let scale = Scale::of(values.iter().fold(0.0, |most, v| v.abs().max(most)), unit);
    let numbers = values.iter().map(|v| short(v / scale.factor));
    in_unit(numbers.collect::<Vec<_>>().join(", "), &scale.unit)
}

/// A number with three digits that count.
pub(crate) fn short(value: f64) -> String {
    significant(value, 3)
}
