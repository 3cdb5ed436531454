//! What is set of a measured test.

use hysteron_core::tuning::measured::{Readings, Wishes};
use serde::{Deserialize, Serialize};

/// Where the test comes from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum From {
    /// The page simulates it.
    #[default]
    Simulation,
    /// A record or a log.
    Record,
    /// What was read off it.
    Numbers,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Settings {
    pub(super) from: From,
    /// The record or log that is open.
    pub(super) file: Option<String>,
    pub(super) readings: Readings,
    pub(super) wishes: Wishes,
    /// Rule and controller in view.
    pub(super) chosen: Option<String>,
}
