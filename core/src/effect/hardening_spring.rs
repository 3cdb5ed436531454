//! The part of a spring that grows with the cube of the way.

use super::atom::{Values, not_negative};
use super::{Atom, Dimension, Effect, EffectId, ParameterSpec, Part, Probe, Range};
use crate::measurement::Kind;
use crate::model::Model;

pub(super) const ID: EffectId = EffectId::new("hardening_spring");

pub(super) struct HardeningSpring;

impl Effect for HardeningSpring {
    fn id(&self) -> EffectId {
        ID
    }

    fn name(&self) -> &'static str {
        "Hardening spring"
    }

    fn sentence(&self) -> &'static str {
        "A spring that hardly pulls near the middle and ever harder towards the ends."
    }

    fn equation(&self) -> &'static str {
        "F = -k3 x^3"
    }

    fn source(&self) -> &'static str {
        "Duffing, Erzwungene Schwingungen bei veränderlicher Eigenfrequenz, 1918"
    }

    fn kinds(&self) -> &'static [Kind] {
        &[Kind::Drive]
    }

    fn parameters(&self) -> &'static [ParameterSpec] {
        &[ParameterSpec {
            symbol: "k3",
            label: "cubic stiffness",
            dimension: Dimension::CubicStiffness,
            range: Range::NonNegative,
        }]
    }

    fn starts(&self, probe: &Probe, _share: f64) -> Vec<Vec<f64>> {
        let cube = probe.signature(|x, _| x * x * x);
        let fit = probe.regress(&[&cube]);
        let found = fit.map(|fit| vec![(-fit.coefficients[0]).max(0.0)]);
        found.into_iter().collect()
    }

    fn atoms(&self, _: Kind) -> Vec<Atom> {
        const COLUMNS: &[Part] = &[Part::Force(|m, _| -m.position.powi(3))];
        vec![Atom::linear(COLUMNS, Values::From(not_negative))]
    }

    fn apply(&self, values: &[f64], model: &mut Model) {
        let stiffness = values[0];
        model
            .forces
            .push(Box::new(move |x, _| -stiffness * x * x * x));
    }
}
