//! Torque ripple: the motor is stronger at some angles than at others.

use std::f64::consts::TAU;

use super::atom::{Values, even};
use super::{Atom, Dimension, Effect, EffectId, ParameterSpec, Part, Probe, Range, Shape};
use crate::measurement::Kind;
use crate::model::{Instant, Model};

pub(super) const ID: EffectId = EffectId::new("torque_ripple");

pub(super) struct TorqueRipple;

/// Samples in the shortest wave that is looked for, at the typical speed; frequencies that are tried for each wave that the
/// travel holds, half of what tells two waves apart; and how many at most.
const LEAST_SAMPLES: f64 = 8.0;
const FREQUENCIES_PER_TURN: f64 = 2.0;
const MOST_FREQUENCIES: f64 = 160.0;

/// The largest share of the torque that ripples ([`Range::UnitInterval`]).
const MOST: f64 = 1.0;

/// Waves from which a fit begins.
const STARTS: usize = 3;

/// Spatial frequencies from a wave in the travel to the finest that samples show in which the body goes so far.
fn frequencies(travel: f64, way: f64) -> Vec<Shape> {
    let (first, last) = (TAU / travel, TAU / (LEAST_SAMPLES * way));
    let apart = first / FREQUENCIES_PER_TURN;
    let count = ((last - first) / apart).min(MOST_FREQUENCIES);
    even(first, first + count.floor() * apart, count as usize + 1)
}

/// Share, spatial frequency and phase of a ripple with these parts; none where it is too large to be one.
fn ripple(frequency: f64, sine: f64, cosine: f64) -> Option<Vec<f64>> {
    let share = libm::hypot(sine, cosine);
    (share <= MOST).then(|| vec![share, frequency, libm::atan2(cosine, sine)])
}

impl Effect for TorqueRipple {
    fn id(&self) -> EffectId {
        ID
    }

    fn name(&self) -> &'static str {
        "Torque ripple"
    }

    fn sentence(&self) -> &'static str {
        "The same current gives more torque at some angles than at others, again and again as the motor turns."
    }

    fn equation(&self) -> &'static str {
        "u_acting = u (1 + a sin(n x + phi))"
    }

    fn source(&self) -> &'static str {
        "mutual torque ripple: Jahns and Soong, Pulsating torque minimization techniques, 1996"
    }

    fn kinds(&self) -> &'static [Kind] {
        &[Kind::Drive]
    }

    fn parameters(&self) -> &'static [ParameterSpec] {
        &[
            ParameterSpec {
                symbol: "a",
                label: "share of the torque that ripples",
                dimension: Dimension::Ratio,
                range: Range::UnitInterval,
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

    fn starts(&self, probe: &Probe, _share: f64) -> Vec<Vec<f64>> {
        let (low, high) = probe.position_range();
        let frequencies = frequencies(high - low, probe.scales.speed * probe.scales.step);
        let frequencies: Vec<f64> = frequencies.iter().map(|shape| shape[0]).collect();
        let wave = |m: &Instant, n: f64| {
            [libm::sin(n * m.position), libm::cos(n * m.position)].map(|wave| m.input * wave)
        };
        let best = probe.best_waves(&frequencies, STARTS, wave).into_iter();
        best.filter_map(|(n, [sine, cosine])| ripple(n, sine, cosine))
            .collect()
    }

    fn atoms(&self, _: Kind) -> Vec<Atom> {
        const COLUMNS: &[Part] = &[
            Part::Force(|m, n| m.input * libm::sin(n[0] * m.position)),
            Part::Force(|m, n| m.input * libm::cos(n[0] * m.position)),
        ];
        vec![Atom {
            parts: COLUMNS,
            grid: |extent| frequencies(extent.travel, extent.speed * extent.step),
            shapes: 1,
            values: Values::From(|solved| {
                let (sine, cosine) = (solved.coefficients[0], solved.coefficients[1]);
                Some((solved.body, ripple(solved.shape[0], sine, cosine)?))
            }),
        }]
    }

    fn apply(&self, values: &[f64], model: &mut Model) {
        let (a, n, phi) = (values[0], values[1], values[2]);
        model.own_forces.push(Box::new(move |now| {
            now.input * a * libm::sin(n * now.position + phi)
        }));
    }
}
