//! A model driven by the measured input, for drawing.

use serde::{Deserialize, Serialize};

use crate::measurement::Quantity;

/// One output, measured and replayed, for drawing.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ReplayChannel {
    /// What it is.
    pub quantity: Quantity,
    /// Name in the file.
    pub name: String,
    /// SI unit.
    pub unit: String,
    /// Standard deviation of the measurement noise, in `unit`.
    pub noise: f64,
    /// Model output at every sample, in `unit`; as long as the measurement.
    #[serde(with = "crate::packed")]
    pub modelled: Vec<f64>,
}

/// The model driven by the measured input, restarted from estimated states in windows.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Replay {
    /// One entry per measured output, in the same order.
    pub channels: Vec<ReplayChannel>,
    /// First sample of each window.
    pub window_starts: Vec<usize>,
}
