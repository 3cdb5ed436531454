//! Cogging that is no pure wave: a second one, twice as fine, beside the first.

use super::{Dimension, Effect, EffectId, ParameterSpec, Probe, Range, cogging};
use crate::measurement::Kind;
use crate::model::Model;

pub(super) const ID: EffectId = EffectId::new("cogging_harmonics");

pub(super) struct CoggingHarmonics;

/// The parameters from the frequency of the first wave and the coefficients of both.
fn parameters(n: f64, coefficients: &[f64]) -> Vec<f64> {
    let [a, phi] = cogging::wave(coefficients[0], coefficients[1]);
    let [b, psi] = cogging::wave(coefficients[2], coefficients[3]);
    vec![a, n, phi, b, psi]
}

impl Effect for CoggingHarmonics {
    fn id(&self) -> EffectId {
        ID
    }

    fn name(&self) -> &'static str {
        "Cogging with a harmonic"
    }

    fn sentence(&self) -> &'static str {
        "The pull of magnets or teeth is not a pure sine of the angle: a second wave, twice as fine, comes on top."
    }

    fn equation(&self) -> &'static str {
        "F = a sin(n x + phi) + b sin(2 n x + psi)"
    }

    fn source(&self) -> &'static str {
        "harmonics of the cogging torque: Zhu and Howe, 1992"
    }

    fn kinds(&self) -> &'static [Kind] {
        &[Kind::Drive]
    }

    fn parameters(&self) -> &'static [ParameterSpec] {
        &[
            ParameterSpec {
                symbol: "a",
                label: "cogging amplitude",
                dimension: Dimension::Force,
                range: Range::NonNegative,
            },
            ParameterSpec {
                symbol: "n",
                label: "spatial frequency",
                dimension: Dimension::PerPosition,
                range: Range::Repeating,
            },
            ParameterSpec {
                symbol: "phi",
                label: "phase",
                dimension: Dimension::Phase,
                range: Range::Signed,
            },
            ParameterSpec {
                symbol: "b",
                label: "amplitude of the harmonic",
                dimension: Dimension::Force,
                range: Range::NonNegative,
            },
            ParameterSpec {
                symbol: "psi",
                label: "phase of the harmonic",
                dimension: Dimension::Phase,
                range: Range::Signed,
            },
        ]
    }

    fn has_part(&self, other: EffectId) -> bool {
        other == cogging::ID
    }

    fn starts(&self, probe: &Probe, share: f64) -> Vec<Vec<f64>> {
        // Each that is followed may be the first wave or the second.
        let found = probe.spatial_frequencies(share).into_iter();
        let firsts = found.flat_map(|(n, _, _)| [n, n / 2.0]);
        let start = |n: f64| {
            let of = |f: fn(f64) -> f64, k: f64| probe.signature(move |x, _| f(k * n * x));
            let columns = [
                of(libm::sin, 1.0),
                of(libm::cos, 1.0),
                of(libm::sin, 2.0),
                of(libm::cos, 2.0),
            ];
            let fit = probe.regress(&columns.each_ref().map(Vec::as_slice))?;
            Some(parameters(n, &fit.coefficients))
        };
        firsts.filter_map(start).collect()
    }

    fn apply(&self, values: &[f64], model: &mut Model) {
        let [a, n, phi, b, psi] = [values[0], values[1], values[2], values[3], values[4]];
        model.forces.push(Box::new(move |x, _| {
            a * libm::sin(n * x + phi) + b * libm::sin(2.0 * n * x + psi)
        }));
    }
}
