//! One model: its parameters, where it fails, what could be added.

use serde::{Deserialize, Serialize};

use super::error::CriticismError;
use super::parameter::Parameter;
use super::relay_loop::LoopError;
use super::residual_test::ResidualTest;
use crate::effect::{EffectId, name_of};
use crate::message::Message;
use crate::msg;

/// A region in which the error concentrates.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Finding {
    /// `time`, `relay_phase`, `velocity`, `position`, `time_since_reversal`, `frequency`, ...
    pub axis: String,
    /// Lower end of the region, in the unit of the axis.
    pub from: f64,
    /// Upper end of the region, in the unit of the axis.
    pub to: f64,
    /// Share of the squared error in the region, 0 to 1.
    pub share_of_error: f64,
    /// Share of the samples in the region, or of the frequencies in a band, 0 to 1.
    pub share_of_samples: f64,
    /// The finding as a sentence with numbers.
    pub text: Message,
    /// Time spans (s) that lie in the region, merged and limited in number, for shading a plot.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub spans: Vec<(f64, f64)>,
}

/// An effect that was tried on top of the present model.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Candidate {
    /// The effect or effects added together.
    pub effects: Vec<EffectId>,
    /// Held-back error after the refit, in noise units.
    pub error: f64,
    /// Change of the Bayesian information criterion against the present model; negative is better.
    pub delta_bic: f64,
    /// Whether held-back data say that it helps, beyond chance over all candidates tried.
    pub significant: bool,
    /// Whether it lowers the error of both parts of the record much, though chance is not ruled out.
    #[serde(default)]
    pub promising: bool,
    /// The parameters of the added effect after the refit.
    pub parameters: Vec<Parameter>,
    /// Other candidates that leave the same error within noise.
    pub equivalent_to: Vec<EffectId>,
}

impl Candidate {
    /// Whether it helps, in words.
    pub fn standing(&self) -> &'static str {
        if self.significant {
            "helps"
        } else if self.promising {
            "perhaps: chance is not ruled out"
        } else {
            "too little to be added"
        }
    }
}

/// One model in the sequence from the baseline to the last one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Step {
    /// Effects in the model, in the order in which they were added.
    pub effects: Vec<EffectId>,
    /// Root mean square of the held-back residuals, each channel in units of its own noise.
    pub error: f64,
    /// The same on the data used for the fit.
    pub error_fit: f64,
    /// Share of the motion that the model misses on held-back data, noise included: root mean square of the residuals
    /// over that of the motion.
    #[serde(default)]
    pub left: f64,
    /// How far its cycle in the relay loop of the record is off; `None` where the record is no relay loop.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub relay_loop: Option<LoopError>,
    /// Every parameter of the model.
    pub parameters: Vec<Parameter>,
    /// Where it fails, strongest first.
    #[serde(rename = "where")]
    pub findings: Vec<Finding>,
    /// Whether what it leaves is white and no longer follows the input.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub tests: Vec<ResidualTest>,
    /// What could be added, best first.
    pub candidates: Vec<Candidate>,
}

impl Step {
    /// Itself, if there is an error that can be said.
    ///
    /// # Errors
    /// [`CriticismError::NotFinite`]: what was calculated with is too large or too small for an `f64`.
    pub fn checked(&self) -> Result<&Self, CriticismError> {
        if self.error.is_finite() && self.error_fit.is_finite() {
            Ok(self)
        } else {
            Err(CriticismError::NotFinite)
        }
    }

    /// What was added to and taken from the model `before`, such as `+ Coulomb friction`; nothing where it was fitted
    /// anew.
    pub fn changes_from(&self, before: &Self) -> Message {
        let only_in = |a: &Self, b: &Self| {
            let of_a = a.effects.iter().filter(|e| !b.effects.contains(e));
            of_a.map(|e| name_of(*e)).collect::<Vec<_>>()
        };
        let added = only_in(self, before);
        let added = added.into_iter().map(|name| msg!("+ {}", name));
        let taken = only_in(before, self);
        let taken = taken.into_iter().map(|name| msg!("- {}", name));
        Message::list(" ", added.chain(taken))
    }
}
