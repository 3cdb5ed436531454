//! Load ramp: a disturbance that grows steadily.

use super::atom::Values;
use super::{Atom, Dimension, Effect, EffectId, ParameterSpec, Part, Probe, Range};
use crate::measurement::Kind;
use crate::model::Model;

pub(super) struct LoadRamp;

impl Effect for LoadRamp {
    fn id(&self) -> EffectId {
        EffectId::new("load_ramp")
    }

    fn name(&self) -> &'static str {
        "Load ramp"
    }

    fn sentence(&self) -> &'static str {
        "A disturbance grows steadily through the whole record, like a tank that slowly cools or a supply that drifts."
    }

    fn equation(&self) -> &'static str {
        "u_acting = u + r t"
    }

    fn source(&self) -> &'static str {
        "ramp load disturbance: Åström and Hägglund, Advanced PID Control, 2006"
    }

    fn kinds(&self) -> &'static [Kind] {
        &[Kind::Process]
    }

    fn parameters(&self) -> &'static [ParameterSpec] {
        &[ParameterSpec {
            symbol: "r",
            label: "rise of the load",
            dimension: Dimension::Rise,
            range: Range::Signed,
        }]
    }

    fn starts(&self, _probe: &Probe, _share: f64) -> Vec<Vec<f64>> {
        vec![vec![0.0]]
    }

    fn atoms(&self, _: Kind) -> Vec<Atom> {
        const COLUMNS: &[Part] = &[Part::Force(|m, _| m.time)];
        vec![Atom::linear(COLUMNS, Values::Coefficients)]
    }

    fn apply(&self, values: &[f64], model: &mut Model) {
        model.force_ramp += values[0];
    }
}
