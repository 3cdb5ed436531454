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
//!
//! [[candidates]]                                   # of one's own, tried like those of the library
//! id = "bump"
//! formula = "-a*exp(-((x-b)/c)^2)"                 # x, v, u, t of a drive; y, u, t of a process
//! ```
//!
//! An effect with a `formula` may stand under `[[effects]]` as well. What is not mentioned is free. `status` ("fixed",
//! "prior", "free") says it outright; `unit`, if it is there, must be the one that the parameter has in the
//! measurement.

mod form;
mod read;
mod write;

use serde::{Deserialize, Serialize};

use crate::diagnosis::Step;
use crate::effect::{EffectId, Formula, VISCOUS_FRICTION};
use crate::measurement::Kind;
use crate::message::Message;
use crate::msg;

pub use crate::diagnosis::Status;
pub use form::{Form, forms};
pub use read::ModelFileError;

/// Longest file that is read, bytes.
pub const MAX_BYTES: usize = 100_000;

/// Most effects in a file.
pub const MAX_PRESENT: usize = 20;

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
    /// Which; a name of the user's own where there is a formula.
    pub id: EffectId,
    /// The force, if the effect is the user's own.
    pub formula: Option<String>,
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
    /// Effects of the user's own that are tried like those of the library.
    pub candidates: Vec<Present>,
}

impl UserModel {
    /// The baseline of which nothing is known.
    pub fn blank(kind: Kind) -> Self {
        Self {
            kind,
            parameters: Vec::new(),
            effects: Vec::new(),
            candidates: Vec::new(),
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
                    formula: given.and_then(|g| g.formula(*id)).map(str::to_owned),
                    parameters: known(Some(*id)),
                })
                .collect(),
            candidates: given.map_or_else(Vec::new, |g| {
                let tried = g.candidates.iter();
                tried
                    .filter(|c| !step.effects.contains(&c.id))
                    .cloned()
                    .collect()
            }),
        }
    }

    /// What is known of the parameters of an effect, or of the baseline (`None`).
    pub fn known(&self, effect: Option<EffectId>) -> &[Known] {
        match effect {
            None => &self.parameters,
            Some(id) => self.find(id).map_or(&[], |e| e.parameters.as_slice()),
        }
    }

    /// An effect or a candidate.
    pub fn find(&self, id: EffectId) -> Option<&Present> {
        let all = self.effects.iter().chain(&self.candidates);
        all.into_iter().find(|e| e.id == id)
    }

    /// The formula of an effect of the user's own.
    pub fn formula(&self, id: EffectId) -> Option<&str> {
        self.find(id)?.formula.as_deref()
    }

    /// Every effect of the user's own.
    pub fn formulas(&self) -> impl Iterator<Item = Formula> {
        let all = self.effects.iter().chain(&self.candidates);
        all.filter_map(|e| {
            Some(Formula {
                name: e.id.as_str().to_owned(),
                text: e.formula.clone()?,
            })
        })
    }

    /// Adds a candidate written as `name: formula` or `name: formula; a = 0.05, b = 1`, where the values are
    /// those that a fit starts from.
    ///
    /// # Errors
    /// One sentence that says what is wrong and what would be right.
    pub fn add_candidate(&mut self, text: &str) -> Result<(), Message> {
        let (name, rest) = text
            .split_once(':')
            .ok_or("write it as \"name: formula\", such as \"bump: -a*exp(-((x-b)/c)^2)\"")?;
        let (formula, values) = rest.split_once(';').unwrap_or((rest, ""));
        let (name, formula) = (name.trim(), formula.trim());
        // The library may come to have the name that a user has long had for a formula.
        let name = match EffectId::parse(name) {
            Some(taken) => format!("own_{taken}"),
            None => name.to_owned(),
        };
        let id = EffectId::own(&name).ok_or_else(|| {
            msg!(
                "'{}' is not a valid name for an effect: {}",
                Message::name(&name),
                EffectId::OWN_NAMES
            )
        })?;
        if self.find(id).is_some() {
            return Err(msg!(
                "{} occurs twice: give it another name",
                Message::name(name)
            ));
        }
        if self.candidates.len() + self.effects.len() >= MAX_PRESENT {
            return Err(msg!("too many effects: at most {}", MAX_PRESENT));
        }
        let symbols = Formula {
            name: name.clone(),
            text: formula.to_owned(),
        }
        .parameters(self.kind)
        .map_err(|e| msg!("{}, {}", Message::name(&name), &e))?;
        let mut parameters = Vec::new();
        for part in values.split(',').filter(|p| !p.trim().is_empty()) {
            let value = part.split_once('=').and_then(|(symbol, value)| {
                let symbol = symbols.iter().find(|s| *s == symbol.trim())?;
                Some((
                    symbol,
                    value.trim().parse::<f64>().ok().filter(|v| v.is_finite())?,
                ))
            });
            let (symbol, value) = value.ok_or_else(|| {
                msg!(
                    "'{}' is not a starting value: write, for example, {} = 0.05, with a comma before the next one",
                    Message::name(part.trim()),
                    Message::name(symbols.first().map_or("a", String::as_str))
                )
            })?;
            parameters.push(Known {
                symbol: symbol.clone(),
                value,
                status: Status::Free,
                std_error: None,
                unit: None,
            });
        }
        self.candidates.push(Present {
            id,
            formula: Some(formula.to_owned()),
            parameters,
        });
        Ok(())
    }

    /// Ids of the effects in the model.
    pub fn present(&self) -> Vec<EffectId> {
        self.effects.iter().map(|e| e.id).collect()
    }
}
