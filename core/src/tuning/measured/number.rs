//! Numbers as they stand in sentences, and the scale of an input.

use crate::uncertain::significant;

/// Full scales of inputs in use: a switch, per cent, eight bits.
const FULL_SCALES: [f64; 3] = [1.0, 100.0, 255.0];

/// Four significant digits, without needless zeros.
pub(super) fn number(value: f64) -> String {
    significant(value, 4)
}

/// The least usual full scale that holds the upper level; the level itself where none does.
pub(super) fn full_scale(level: f64) -> f64 {
    // Readings may pass a full scale by round-off.
    let level = level.abs();
    FULL_SCALES
        .into_iter()
        .find(|s| level <= s * 1.001)
        .unwrap_or(level)
}
