//! The relay on the motor's velocity.

use serde::{Deserialize, Serialize};

use super::error::{DriveError, check};
use crate::relay::Relay;

/// A relay with hysteresis `eps` on the motor's velocity, `u = -k h(v1)`: the motor swings to and fro
/// by itself, and with an asymmetry it drifts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct VelocityRelay {
    /// Gain in N m (or N), hysteresis in rad/s (or m/s), asymmetry, bias, delay.
    pub relay: Relay,
    /// The asymmetry changes its sign every so many seconds, so that the drift turns round; above 0.
    pub flip: Option<f64>,
    /// Sampling time of the controller in which the relay runs, s; above 0. It then sees the velocity
    /// at these instants only, and acts half of it later in the mean. `None`: it sees it all the time.
    pub sampling: Option<f64>,
}

/// What drives the motor.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Command {
    /// A constant torque, N m (or N).
    Torque(f64),
    /// A relay on the velocity.
    Relay(VelocityRelay),
}

impl VelocityRelay {
    /// Output for `h = +1` (`high`) or -1, with the asymmetry `turned` round or not.
    pub fn output(&self, high: bool, turned: bool) -> f64 {
        let sign = if turned { -1.0 } else { 1.0 };
        Relay {
            asymmetry: sign * self.relay.asymmetry,
            ..self.relay
        }
        .output(high)
    }

    /// Delay from a crossing to the action in the mean, s: its own and half of the sampling time.
    pub fn mean_delay(&self) -> f64 {
        self.relay.delay + 0.5 * self.sampling.unwrap_or(0.0)
    }

    /// Checks every value.
    ///
    /// # Errors
    /// The first one out of its range.
    pub fn validate(&self) -> Result<(), DriveError> {
        self.relay.validate()?;
        if let Some(flip) = self.flip {
            check("flip", flip, flip > 0.0, "above 0 s")?;
        }
        if let Some(sampling) = self.sampling {
            check("sampling", sampling, sampling > 0.0, "above 0 s")?;
        }
        Ok(())
    }
}

impl Command {
    pub(super) fn validate(&self) -> Result<(), DriveError> {
        match self {
            Self::Torque(u) => check("torque", *u, true, "a number"),
            Self::Relay(relay) => relay.validate(),
        }
    }
}
