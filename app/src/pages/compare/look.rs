//! What the plots show.

use serde::{Deserialize, Serialize};

/// What the plots show.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Look {
    /// Everything over time.
    #[default]
    Time,
    /// The residual over every axis.
    Places,
    /// What an effect would leave.
    Fingerprint,
    /// The truth of a mystery.
    Reveal,
}
