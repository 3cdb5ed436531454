//! An input that moves on between the samples that were kept of it.

use super::atom::Values;
use super::{Atom, Dimension, Effect, EffectId, ParameterSpec, Part, Probe, Range, Series};
use crate::measurement::Kind;
use crate::model::Model;

pub(super) struct SampledInput;

/// A straight line between samples acts like the mean of both.
const STRAIGHT: f64 = 0.5;

impl Effect for SampledInput {
    fn id(&self) -> EffectId {
        EffectId::new("sampled_input")
    }

    fn name(&self) -> &'static str {
        "Input moving between samples"
    }

    fn sentence(&self) -> &'static str {
        "The controller changed its output more often than it was logged: between two samples it was already on its \
         way to the next."
    }

    fn equation(&self) -> &'static str {
        "u_acting = u_k + h (u_(k+1) - u_k) from sample k to the next"
    }

    fn source(&self) -> &'static str {
        "straight line at h = 1/2, first-order hold: Åström and Wittenmark, Computer-Controlled Systems, 1997"
    }

    fn kinds(&self) -> &'static [Kind] {
        &[Kind::Drive, Kind::Process]
    }

    fn parameters(&self) -> &'static [ParameterSpec] {
        &[ParameterSpec {
            symbol: "h",
            label: "share of the way to the next",
            dimension: Dimension::Ratio,
            range: Range::UnitInterval,
        }]
    }

    fn is_of_record(&self) -> bool {
        true
    }

    fn starts(&self, _: &Probe, _share: f64) -> Vec<Vec<f64>> {
        vec![vec![STRAIGHT]]
    }

    fn atoms(&self, _: Kind) -> Vec<Atom> {
        const COLUMNS: &[Part] = &[Part::Motion(|track, _| {
            let next = track.input.iter().skip(1).chain(track.input.last());
            let ahead = track.input.iter().zip(next).map(|(now, next)| next - now);
            let (derivative, values) = (0, ahead.collect());
            vec![Series { derivative, values }]
        })];
        vec![Atom::linear(
            COLUMNS,
            Values::From(|solved| {
                let share = solved.coefficients[0];
                (0.0..=1.0)
                    .contains(&share)
                    .then(|| (solved.body, vec![share]))
            }),
        )]
    }

    fn apply(&self, values: &[f64], model: &mut Model) {
        model.next_input = values[0];
    }
}
