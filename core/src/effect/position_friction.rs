//! Dry friction that grows along the way, as of a guide that is tighter at one end.

use super::{Dimension, Effect, EffectId, ParameterSpec, Probe, Range};
use crate::measurement::Kind;
use crate::model::Model;

pub(super) const ID: EffectId = EffectId::new("position_friction");

pub(super) struct PositionFriction;

impl Effect for PositionFriction {
    fn id(&self) -> EffectId {
        ID
    }

    fn name(&self) -> &'static str {
        "Position-dependent friction"
    }

    fn sentence(&self) -> &'static str {
        "The guide is tighter at one end than at the other, so that dry friction grows along the travel."
    }

    fn equation(&self) -> &'static str {
        "F = -g x sgn(v), on top of the dry friction at x = 0"
    }

    fn source(&self) -> &'static str {
        "position-dependent friction: Armstrong-Hélouvry, Control of Machines with Friction, 1991"
    }

    fn kinds(&self) -> &'static [Kind] {
        &[Kind::Drive]
    }

    fn parameters(&self) -> &'static [ParameterSpec] {
        &[ParameterSpec {
            symbol: "g",
            label: "rise of the friction level along the travel",
            dimension: Dimension::Stiffness,
            range: Range::Signed,
        }]
    }

    fn starts(&self, probe: &Probe, _share: f64) -> Vec<Vec<f64>> {
        let rubbing = probe.signature(|x, v| -x * v.signum());
        let found = probe.regress(&[&rubbing]).map(|fit| fit.coefficients);
        found.into_iter().collect()
    }

    fn apply(&self, values: &[f64], model: &mut Model) {
        model.friction.rise += values[0];
    }
}
