//! Causes of a test that stalls or misleads, and what they are looked for in.

use serde::{Deserialize, Serialize};

use super::cycle::Cycle;
use super::fit::Fit;
use super::number::number;
use super::record::Record;
use crate::message::Message;

/// What went wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TroubleKind {
    /// The output levels off before the relay would switch.
    TargetUnreachable,
    /// The input is up almost always.
    HeaterTooWeak,
    /// Noise switches the relay.
    NoiseLargerThanHysteresis,
    /// Up and down take different times.
    Asymmetric,
    /// The sensor's steps are coarse.
    Quantised,
    /// The cycle wanders.
    Drift,
    /// A least time on or off holds the relay.
    MinimumTime,
    /// Too few periods.
    WindowTooShort,
    /// The input is not a relay's.
    NoRelay,
    /// A controller makes the input of the output.
    Controller,
}

/// One cause.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Trouble {
    /// Which.
    pub kind: TroubleKind,
    /// Whether the test told nothing for this reason; else it is a caution.
    pub fatal: bool,
    /// The number that shows it.
    pub number: f64,
    /// A sentence with it.
    pub text: Message,
}

/// What the causes are looked for in.
pub(super) struct Evidence<'a> {
    pub record: &'a Record,
    pub cycle: Option<&'a Cycle>,
    /// What would be a cycle if noise did not make it.
    pub chatter: Option<&'a Cycle>,
    /// What is to be said of a controller that made the input.
    pub controller: Option<Trouble>,
    pub fit: Option<&'a Fit>,
    /// Noise of the output.
    pub noise: f64,
    /// Set point, if it is known.
    pub target: Option<f64>,
    /// Half the distance of the thresholds, if it is known.
    pub hysteresis: Option<f64>,
    /// Whether the ultimate gain or the gain of a model is known well enough to be told.
    pub told: bool,
}

/// A cause.
pub(super) fn trouble(kind: TroubleKind, fatal: bool, number: f64, text: Message) -> Trouble {
    Trouble {
        kind,
        fatal,
        number,
        text,
    }
}

/// A value with its unit.
pub(super) fn of_unit(value: f64, unit: &str) -> String {
    match unit {
        "1" => number(value),
        unit => format!("{} {unit}", number(value)),
    }
}
