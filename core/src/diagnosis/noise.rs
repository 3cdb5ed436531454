//! The noise of the measured channels: the unit of the errors.

use crate::msg;
use serde::{Deserialize, Serialize};

use crate::measurement::Quantity;
use crate::message::Message;
use crate::uncertain::brief_quantity;

/// The noise of a measured channel, in its own unit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ChannelNoise {
    /// Name of the channel in the file.
    pub channel: String,
    /// What it measures.
    pub quantity: Quantity,
    /// Standard deviation of the noise in `unit`.
    pub value: f64,
    /// SI unit.
    pub unit: String,
    /// Step of the lattice on which its values lie, in `unit`; absent where none is seen.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub step: Option<f64>,
}

/// Share of the noise from which on a step is worth a word.
const COARSE: f64 = 0.3;

impl ChannelNoise {
    /// `velocity noise 3.7 mrad/s, steps of 13.2 mrad/s`: steps far below the noise are not said.
    pub fn words(&self) -> Message {
        use Quantity::{Input, LoadPosition, LoadVelocity, Output, Position, Velocity};
        let size = |value: f64| brief_quantity(value, &self.unit);
        let noise = size(self.value);
        let step = self.step.filter(|step| *step > COARSE * self.value);
        match (self.quantity, step.map(size)) {
            (Input, None) => msg!("input noise {}", noise),
            (Input, Some(step)) => msg!("input noise {}, steps of {}", noise, step),
            (Position | LoadPosition, None) => msg!("position noise {}", noise),
            (Position | LoadPosition, Some(step)) => {
                msg!("position noise {}, steps of {}", noise, step)
            }
            (Velocity | LoadVelocity, None) => msg!("velocity noise {}", noise),
            (Velocity | LoadVelocity, Some(step)) => {
                msg!("velocity noise {}, steps of {}", noise, step)
            }
            (Output, None) => msg!("output noise {}", noise),
            (Output, Some(step)) => msg!("output noise {}, steps of {}", noise, step),
        }
    }
}
