//! A fitted parameter, and how well it is known.

use serde::{Deserialize, Serialize};

use crate::effect::EffectId;

/// How well a parameter is known.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Status {
    /// Not at all: fitted to the data.
    #[default]
    Free,
    /// About: deviations count against this standard deviation, in the unit of the parameter (above 0).
    Prior(f64),
    /// Exactly: never changed.
    Fixed,
}

impl Status {
    /// Whether it is [`Status::Free`].
    pub fn is_free(&self) -> bool {
        *self == Self::Free
    }
}

/// A fitted parameter.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Parameter {
    /// The effect that it belongs to; `None` for the baseline model.
    pub effect: Option<EffectId>,
    /// Symbol, such as `J1`.
    pub name: String,
    /// Plain words, such as `motor inertia`.
    pub label: String,
    /// Fitted value in `unit`.
    pub value: f64,
    /// Standard error in `unit`, widened for autocorrelated residuals.
    pub std_error: f64,
    /// SI unit.
    pub unit: String,
    /// Whether it was fitted freely, with a prior, or not at all.
    #[serde(default, skip_serializing_if = "Status::is_free")]
    pub status: Status,
}
