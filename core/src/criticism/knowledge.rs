//! What is known of parameters before the fit: fixed ones, and priors that count like further data.

use std::sync::Arc;

use super::structure::Structure;
use crate::diagnosis::CriticismError;
use crate::effect::EffectId;
use crate::measurement::Measurement;
use crate::user_model::{Known, Status, UserModel};

/// What the user brought; empty where nothing is known.
#[derive(Clone, Default)]
pub(super) struct Knowledge {
    entries: Arc<[(Option<EffectId>, Known)]>,
    present: Arc<[EffectId]>,
    /// Half gap that the contacts in the record tell, and its tolerance.
    felt_gap: Option<(f64, f64)>,
}

/// The half gap of a backlash.
const HALF_GAP: (Option<EffectId>, &str) = (Some(EffectId::new("backlash")), "beta");

impl Knowledge {
    /// What `model` knows.
    pub fn of(model: &UserModel) -> Self {
        let own = |id: Option<EffectId>, known: &[Known]| -> Vec<(Option<EffectId>, Known)> {
            known.iter().map(|k| (id, k.clone())).collect()
        };
        let mut entries = own(None, &model.parameters);
        for effect in model.effects.iter().chain(&model.candidates) {
            entries.extend(own(Some(effect.id), &effect.parameters));
        }
        Self {
            entries: entries.into(),
            present: model.present().into(),
            felt_gap: None,
        }
    }

    /// The same with the half gap that contacts tell, and its tolerance.
    pub fn with_felt_gap(self, felt_gap: Option<(f64, f64)>) -> Self {
        Self { felt_gap, ..self }
    }

    /// The same where no value is held: every parameter is free.
    pub fn released(&self) -> Self {
        Self {
            entries: Arc::from([]),
            present: Arc::clone(&self.present),
            felt_gap: self.felt_gap,
        }
    }

    /// The same where a parameter of the baseline is held at a value.
    pub fn holding(&self, symbol: &str, value: f64) -> Self {
        let held = Known {
            symbol: symbol.to_owned(),
            value,
            status: Status::Fixed,
            std_error: None,
            unit: None,
        };
        let others = self.entries.iter().cloned();
        Self {
            entries: others.chain([(None, held)]).collect(),
            ..self.clone()
        }
    }

    /// Whether the user's model has this effect.
    pub fn has(&self, id: EffectId) -> bool {
        self.present.contains(&id)
    }

    /// Whether no value is held.
    pub fn is_free(&self) -> bool {
        self.entries.iter().all(|(_, k)| k.status.is_free())
    }

    /// What is known of a parameter of an effect, or of the baseline (`None`).
    pub fn find(&self, effect: Option<EffectId>, symbol: &str) -> Option<&Known> {
        self.entries
            .iter()
            .find(|(owner, k)| *owner == effect && k.symbol == symbol)
            .map(|(_, k)| k)
    }
}

/// Checks that a model suits a measurement: kind and units.
pub(super) fn check(model: &UserModel, measurement: &Measurement) -> Result<(), CriticismError> {
    if model.kind == measurement.kind {
        Ok(())
    } else {
        Err(CriticismError::WrongKind {
            model: model.kind.name(),
            measured: measurement.kind.name(),
        })
    }
}

impl Structure {
    /// What is known of each value, in order; `None` where nothing is.
    pub fn known(&self) -> Vec<Option<&Known>> {
        let symbols = self.symbols().into_iter();
        symbols
            .map(|(owner, symbol)| self.knowledge.find(owner, symbol))
            .collect()
    }

    /// Values that the fit changes.
    pub fn free_count(&self) -> usize {
        self.fixed().iter().filter(|f| !**f).count()
    }

    /// Known value and standard deviation of each prior, by index.
    pub fn priors(&self) -> Vec<(usize, f64, f64)> {
        let known = self.known();
        let mut priors: Vec<(usize, f64, f64)> = known
            .iter()
            .enumerate()
            .filter_map(|(j, k)| match k.as_ref()?.status {
                Status::Prior(tolerance) => Some((j, k.as_ref()?.value, tolerance)),
                _ => None,
            })
            .collect();
        if let Some((half_gap, tolerance)) = self.knowledge.felt_gap {
            let at = self.symbols().iter().position(|s| *s == HALF_GAP);
            let unsaid = at.filter(|j| known[*j].is_none());
            priors.extend(unsaid.map(|j| (j, half_gap, tolerance)));
        }
        priors
    }

    /// Squared deviations from the priors, in units of their tolerance.
    pub fn prior_cost(&self, values: &[f64]) -> f64 {
        self.priors()
            .iter()
            .map(|(j, value, tolerance)| ((values[*j] - value) / tolerance).powi(2))
            .sum()
    }

    /// Puts known values in the place of guessed ones among the values from `from` on.
    pub fn begin(&self, values: &mut [f64], from: usize) {
        for (value, known) in values.iter_mut().zip(self.known()).skip(from) {
            if let Some(known) = known {
                *value = known.value;
            }
        }
        self.hold(values);
    }
}
