//! What is known of parameters before the fit: fixed ones, and priors that count like further data.

use std::sync::Arc;

use super::fit::Fit;
use super::score::score;
use super::select::{helps, is_plain_noise};
use super::session::{Scored, Session};
use super::structure::Structure;
use crate::diagnosis::{Contradiction, CriticismError, Overruled};
use crate::effect::EffectId;
use crate::measurement::Measurement;
use crate::user_model::{Known, Status, UserModel};

/// Standard errors by which the data must miss a known value to contradict it.
const CLEAR: f64 = 3.0;

/// Iterations of a fit whose known values are released.
const RELEASED_ITERATIONS: usize = 8;

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
    fn released(&self) -> Self {
        Self {
            entries: Arc::from([]),
            present: Arc::clone(&self.present),
            felt_gap: self.felt_gap,
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

/// Tolerances by which the data must have moved a known value to overrule it.
const OVERRULED: f64 = 3.0;

/// Values with a tolerance that the data have moved by more than three of it.
pub(super) fn overruled(session: &Session, model: &Scored) -> Vec<Overruled> {
    let known = model.fit.structure.known();
    let found = session.parameters(model);
    let pairs = known.into_iter().zip(found);
    pairs
        .filter_map(|(known, found)| {
            let known = known?;
            let Status::Prior(tolerance) = known.status else {
                return None;
            };
            ((found.value - known.value).abs() > OVERRULED * tolerance).then_some(Overruled {
                effect: found.effect,
                name: found.name,
                given: known.value,
                tolerance,
                found: found.value,
                unit: found.unit,
            })
        })
        .collect()
}

/// Known values that the data contradict: with all of them released the error falls beyond chance, further
/// than by any effect (which would leave `best`), and these end elsewhere; or nothing but noise is left since the data were
/// too strong for them.
pub(super) fn contradictions(session: &Session, model: &Scored, best: f64) -> Vec<Contradiction> {
    let held = &model.fit.structure;
    if held.knowledge.is_free() {
        return Vec::new();
    }
    let mut structure = held.clone();
    structure.knowledge = held.knowledge.released();
    let (values, starts) = (model.fit.values.clone(), model.fit.starts.clone());
    let mut fit = Fit::new(&session.data, structure, values, starts, &session.scales);
    for _ in 0..RELEASED_ITERATIONS {
        fit.iterate(&session.data, &session.scales);
    }
    fit.polish_starts(&session.data, &session.scales);
    let released = Scored {
        score: score(&session.data, &fit),
        fit,
    };
    let overruled = is_plain_noise(&model.score);
    let released = if helps(&model.score, &released.score) && released.score.error <= best {
        &released
    } else if overruled {
        model
    } else {
        return Vec::new();
    };
    let wanted = session.parameters(released);
    held.known()
        .into_iter()
        .zip(wanted)
        .filter_map(|(known, wanted)| {
            let known = known?;
            let tolerance = match known.status {
                Status::Free => return None,
                Status::Prior(tolerance) => tolerance,
                Status::Fixed => 0.0,
            };
            let clear = CLEAR * libm::hypot(wanted.std_error, tolerance);
            ((wanted.value - known.value).abs() > clear).then_some(Contradiction {
                effect: wanted.effect,
                name: wanted.name,
                held: known.value,
                wanted: wanted.value,
                std_error: wanted.std_error,
                unit: wanted.unit,
                error: released.score.error,
            })
        })
        .collect()
}
