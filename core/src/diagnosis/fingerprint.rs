//! What residual an effect would leave.

use serde::{Deserialize, Serialize};

use super::profile::Profile;
use crate::effect::EffectId;

/// The change that an effect makes to the model's outputs, everything fitted anew: to first order what the model
/// without it leaves where the effect is there.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Fingerprint {
    /// The effect.
    pub effect: EffectId,
    /// How alike it is to what is left: the cosine of the angle between the two, -1 to 1.
    pub likeness: f64,
    /// First sample of the stretch in `would_leave`.
    pub from: usize,
    /// One series per output from there on, in the unit of the output.
    #[serde(with = "crate::packed::many")]
    pub would_leave: Vec<Vec<f64>>,
    /// The same over every axis but frequency, in noise units.
    pub profiles: Vec<Profile>,
}
