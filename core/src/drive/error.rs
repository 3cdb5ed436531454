//! What is wrong with a drive or a run.

use crate::message::{Message, says};
use crate::msg;
use crate::relay::RelayError;

/// A drive that cannot be, or a run that cannot be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DriveError {
    /// A value out of range.
    Value {
        /// Which.
        name: &'static str,
        /// Its value.
        value: f64,
        /// What would be right.
        range: &'static str,
    },
    /// The relay.
    Relay(#[from] RelayError),
}

impl DriveError {
    /// In words.
    pub fn message(&self) -> Message {
        match self {
            Self::Value { name, value, range } => {
                msg!("{} is {}: it must be {}", name, value, range)
            }
            Self::Relay(error) => error.message(),
        }
    }
}

says!(DriveError);

pub(crate) fn check(
    name: &'static str,
    value: f64,
    fits: bool,
    range: &'static str,
) -> Result<(), DriveError> {
    if value.is_finite() && fits {
        Ok(())
    } else {
        Err(DriveError::Value { name, value, range })
    }
}
