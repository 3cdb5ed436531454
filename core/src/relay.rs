//! What does the relay do? Equation (2): gain `k`, hysteresis `eps`, asymmetry, bias and delay.

use serde::{Deserialize, Serialize};

use crate::message::{Message, says};
use crate::msg;

/// A relay with hysteresis in negative feedback, `u = -k h(y)`.
///
/// `h` becomes +1 when `y` rises through `+eps` and -1 when it falls through `-eps`. With asymmetry
/// `a` the output is `k (1 + a)` while `h = -1` and `-k (1 - a)` while `h = +1`; it acts `delay`
/// seconds after the switch. A `bias` is added to the output in either state. Asymmetry and bias are the
/// same thing in different units, `u = -k h + k a + bias`: an asymmetry `a` scales with the gain, a bias
/// (a valve that does not quite close, a constant load at the plant's input) does not.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Relay {
    /// Gain `k`, in the unit of the input; above 0.
    pub gain: f64,
    /// Hysteresis `eps`, in the unit of the output; at least 0.
    pub hysteresis: f64,
    /// Asymmetry `a`, -0.99 to 0.99.
    pub asymmetry: f64,
    /// Added to the output, in the unit of the input.
    pub bias: f64,
    /// Delay, s; at least 0.
    pub delay: f64,
}

impl Default for Relay {
    fn default() -> Self {
        Self {
            gain: 1.0,
            hysteresis: 0.1,
            asymmetry: 0.0,
            bias: 0.0,
            delay: 0.0,
        }
    }
}

/// Why a relay cannot be.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub struct RelayError {
    pub(crate) name: &'static str,
    pub(crate) value: f64,
    pub(crate) range: &'static str,
}

impl RelayError {
    /// In words.
    pub fn message(&self) -> Message {
        msg!(
            "relay {} is {}: it must be {}",
            &self.name,
            &self.value,
            &self.range
        )
    }
}

says!(RelayError);

impl Relay {
    /// Checks every field.
    pub fn validate(&self) -> Result<(), RelayError> {
        let check = |name, value: f64, fits: bool, range| {
            if value.is_finite() && fits {
                Ok(())
            } else {
                Err(RelayError { name, value, range })
            }
        };
        check("gain", self.gain, self.gain > 0.0, "above 0")?;
        check(
            "hysteresis",
            self.hysteresis,
            self.hysteresis >= 0.0,
            "0 or more",
        )?;
        check(
            "asymmetry",
            self.asymmetry,
            self.asymmetry.abs() <= 0.99,
            "between -0.99 and 0.99",
        )?;
        check("bias", self.bias, true, "a number")?;
        check("delay", self.delay, self.delay >= 0.0, "0 s or more")
    }

    /// Output for `h = +1` (`high`) or `h = -1`.
    pub fn output(&self, high: bool) -> f64 {
        let level = if high {
            -self.gain * (1.0 - self.asymmetry)
        } else {
            self.gain * (1.0 + self.asymmetry)
        };
        level + self.bias
    }

    /// Mean of its two outputs, `k a + bias`.
    pub fn mean_output(&self) -> f64 {
        self.gain * self.asymmetry + self.bias
    }

    /// Whether both outputs have the same size.
    pub fn is_symmetric(&self) -> bool {
        self.mean_output() == 0.0
    }

    /// Real and imaginary part of `-1/N(a)`, equation (6), for the amplitude `a >= eps` of the output:
    /// `-pi/(4k) (sqrt(a^2 - eps^2) + j eps)`.
    pub fn inverse_describing_function(&self, amplitude: f64) -> [f64; 2] {
        let scale = -std::f64::consts::PI / (4.0 * self.gain);
        let eps = self.hysteresis;
        [
            scale * (amplitude * amplitude - eps * eps).max(0.0).sqrt(),
            scale * eps,
        ]
    }
}
