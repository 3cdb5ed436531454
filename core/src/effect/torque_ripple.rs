//! Torque ripple: the motor is stronger at some angles than at others.

use std::f64::consts::TAU;

use super::atom::{Values, even};
use super::{Atom, Dimension, Effect, EffectId, ParameterSpec, Part, Probe, Range};
use crate::measurement::Kind;
use crate::model::Model;

pub(super) const ID: EffectId = EffectId::new("torque_ripple");

pub(super) struct TorqueRipple;

/// Samples in the shortest wave that is looked for, at the typical speed; frequencies that are tried for each wave that the
/// travel holds, half of what tells two waves apart; and how many at most.
const LEAST_SAMPLES: f64 = 8.0;
const FREQUENCIES_PER_TURN: f64 = 2.0;
const MOST_FREQUENCIES: f64 = 160.0;

/// The largest share of the torque that ripples ([`Range::UnitInterval`]).
const MOST: f64 = 1.0;

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

    fn starts(&self, _probe: &Probe, _share: f64) -> Vec<Vec<f64>> {
        Vec::new()
    }

    fn atoms(&self, _: Kind) -> Vec<Atom> {
        const COLUMNS: &[Part] = &[
            Part::Force(|m, n| m.input * libm::sin(n[0] * m.position)),
            Part::Force(|m, n| m.input * libm::cos(n[0] * m.position)),
        ];
        vec![Atom {
            parts: COLUMNS,
            // From a wave in the travel to the finest that samples at the typical speed show.
            grid: |extent| {
                let shortest = LEAST_SAMPLES * extent.speed * extent.step;
                let (first, last) = (TAU / extent.travel, TAU / shortest);
                let apart = first / FREQUENCIES_PER_TURN;
                let count = ((last - first) / apart).min(MOST_FREQUENCIES);
                even(first, first + count.floor() * apart, count as usize + 1)
            },
            shapes: 1,
            values: Values::From(|solved| {
                let (sine, cosine) = (solved.coefficients[0], solved.coefficients[1]);
                let share = libm::hypot(sine, cosine);
                let wave = vec![share, solved.shape[0], libm::atan2(cosine, sine)];
                (share <= MOST).then_some((solved.body, wave))
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
