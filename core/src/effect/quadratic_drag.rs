//! Quadratic drag: resistance that grows with the square of speed.

use super::atom::{Values, not_negative};
use super::{Atom, Dimension, Effect, EffectId, ParameterSpec, Part, Probe, Range};
use crate::measurement::Kind;
use crate::model::Model;

pub(super) struct QuadraticDrag;

impl Effect for QuadraticDrag {
    fn id(&self) -> EffectId {
        EffectId::new("quadratic_drag")
    }

    fn name(&self) -> &'static str {
        "Quadratic drag"
    }

    fn sentence(&self) -> &'static str {
        "Air or liquid pushes back with the square of the speed: hardly felt when slow, strong when fast."
    }

    fn equation(&self) -> &'static str {
        "F = -q v |v|"
    }

    fn source(&self) -> &'static str {
        "Newtonian drag: Batchelor, An Introduction to Fluid Dynamics, 1967"
    }

    fn kinds(&self) -> &'static [Kind] {
        &[Kind::Drive]
    }

    fn parameters(&self) -> &'static [ParameterSpec] {
        &[ParameterSpec {
            symbol: "q",
            label: "drag coefficient",
            dimension: Dimension::Drag,
            range: Range::NonNegative,
        }]
    }

    fn starts(&self, probe: &Probe, _share: f64) -> Vec<Vec<f64>> {
        let drag = probe.signature(|_, v| v * v.abs());
        let q = probe
            .regress(&[&drag])
            .map_or(0.0, |fit| -fit.coefficients[0]);
        vec![vec![q.max(0.01 * probe.scales.of(Dimension::Drag))]]
    }

    fn atoms(&self, _: Kind) -> Vec<Atom> {
        const COLUMNS: &[Part] = &[Part::Force(|m, _| -m.velocity * m.velocity.abs())];
        vec![Atom::linear(COLUMNS, Values::From(not_negative))]
    }

    fn apply(&self, values: &[f64], model: &mut Model) {
        let q = values[0];
        model.forces.push(Box::new(move |_, v| -q * v * v.abs()));
    }
}
