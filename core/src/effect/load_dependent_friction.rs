//! Friction that grows with the load of the gear: what motor and load push, the teeth rub.
//!
//! It comes beside the friction that is always there.

use super::atom::{Values, not_negative};
use super::{Atom, Dimension, Effect, EffectId, ParameterSpec, Part, Probe, Range};
use crate::measurement::Kind;
use crate::model::Model;

pub(super) const ID: EffectId = EffectId::new("load_dependent_friction");

pub(super) struct LoadDependentFriction;

/// The largest share with which a fit begins.
const MOST: f64 = 0.5;

impl Effect for LoadDependentFriction {
    fn id(&self) -> EffectId {
        ID
    }

    fn name(&self) -> &'static str {
        "Load-dependent friction"
    }

    fn sentence(&self) -> &'static str {
        "The harder motor and load push against each other, the harder the teeth of the gear are pressed together and the more they rub."
    }

    fn equation(&self) -> &'static str {
        "F = -m |u - F_L| sgn(v) while moving, with F_L what gravity, springs and loads add to u; at rest it holds against as much"
    }

    fn source(&self) -> &'static str {
        "M. Duclusaud and others, Extended friction models for the physics simulation of servo actuators, 2024; Dupont, 1990"
    }

    fn kinds(&self) -> &'static [Kind] {
        &[Kind::Drive]
    }

    fn parameters(&self) -> &'static [ParameterSpec] {
        &[ParameterSpec {
            symbol: "m",
            label: "share of what the gear carries that friction takes",
            dimension: Dimension::Ratio,
            range: Range::UnitInterval,
        }]
    }

    fn starts(&self, probe: &Probe, _share: f64) -> Vec<Vec<f64>> {
        let found = probe.balanced_in_motion(|_, v| -v.signum());
        let level = found.map_or(0.0, |balance| balance.forces[0]);
        vec![vec![(level / probe.scales.force).clamp(0.0, MOST)]]
    }

    fn atoms(&self, _: Kind) -> Vec<Atom> {
        const COLUMNS: &[Part] = &[Part::Force(|m, _| -m.input.abs() * m.direction)];
        vec![Atom::linear(
            COLUMNS,
            Values::From(|solved| {
                let (body, share) = not_negative(solved)?;
                (share[0] < 1.0).then_some((body, share))
            }),
        )]
    }

    fn apply(&self, values: &[f64], model: &mut Model) {
        model.gear_friction += values[0];
    }
}
