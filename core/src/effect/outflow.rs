//! A tank that empties through a hole: the outflow goes with the root of the level.

use super::atom::Values;
use super::{Atom, Dimension, Effect, EffectId, NO_SHAPE, ParameterSpec, Part, Probe, Range};
use crate::measurement::Kind;
use crate::model::Model;

pub(super) const ID: EffectId = EffectId::new("outflow");

pub(super) struct Outflow;

/// A level is not below zero, but for its noise: this share of the largest.
const BELOW: f64 = 0.05;

impl Effect for Outflow {
    fn id(&self) -> EffectId {
        ID
    }

    fn name(&self) -> &'static str {
        "Outflow"
    }

    fn sentence(&self) -> &'static str {
        "A tank empties through an opening: twice the level does not give twice the outflow, which goes with the \
         square root of the level."
    }

    fn equation(&self) -> &'static str {
        "T dy/dt = K (u - a sqrt(y)) - y"
    }

    fn source(&self) -> &'static str {
        "Torricelli, De motu gravium, 1644; tank model: Åström and Hägglund, Advanced PID Control, 2006"
    }

    fn kinds(&self) -> &'static [Kind] {
        &[Kind::Process]
    }

    fn parameters(&self) -> &'static [ParameterSpec] {
        &[ParameterSpec {
            symbol: "a",
            label: "outflow at a level of one",
            dimension: Dimension::Outflow,
            range: Range::NonNegative,
        }]
    }

    fn starts(&self, _probe: &Probe, _share: f64) -> Vec<Vec<f64>> {
        vec![vec![0.0]]
    }

    fn atoms(&self, _: Kind) -> Vec<Atom> {
        const COLUMNS: &[Part] = &[Part::Force(|m, _| -m.velocity.max(0.0).sqrt())];
        vec![Atom {
            grid: |extent| {
                (extent.range[0] >= -BELOW * extent.range[1])
                    .then_some(NO_SHAPE)
                    .into_iter()
                    .collect()
            },
            ..Atom::linear(COLUMNS, Values::Coefficients)
        }]
    }

    fn apply(&self, values: &[f64], model: &mut Model) {
        let flow = values[0];
        model
            .forces
            .push(Box::new(move |_, y| -flow * y.max(0.0).sqrt()));
    }
}
