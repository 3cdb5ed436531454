//! Different gain for positive and negative input.

use super::atom::Values;
use super::{Atom, Dimension, Effect, EffectId, ParameterSpec, Part, Probe, Range};
use crate::measurement::Kind;
use crate::model::Model;
use crate::order::sign;

pub(super) const ID: EffectId = EffectId::new("gain_asymmetry");

pub(super) struct GainAsymmetry;

/// The largest asymmetry that is one ([`Range::Fraction`]).
const MOST: f64 = 0.9;

impl Effect for GainAsymmetry {
    fn id(&self) -> EffectId {
        ID
    }

    fn name(&self) -> &'static str {
        "Gain asymmetry"
    }

    fn sentence(&self) -> &'static str {
        "The actuator is stronger in one direction than in the other."
    }

    fn equation(&self) -> &'static str {
        "u_acting = (1 + a) u for u > 0, (1 - a) u for u < 0"
    }

    fn source(&self) -> &'static str {
        "asymmetric relay gain, equation (2) of the paper, here in the actuator"
    }

    fn kinds(&self) -> &'static [Kind] {
        &[Kind::Drive, Kind::Process]
    }

    fn parameters(&self) -> &'static [ParameterSpec] {
        &[ParameterSpec {
            symbol: "a",
            label: "asymmetry",
            dimension: Dimension::Ratio,
            range: Range::Fraction,
        }]
    }

    fn starts(&self, probe: &Probe, _share: f64) -> Vec<Vec<f64>> {
        vec![vec![probe.asymmetry().unwrap_or(0.0)]]
    }

    fn atoms(&self, _: Kind) -> Vec<Atom> {
        const COLUMNS: &[Part] = &[Part::Force(|m, _| m.input.abs())];
        vec![Atom::linear(
            COLUMNS,
            Values::From(|solved| {
                (solved.coefficients[0].abs() <= MOST)
                    .then(|| (solved.body, solved.coefficients.to_vec()))
            }),
        )]
    }

    fn apply(&self, values: &[f64], model: &mut Model) {
        let a = values[0];
        model
            .input_maps
            .push(Box::new(move |u| (1.0 + a * sign(u)) * u));
    }
}
