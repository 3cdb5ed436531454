//! What can become of a loop.

use serde::{Deserialize, Serialize};

/// What becomes of a loop.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    /// It settles into a limit cycle.
    LimitCycle,
    /// The relay no longer switches and the output comes to rest.
    Rest,
    /// The relay holds the output on its threshold (Filippov 1988).
    Sliding,
    /// The output grows without bound.
    Unbounded,
    /// It oscillates in one of a continuum of cycles: which one depends on the start.
    Continuum,
    /// It oscillates in a pattern of several cycles, or in none that repeats.
    LongPattern,
    /// It oscillates in measurement noise: no two cycles are alike.
    NoisyLimitCycle,
    /// The relay switches many times where the output passes once.
    Chatter,
}
