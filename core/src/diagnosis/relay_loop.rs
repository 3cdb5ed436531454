//! What a model does in the relay loop that was measured.

use serde::{Deserialize, Serialize};

/// By how much the cycle of a model that runs free in the measured relay loop is off, as shares of what was measured.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct LoopError {
    /// Of the period: 0.02 where it is 2 % too long; `None` where the model does not cycle.
    pub period: Option<f64>,
    /// Of the amplitude of what the relay sees; `None` where the model does not cycle.
    pub amplitude: Option<f64>,
}
