//! How numbers and names stand on the map and beside it.

use hysteron_core::message::Message;
use hysteron_core::msg;

/// Four digits that mean something.
pub fn number(value: f64) -> String {
    let size = value.abs();
    if size >= 1000.0 {
        format!("{value:.0}")
    } else if size >= 100.0 {
        format!("{value:.1}")
    } else if size >= 10.0 {
        format!("{value:.2}")
    } else {
        format!("{value:.3}")
    }
}

/// A number with its unit.
pub fn with_unit(value: f64, unit: &str) -> String {
    if unit.is_empty() {
        number(value)
    } else {
        format!("{} {unit}", number(value))
    }
}

/// Name with its unit, for axes.
pub fn axis_title(label: &'static str, unit: &'static str) -> Message {
    if unit.is_empty() {
        label.into()
    } else {
        msg!("{} [{}]", label, unit.to_owned())
    }
}

/// A verdict for the value of [`Quantity::Stability`](hysteron_core::maps::Quantity::Stability).
pub fn stability(value: f64) -> &'static str {
    if value > 0.5 { "stable" } else { "unstable" }
}
