//! Dead zone: small inputs do nothing.

use super::atom::{Values, geometric, mapped};
use super::{Atom, Dimension, Effect, EffectId, ParameterSpec, Part, Probe, Range};
use crate::measurement::Kind;
use crate::model::Model;

pub(super) struct DeadZone;

/// Widths that are tried: from the first to the second of these shares of the largest input, so many.
const LEAST: f64 = 0.01;
const MOST: f64 = 0.6;
const ZONES: usize = 16;

impl Effect for DeadZone {
    fn id(&self) -> EffectId {
        EffectId::new("dead_zone")
    }

    fn name(&self) -> &'static str {
        "Dead zone"
    }

    fn sentence(&self) -> &'static str {
        "Small commands have no effect at all, and large ones lose the same amount."
    }

    fn equation(&self) -> &'static str {
        "u_acting = u - z sgn(u) where |u| > z, else 0"
    }

    fn source(&self) -> &'static str {
        "dead zone: Gelb and Vander Velde, Multiple-Input Describing Functions, 1968"
    }

    fn kinds(&self) -> &'static [Kind] {
        &[Kind::Drive, Kind::Process]
    }

    fn parameters(&self) -> &'static [ParameterSpec] {
        &[ParameterSpec {
            symbol: "z",
            label: "half width of the dead zone",
            dimension: Dimension::Force,
            range: Range::NonNegative,
        }]
    }

    fn starts(&self, probe: &Probe, _share: f64) -> Vec<Vec<f64>> {
        let largest = probe.largest_input();
        [0.03, 0.1, 0.25, 0.5]
            .iter()
            .map(|share| vec![share * largest])
            .collect()
    }

    fn atoms(&self, _: Kind) -> Vec<Atom> {
        const COLUMNS: &[Part] = &[Part::Input(|track, zone| {
            mapped(track, |u| u - u.clamp(-zone[0], zone[0]))
        })];
        vec![Atom {
            parts: COLUMNS,
            grid: |extent| geometric(LEAST * extent.input, MOST * extent.input, ZONES),
            shapes: 1,
            values: Values::Shape,
        }]
    }

    fn apply(&self, values: &[f64], model: &mut Model) {
        let zone = values[0];
        model
            .input_maps
            .push(Box::new(move |u| u - u.max(-zone).min(zone)));
    }
}
