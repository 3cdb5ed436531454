//! What models leave unexplained, with the starting values that effects found in it: a model is met again where
//! others are tried in the place of one of its effects.

use std::collections::{BTreeMap, VecDeque};
use std::sync::{Arc, Mutex, PoisonError};

use super::fit::{Fit, same_place};
use crate::effect::{BodyStart, Effect, EffectId, Probe};

/// Models that are remembered.
const REMEMBERED: usize = 12;

/// A model that costs the same but for this share, and has the values of another one, is the same.
const SAME_COST: f64 = 0.01;

/// A probe with the starting values that were found in it.
pub(super) struct Probed {
    pub probe: Probe,
    starts: Searched<Vec<f64>>,
    with_body: Searched<BodyStart>,
}

/// What was searched for, by effect.
type Searched<T> = Mutex<BTreeMap<EffectId, Found<T>>>;

/// Starting values, and the share of the squared error up to which they were searched for with care.
struct Found<T> {
    share: f64,
    starts: Vec<T>,
}

impl Probed {
    fn new(probe: Probe) -> Self {
        Self {
            probe,
            starts: Mutex::default(),
            with_body: Mutex::default(),
        }
    }

    /// Starting values of `effect` where it may leave less than this share of the squared error, searched for once.
    pub fn starts(&self, effect: &dyn Effect, share: f64) -> Vec<Vec<f64>> {
        once(&self.starts, effect.id(), share, || {
            effect.starts(&self.probe, share)
        })
    }

    /// The same with a body of their own.
    pub fn starts_with_body(&self, effect: &dyn Effect, share: f64) -> Vec<BodyStart> {
        once(&self.with_body, effect.id(), share, || {
            effect.starts_with_body(&self.probe, share)
        })
    }
}

/// What is known, or as `search` finds it.
fn once<T: Clone>(
    searched: &Searched<T>,
    id: EffectId,
    share: f64,
    search: impl FnOnce() -> Vec<T>,
) -> Vec<T> {
    let known = || searched.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(found) = known().get(&id)
        && found.share >= share
    {
        return found.starts.clone();
    }
    // Not under the lock: the search is long, and others look for other effects meanwhile.
    let starts = search();
    let found = Found {
        share,
        starts: starts.clone(),
    };
    known().insert(id, found);
    starts
}

/// A model that was probed.
struct Met {
    effects: Vec<EffectId>,
    values: Vec<f64>,
    cost: f64,
    probed: Arc<Probed>,
}

impl Met {
    fn is(&self, fit: &Fit) -> bool {
        self.effects == fit.structure.ids()
            && (self.cost - fit.cost).abs() <= SAME_COST * self.cost
            && same_place(&self.values, &fit.values)
    }
}

/// The models that were probed last.
#[derive(Default)]
pub(super) struct Probes(Mutex<VecDeque<Met>>);

impl Probes {
    /// What `fit` leaves: known, or as `make` finds it.
    pub fn of(&self, fit: &Fit, make: impl FnOnce() -> Probe) -> Arc<Probed> {
        let mut met = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = met.iter().find(|m| m.is(fit)) {
            return known.probed.clone();
        }
        let probed = Arc::new(Probed::new(make()));
        met.truncate(REMEMBERED - 1);
        met.push_front(Met {
            effects: fit.structure.ids(),
            values: fit.values.clone(),
            cost: fit.cost,
            probed: probed.clone(),
        });
        probed
    }
}
