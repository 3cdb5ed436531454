//! Cogging: a torque that repeats with the position.

use std::f64::consts::TAU;

use super::atom::{Values, even};
use super::{
    Atom, BodyStart, Dimension, Effect, EffectId, ParameterSpec, Part, Probe, Range, Shape,
    gravity, hardening_spring, return_spring,
};
use crate::measurement::Kind;
use crate::model::Model;

pub(super) const ID: EffectId = EffectId::new("cogging");

pub(super) struct Cogging;

/// Samples in the shortest wave that is looked for, at the typical speed; frequencies that are tried for each wave that
/// the travel holds, half of what tells two waves apart; and how many at most.
const LEAST_SAMPLES: f64 = 8.0;
const FREQUENCIES_PER_TURN: f64 = 2.0;
const MOST_FREQUENCIES: f64 = 160.0;

/// Spatial frequencies from a wave in the travel to the finest that samples show between which the body goes so far.
pub(super) fn frequencies(travel: f64, way: f64) -> Vec<Shape> {
    let (first, last) = (TAU / travel, TAU / (LEAST_SAMPLES * way));
    let apart = first / FREQUENCIES_PER_TURN;
    let count = ((last - first) / apart).min(MOST_FREQUENCIES);
    even(first, first + count.floor() * apart, count as usize + 1)
}

/// Amplitude and phase of `sine sin(n x) + cosine cos(n x)`.
pub(super) fn wave(sine: f64, cosine: f64) -> [f64; 2] {
    [libm::hypot(sine, cosine), libm::atan2(cosine, sine)]
}

/// The parameters from the frequency and these coefficients.
fn parameters(n: f64, sine: f64, cosine: f64) -> Vec<f64> {
    let [amplitude, phase] = wave(sine, cosine);
    vec![amplitude, n, phase]
}

impl Effect for Cogging {
    fn id(&self) -> EffectId {
        ID
    }

    fn name(&self) -> &'static str {
        "Cogging"
    }

    fn sentence(&self) -> &'static str {
        "Magnets or teeth make the drive pull forward and back as it turns: the force repeats with the position."
    }

    fn equation(&self) -> &'static str {
        "F = a sin(n x + phi)"
    }

    fn source(&self) -> &'static str {
        "cogging torque of permanent-magnet motors: Zhu and Howe, 1992"
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
        ]
    }

    fn starts(&self, probe: &Probe, share: f64) -> Vec<Vec<f64>> {
        probe
            .spatial_frequencies(share)
            .into_iter()
            .map(|(n, sine, cosine)| parameters(n, sine, cosine))
            .collect()
    }

    fn starts_with_body(&self, probe: &Probe, _share: f64) -> Vec<BodyStart> {
        let found = probe.balanced_wave().map(|(n, balance)| {
            let wave = parameters(n, balance.forces[0], balance.forces[1]);
            (balance.body, wave)
        });
        found.into_iter().collect()
    }

    /// A wave as long as a turn is gravity; of a longer one the travel shows a spring.
    fn limits(&self) -> &'static [EffectId] {
        &[gravity::ID, return_spring::ID, hardening_spring::ID]
    }

    fn atoms(&self, _: Kind) -> Vec<Atom> {
        const COLUMNS: &[Part] = &[
            Part::Force(|m, n| libm::sin(n[0] * m.position)),
            Part::Force(|m, n| libm::cos(n[0] * m.position)),
        ];
        vec![Atom {
            parts: COLUMNS,
            grid: |extent| frequencies(extent.travel, extent.speed * extent.step),
            shapes: 1,
            values: Values::From(|solved| {
                let (sine, cosine) = (solved.coefficients[0], solved.coefficients[1]);
                Some((solved.body, parameters(solved.shape[0], sine, cosine)))
            }),
        }]
    }

    fn apply(&self, values: &[f64], model: &mut Model) {
        let (a, n, phi) = (values[0], values[1], values[2]);
        model
            .forces
            .push(Box::new(move |x, _| a * libm::sin(n * x + phi)));
    }
}
