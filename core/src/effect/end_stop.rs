//! End stops: a spring with damping that pushes the body back where its way ends.

use super::atom::Values;
use super::{Atom, Dimension, Effect, EffectId, ParameterSpec, Part, Probe, Range};
use crate::measurement::Kind;
use crate::model::Model;

pub(super) struct EndStop;

/// Places of a stop that are tried on each side: so many, up to this share of the travel from its end.
const PLACES: usize = 8;
const DEEPEST: f64 = 0.35;

/// Natural frequencies, in radians per sample, that a fit begins with where the screen tells no stiffness.
const STIFFNESSES: [f64; 3] = [0.03, 0.1, 0.3];

/// Force of a stop that is pressed in by `depth` at this rate; it does not pull.
fn push(stiffness: f64, damping: f64, depth: f64, rate: f64) -> f64 {
    if depth > 0.0 {
        (stiffness * depth + damping * rate).max(0.0)
    } else {
        0.0
    }
}

/// Distances of a stop from the end of the travel, as shares of it: 0 is none that was met.
fn depths() -> impl Iterator<Item = f64> {
    (0..=PLACES).map(|k| DEEPEST * k as f64 / PLACES as f64)
}

impl Effect for EndStop {
    fn id(&self) -> EffectId {
        EffectId::new("end_stop")
    }

    fn name(&self) -> &'static str {
        "End stop"
    }

    fn sentence(&self) -> &'static str {
        "The way ends at a stop: there the drive runs into something that gives way a little and throws it back."
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

    fn starts(&self, probe: &Probe, share: f64) -> Vec<Vec<f64>> {
        let (low, high) = probe.position_range();
        let travel = high - low;
        let mut found: Vec<(f64, Vec<f64>)> = Vec::new();
        for (upper, lower) in depths().flat_map(|a| depths().map(move |b| (a, b))) {
            let (upper, lower) = (high - upper * travel, low + lower * travel);
            let pressed = probe.signature(|x, _| (lower - x).max(0.0) - (x - upper).max(0.0));
            let fit = probe.regress(&[&pressed]);
            found.extend(
                fit.filter(|f| f.coefficients[0] > 0.0 && f.left < share)
                    .map(|f| (f.left, vec![f.coefficients[0], 0.0, upper, lower])),
            );
        }
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        let Some((_, best)) = found.into_iter().next() else {
            return Vec::new();
        };
        // Where a stop is hard, what is left of a motion that runs on through it tells no stiffness.
        let scale = probe.scales.of(Dimension::Stiffness);
        let stiffer = STIFFNESSES.map(|radians| {
            let mut start = best.clone();
            start[0] = radians * radians * scale;
            start
        });
        std::iter::once(best.clone()).chain(stiffer).collect()
    }

    fn atoms(&self, _: Kind) -> Vec<Atom> {
        const COLUMNS: &[Part] = &[
            Part::Force(|m, ends| {
                (ends[1] - m.position).max(0.0) - (m.position - ends[0]).max(0.0)
            }),
            Part::Force(|m, ends| {
                let inside = m.position <= ends[0] && m.position >= ends[1];
                if inside { 0.0 } else { -m.velocity }
            }),
        ];
        vec![Atom {
            parts: COLUMNS,
            grid: |extent| {
                let [low, high] = extent.places;
                let travel = high - low;
                let pairs = depths().flat_map(|a| depths().map(move |b| (a, b)));
                pairs
                    .filter(|(a, b)| *a > 0.0 || *b > 0.0)
                    .map(|(a, b)| [high - a * travel, low + b * travel, 0.0])
                    .collect()
            },
            shapes: 2,
            values: Values::From(|solved| {
                let [stiffness, damping] = [solved.coefficients[0], solved.coefficients[1]];
                let [upper, lower, _] = solved.shape;
                (stiffness > 0.0)
                    .then(|| (solved.body, vec![stiffness, damping.max(0.0), upper, lower]))
            }),
        }]
    }

    fn apply(&self, values: &[f64], model: &mut Model) {
        let (stiffness, damping, upper, lower) = (values[0], values[1], values[2], values[3]);
        model.forces.push(Box::new(move |x, v| {
            push(stiffness, damping, lower - x, -v) - push(stiffness, damping, x - upper, v)
        }));
    }
}
