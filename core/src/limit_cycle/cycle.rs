//! A limit cycle in three numbers.

use serde::{Deserialize, Serialize};

/// A limit cycle.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Cycle {
    /// Period, s.
    pub period: f64,
    /// Half of peak to peak, in the unit of the output (the paper's `a`).
    pub amplitude: f64,
    /// Whether small disturbances die out; `None` where it is not known.
    pub stable: Option<bool>,
}
