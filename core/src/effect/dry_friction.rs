//! Parameters that effects of dry friction share.

use super::spec::{Dimension, ParameterSpec, Range};

/// Friction level.
pub(super) const LEVEL: ParameterSpec = ParameterSpec {
    symbol: "c",
    label: "friction level",
    dimension: Dimension::Force,
    range: Range::NonNegative,
};

/// Displacement over which friction builds up after a reversal, too short to be seen sample by sample.
pub(super) const SHORT: ParameterSpec = ParameterSpec {
    symbol: "s",
    label: "build-up displacement",
    dimension: Dimension::Position,
    range: Range::Short,
};

/// The same where it can be seen.
pub(super) const LONG: ParameterSpec = ParameterSpec {
    range: Range::Long,
    ..SHORT
};

/// Damping ratio of the sticking contact.
pub(super) const DAMPING: ParameterSpec = ParameterSpec {
    symbol: "z",
    label: "damping ratio of the contact",
    dimension: Dimension::Ratio,
    range: Range::OfContact,
};
