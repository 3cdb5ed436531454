//! What is known of parameters before the fit: fixed ones, and priors that count like further data.

use std::sync::Arc;

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
pub(super) const HALF_GAP: (Option<EffectId>, &str) = (Some(EffectId::new("backlash")), "beta");

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

    /// Half gap that the contacts in the record tell, and its tolerance.
    pub fn felt_gap(&self) -> Option<(f64, f64)> {
        self.felt_gap
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
