//! A time constant that differs by direction: what is heated fast cools slowly.

use super::atom::Values;
use super::{Atom, Dimension, Effect, EffectId, ParameterSpec, Part, Probe, Range, Series};
use crate::measurement::Kind;
use crate::model::Model;
use crate::order::range;

pub(super) const ID: EffectId = EffectId::new("directional_lag");

pub(super) struct DirectionalLag;

/// The largest asymmetry that is one ([`Range::Fraction`]).
const MOST: f64 = 0.9;

/// Share of the range of the output by which it must turn back to be seen to move the other way: more than noise.
const PLAY: f64 = 0.02;

/// How far a series has gone up and down by now, but for what is within `play`.
fn way(values: &[f64], play: f64) -> Vec<f64> {
    let mut followed = values.first().copied().unwrap_or(0.0);
    let mut gone = 0.0;
    let step = |value: &f64| {
        let before = followed;
        followed = followed.max(value - play).min(value + play);
        gone += (followed - before).abs();
        gone
    };
    values.iter().map(step).collect()
}

impl Effect for DirectionalLag {
    fn id(&self) -> EffectId {
        ID
    }

    fn name(&self) -> &'static str {
        "Directional lag"
    }

    fn sentence(&self) -> &'static str {
        "The process rises faster than it falls, or the other way round, though it comes to rest at the same values."
    }

    fn equation(&self) -> &'static str {
        "T (1 - a) dy/dt = K u - y while y rises, T (1 + a) dy/dt = K u - y while it falls"
    }

    fn source(&self) -> &'static str {
        "direction-dependent dynamics: Godfrey, Perturbation Signals for System Identification, 1993"
    }

    fn kinds(&self) -> &'static [Kind] {
        &[Kind::Process]
    }

    fn parameters(&self) -> &'static [ParameterSpec] {
        &[ParameterSpec {
            symbol: "a",
            label: "asymmetry of the time constant",
            dimension: Dimension::Ratio,
            range: Range::Fraction,
        }]
    }

    fn starts(&self, _probe: &Probe, _share: f64) -> Vec<Vec<f64>> {
        vec![vec![0.0]]
    }

    fn atoms(&self, _: Kind) -> Vec<Atom> {
        const COLUMNS: &[Part] = &[Part::Motion(|track, _| {
            let (low, high) = range(track.velocity);
            vec![Series {
                derivative: 1,
                values: way(track.velocity, PLAY * (high - low)),
            }]
        })];
        vec![Atom::linear(
            COLUMNS,
            Values::From(|solved| {
                // J y' - a J |y'| = ...
                let asymmetry = solved.coefficients[0] / solved.body[0];
                (asymmetry.abs() <= MOST).then(|| (solved.body, vec![asymmetry]))
            }),
        )]
    }

    fn apply(&self, values: &[f64], model: &mut Model) {
        model.slow_fall += values[0];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_way_of_a_series_leaves_out_what_is_within_play() {
        let gone = way(&[0.0, 0.1, -0.1, 1.0, 0.9, 0.0], 0.1);
        let exact = [0.0, 0.0, 0.0, 0.9, 0.9, 1.7];
        assert!(
            gone.iter().zip(exact).all(|(a, b)| (a - b).abs() < 1e-12),
            "{gone:?}"
        );
    }
}
