//! Dry friction that differs between forward and back.
//!
//! It contains Coulomb friction (both levels the same) and replaces it.

use super::atom::{Values, not_negative};
use super::{
    Atom, Dimension, Effect, EffectId, ParameterSpec, Part, Probe, Range, coulomb_friction,
};
use crate::measurement::Kind;
use crate::model::Model;

pub(super) const ID: EffectId = EffectId::new("directional_friction");

pub(super) struct DirectionalFriction;

impl Effect for DirectionalFriction {
    fn id(&self) -> EffectId {
        ID
    }

    fn name(&self) -> &'static str {
        "Directional friction"
    }

    fn sentence(&self) -> &'static str {
        "Dry friction is stronger in one direction than in the other, as with a worm gear or a worn seal."
    }

    fn equation(&self) -> &'static str {
        "F = -c_f for v > 0, c_b for v < 0; at rest F balances the input up to their mean, about half their difference"
    }

    fn source(&self) -> &'static str {
        "Armstrong-Hélouvry, Control of Machines with Friction, 1991"
    }

    fn kinds(&self) -> &'static [Kind] {
        &[Kind::Drive]
    }

    fn parameters(&self) -> &'static [ParameterSpec] {
        &[
            ParameterSpec {
                symbol: "c_f",
                label: "friction level forward",
                dimension: Dimension::Force,
                range: Range::NonNegative,
            },
            ParameterSpec {
                symbol: "c_b",
                label: "friction level back",
                dimension: Dimension::Force,
                range: Range::NonNegative,
            },
        ]
    }

    fn starts(&self, probe: &Probe, _share: f64) -> Vec<Vec<f64>> {
        let level = probe.friction_level();
        vec![
            vec![1.2 * level, 0.8 * level],
            vec![0.8 * level, 1.2 * level],
        ]
    }

    fn contains(&self) -> &'static [EffectId] {
        &[coulomb_friction::ID]
    }

    fn telling(&self) -> usize {
        2
    }

    fn atoms(&self, _: Kind) -> Vec<Atom> {
        const COLUMNS: &[Part] = &[
            Part::Force(|m, _| -m.direction.max(0.0)),
            Part::Force(|m, _| -m.direction.min(0.0)),
        ];
        vec![Atom::linear(COLUMNS, Values::From(not_negative))]
    }

    fn apply(&self, values: &[f64], model: &mut Model) {
        let (forward, back) = (values[0], values[1]);
        let difference = (forward - back) / 2.0;
        model.friction.level += f64::midpoint(forward, back);
        // In motion only: what is at rest is held from both sides alike.
        model.forces.push(Box::new(
            move |_, v| if v == 0.0 { 0.0 } else { -difference },
        ));
    }
}
