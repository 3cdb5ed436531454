//! What a user knows of a model beforehand, as a value and as a file (TOML).
//!
//! ```toml
//! kind = "drive"                                   # or "process"
//!
//! [parameters]                                     # of the baseline; SI units
//! J1 = 8.8e-4                                      # a number alone is fixed
//! d1 = { value = 2e-3, tolerance = 5e-4 }          # with a tolerance: known so far (a prior)
//!
//! [[effects]]                                      # already in the model
//! id = "coulomb_friction"
//! parameters.c = { value = 0.05, status = "free" } # free: the fit only starts there
//! ```
//!
//! What is not mentioned is free. `status` ("fixed", "prior", "free") says it outright; `unit`, if it is
//! there, must be the one that the parameter has in the measurement.

mod read;
mod write;

use serde::{Deserialize, Serialize};

use crate::criticism::Step;
use crate::effect::{EffectId, VISCOUS_FRICTION};
use crate::measurement::Kind;

pub use read::ModelFileError;

/// Longest file that is read, bytes.
pub const MAX_BYTES: usize = 100_000;

/// Most effects in a file.
pub const MAX_PRESENT: usize = 20;

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

/// A parameter of which something is known.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Known {
    /// Its symbol, such as `J1`.
    pub symbol: String,
    /// Its value in SI units; where it is free, the fit starts there.
    pub value: f64,
    /// How well it is known.
    pub status: Status,
    /// Its uncertainty where it is free: told to the reader, not used.
    pub std_error: Option<f64>,
    /// Its unit, if the file says it.
    pub unit: Option<String>,
}

/// An effect that is in the model.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Present {
    /// Which.
    pub id: EffectId,
    /// What is known of its parameters.
    pub parameters: Vec<Known>,
}

/// A model that a user brings.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct UserModel {
    /// Which baseline.
    pub kind: Kind,
    /// What is known of its parameters.
    pub parameters: Vec<Known>,
    /// Effects on top of it, in order.
    pub effects: Vec<Present>,
}

impl UserModel {
    /// The baseline of which nothing is known.
    pub fn blank(kind: Kind) -> Self {
        Self {
            kind,
            parameters: Vec::new(),
            effects: Vec::new(),
        }
    }

    /// The model of `step`, its parameters as fitted; what `given` knows of them stays known.
    pub fn from_step(kind: Kind, step: &Step, given: Option<&Self>) -> Self {
        let known = |effect: Option<EffectId>| -> Vec<Known> {
            let held = given.map_or(&[][..], |g| g.known(effect));
            step.parameters
                .iter()
                .filter(|p| p.effect.filter(|id| *id != VISCOUS_FRICTION) == effect)
                .map(|p| Known {
                    symbol: p.name.clone(),
                    value: p.value,
                    status: p.status,
                    std_error: (p.std_error.is_finite() && p.std_error > 0.0)
                        .then_some(p.std_error),
                    unit: Some(p.unit.clone()),
                })
                .map(|fitted| {
                    let before = held.iter().find(|k| k.symbol == fitted.symbol);
                    before
                        .filter(|k| !k.status.is_free())
                        .cloned()
                        .unwrap_or(fitted)
                })
                .collect()
        };
        Self {
            kind,
            parameters: known(None),
            effects: step
                .effects
                .iter()
                .filter(|id| **id != VISCOUS_FRICTION)
                .map(|id| Present {
                    id: *id,
                    parameters: known(Some(*id)),
                })
                .collect(),
        }
    }

    /// What is known of the parameters of an effect, or of the baseline (`None`).
    pub fn known(&self, effect: Option<EffectId>) -> &[Known] {
        match effect {
            None => &self.parameters,
            Some(id) => self
                .effects
                .iter()
                .find(|e| e.id == id)
                .map_or(&[], |e| e.parameters.as_slice()),
        }
    }

    /// Ids of the effects in the model.
    pub fn present(&self) -> Vec<EffectId> {
        self.effects.iter().map(|e| e.id).collect()
    }
}
