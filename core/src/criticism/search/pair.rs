//! Two effects that only show together.

use super::Search;
use crate::criticism::fit::Fit;
use crate::criticism::session::Session;
use crate::effect::{EffectId, baseline};

/// A body at rest under a load is held by its friction: without that it falls, and without the load nothing pulls at it.
const HOLDS: EffectId = EffectId::new("coulomb_friction");
const PULLS: EffectId = EffectId::new("constant_load");

impl Search {
    /// Adds dry friction and a constant load to a baseline whose body is held.
    pub fn rubbing_under_load(session: &Session, fit: &Fit) -> Option<Self> {
        let load = session.held?.load;
        let (holds, pulls) = (session.find(HOLDS)?, session.find(PULLS)?);
        let structure = fit.structure.with(holds).with(pulls);
        let friction = session.probed(fit).starts_with_body(holds, 1.0);
        let points = friction.into_iter().map(|(body, mut own)| {
            let mut values = fit.values.clone();
            values[..=baseline::DAMPING].copy_from_slice(&body);
            values.append(&mut own);
            values.push(load);
            (values, session.data.guessed_starts())
        });
        let points: Vec<_> = points.collect();
        (!points.is_empty()).then(|| Self::from_points(structure, points, f64::INFINITY))
    }
}
