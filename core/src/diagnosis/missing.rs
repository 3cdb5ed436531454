//! What is missing where no effect explains it.

use serde::{Deserialize, Serialize};

use crate::effect::StepPart;
use crate::message::Message;

/// An estimate without a model.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MissingPart {
    /// `force`, `input` or `output`.
    pub what: String,
    /// Its unit.
    pub unit: String,
    /// What it may depend on: `velocity`, `position`, `time`, `input` or `output`.
    pub axis: String,
    /// Unit of the axis.
    pub axis_unit: String,
    /// Along the axis, from low to high.
    pub parts: Vec<StepPart>,
    /// Share of the squared error left that it would explain, 0 to 1.
    pub explained: f64,
    /// In a sentence with numbers.
    pub text: Message,
}
