//! What is wrong with a drive or a run.

use crate::relay::RelayError;

/// A drive that cannot be, or a run that cannot be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DriveError {
    /// A value out of range.
    #[error("{name} is {value}: it must be {range}")]
    Value {
        /// Which.
        name: &'static str,
        /// Its value.
        value: f64,
        /// What would be right.
        range: &'static str,
    },
    /// The relay.
    #[error(transparent)]
    Relay(#[from] RelayError),
}

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
