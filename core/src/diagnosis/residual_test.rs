//! Whether what a model leaves is white, and still follows the input.

use serde::{Deserialize, Serialize};

use crate::message::Message;

/// What a residual is compared with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ResidualTestKind {
    /// With itself some samples earlier.
    Whiteness,
    /// With the input some samples earlier.
    InputCorrelation,
}

/// A test of the residual of one output.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ResidualTest {
    /// What it was compared with.
    pub kind: ResidualTestKind,
    /// Index of the output in the measurement.
    pub output: usize,
    /// The correlation, -1 to 1, that is largest against its bound.
    pub correlation: f64,
    /// Lag at which it is, s.
    pub lag: f64,
    /// What chance alone leaves in 99 of 100 cases.
    pub bound: f64,
    /// The correlation is within its bound.
    pub passed: bool,
    /// The same as a sentence with numbers.
    pub text: Message,
}
