//! End stops: a spring with damping that pushes the body back where its way ends.

use super::{Dimension, Effect, EffectId, ParameterSpec, Probe, Range};
use crate::measurement::Kind;
use crate::model::Model;

pub(super) const ID: EffectId = EffectId::new("end_stop");

pub(super) struct EndStop;

/// Natural frequencies of the body on a stop that a fit begins with, in radians per sample: from one that gives way
/// over many samples to one that throws the body back within a few.
const STIFFNESSES: [f64; 4] = [0.03, 0.1, 0.3, 1.0];

/// Most of the travel that a stop takes.
const DEEPEST: f64 = 0.35;

/// Samples at rest that tell the place of a stop.
const RESTS: usize = 20;

/// Force of a stop that is pressed in by `depth` at this rate; it does not pull.
fn push(stiffness: f64, damping: f64, depth: f64, rate: f64) -> f64 {
    if depth > 0.0 {
        (stiffness * depth + damping * rate).max(0.0)
    } else {
        0.0
    }
}

/// How far a body at its greatest speed presses in a stop on which it swings with so many radians in a sample, at most.
fn depth(radians: f64, fastest: f64, step: f64, travel: f64) -> f64 {
    (fastest * step / radians).min(DEEPEST * travel)
}

impl Effect for EndStop {
    fn id(&self) -> EffectId {
        ID
    }

    fn name(&self) -> &'static str {
        "End stop"
    }

    fn sentence(&self) -> &'static str {
        "The travel ends at a stop: there the drive runs into something that gives a little and throws it back."
    }

    fn equation(&self) -> &'static str {
        "F = -(k (x - x_h) + d v) for x > x_h, -(k (x - x_l) + d v) for x < x_l; never a pull"
    }

    fn source(&self) -> &'static str {
        "impact of a damped spring: Goldsmith, Impact, 1960"
    }

    fn kinds(&self) -> &'static [Kind] {
        &[Kind::Drive]
    }

    fn parameters(&self) -> &'static [ParameterSpec] {
        &[
            ParameterSpec {
                symbol: "k",
                label: "stiffness of the stop",
                dimension: Dimension::Stiffness,
                range: Range::Hard,
            },
            ParameterSpec {
                symbol: "d",
                label: "damping of the stop",
                dimension: Dimension::ViscousFriction,
                range: Range::NonNegative,
            },
            ParameterSpec {
                symbol: "x_h",
                label: "position of the upper stop",
                dimension: Dimension::Position,
                range: Range::Signed,
            },
            ParameterSpec {
                symbol: "x_l",
                label: "position of the lower stop",
                dimension: Dimension::Position,
                range: Range::Signed,
            },
        ]
    }

    /// How hard a stop is that is as good as rigid no record tells, but that it pushes.
    fn telling(&self) -> usize {
        2
    }

    fn starts(&self, probe: &Probe, _share: f64) -> Vec<Vec<f64>> {
        let (low, high) = probe.position_range();
        let (back, forth) = probe.velocity_range();
        let (travel, fastest) = (high - low, forth.max(-back));
        let (step, scale) = (probe.scales.step, probe.scales.of(Dimension::Stiffness));
        // What is left of a model that runs on through a stop says little of it: its places follow from where the body
        // rests at the ends of the way, or else from how far it can run in.
        let all = STIFFNESSES.iter().flat_map(|radians| {
            let stiffness = radians * radians * scale;
            let deep = depth(*radians, fastest, step, travel);
            let above = |x: f64| x > high - DEEPEST * travel;
            let below = |x: f64| x < low + DEEPEST * travel;
            let upper = probe.spring_at_rest(stiffness, above, RESTS);
            let lower = probe.spring_at_rest(stiffness, below, RESTS);
            let (upper, lower) = (upper.unwrap_or(high - deep), lower.unwrap_or(low + deep));
            [[upper, lower], [upper, low], [high, lower]].map(|[x, y]| vec![stiffness, 0.0, x, y])
        });
        all.collect()
    }

    fn apply(&self, values: &[f64], model: &mut Model) {
        let (stiffness, damping, upper, lower) = (values[0], values[1], values[2], values[3]);
        model.forces.push(Box::new(move |x, v| {
            push(stiffness, damping, lower - x, -v) - push(stiffness, damping, x - upper, v)
        }));
    }
}
