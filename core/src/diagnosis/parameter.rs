//! A fitted parameter, and how well it is known.

use serde::ser::SerializeMap as _;
use serde::{Deserialize, Serialize, Serializer};

use crate::effect::EffectId;
use crate::message::Message;
use crate::uncertain::{NORMAL_95, interval, is_told};

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

/// A fitted parameter. Where it is written, `told` says whether the record tells it: [`Parameter::is_told`].
#[derive(Clone, Debug, PartialEq, Deserialize)]
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
    #[serde(default)]
    pub status: Status,
}

impl Parameter {
    /// Whether the record tells its value: the standard error is no larger than that.
    pub fn is_told(&self) -> bool {
        is_told(self.value, self.std_error)
    }

    /// Its 95 % interval as text.
    pub fn interval(&self) -> Message {
        interval(self.value, self.std_error, NORMAL_95, &self.unit)
    }
}

impl Serialize for Parameter {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let fields = 7 + usize::from(!self.status.is_free());
        let mut out = serializer.serialize_map(Some(fields))?;
        out.serialize_entry("effect", &self.effect)?;
        out.serialize_entry("name", &self.name)?;
        out.serialize_entry("label", &self.label)?;
        out.serialize_entry("value", &self.value)?;
        out.serialize_entry("std_error", &self.std_error)?;
        out.serialize_entry("unit", &self.unit)?;
        out.serialize_entry("told", &self.is_told())?;
        if !self.status.is_free() {
            out.serialize_entry("status", &self.status)?;
        }
        out.end()
    }
}
