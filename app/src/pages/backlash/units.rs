//! The unit in which the page speaks of angles.

/// Milliradians in a radian: the page speaks of them.
pub const MILLI: f64 = 1e3;
