//! Saturation: the input has an upper limit.

use super::atom::{Values, even, mapped};
use super::{Atom, Dimension, Effect, EffectId, ParameterSpec, Part, Probe, Range};
use crate::measurement::Kind;
use crate::model::Model;

pub(super) struct Saturation;

/// Limits that are tried: from the first to the second of these shares of the largest input, so many.
const LEAST: f64 = 0.2;
const MOST: f64 = 0.98;
const LIMITS: usize = 14;

impl Effect for Saturation {
    fn id(&self) -> EffectId {
        EffectId::new("saturation")
    }

    fn name(&self) -> &'static str {
        "Saturation"
    }

    fn sentence(&self) -> &'static str {
        "The actuator cannot give more than a limit: larger commands are cut off."
    }

    fn equation(&self) -> &'static str {
        "u_acting = max(-M, min(M, u))"
    }

    fn source(&self) -> &'static str {
        "saturation: Gelb and Vander Velde, Multiple-Input Describing Functions, 1968"
    }

    fn kinds(&self) -> &'static [Kind] {
        &[Kind::Drive, Kind::Process]
    }

    fn parameters(&self) -> &'static [ParameterSpec] {
        &[ParameterSpec {
            symbol: "M",
            label: "limit of the input",
            dimension: Dimension::Force,
            range: Range::Positive,
        }]
    }

    fn starts(&self, probe: &Probe, _share: f64) -> Vec<Vec<f64>> {
        let largest = probe.largest_input();
        [0.95, 0.85, 0.7, 0.5, 0.3]
            .iter()
            .map(|share| vec![share * largest])
            .collect()
    }

    fn atoms(&self, _: Kind) -> Vec<Atom> {
        const COLUMNS: &[Part] = &[Part::Input(|track, limit| {
            mapped(track, |u| u.clamp(-limit[0], limit[0]))
        })];
        vec![Atom {
            parts: COLUMNS,
            grid: |extent| even(LEAST * extent.input, MOST * extent.input, LIMITS),
            shapes: 1,
            values: Values::Shape,
        }]
    }

    fn apply(&self, values: &[f64], model: &mut Model) {
        let limit = values[0];
        model
            .input_maps
            .push(Box::new(move |u| u.max(-limit).min(limit)));
    }
}
