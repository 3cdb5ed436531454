//! A constant force or input that nobody commanded.

use super::atom::Values;
use super::{Atom, Dimension, Effect, EffectId, ParameterSpec, Part, Probe, Range};
use crate::measurement::Kind;
use crate::model::Model;

pub(super) const ID: EffectId = EffectId::new("constant_load");

pub(super) struct ConstantLoad;

impl Effect for ConstantLoad {
    fn id(&self) -> EffectId {
        ID
    }

    fn name(&self) -> &'static str {
        "Constant load"
    }

    fn sentence(&self) -> &'static str {
        "Something pushes all the time with the same force, such as a hanging weight or an offset of the amplifier."
    }

    fn equation(&self) -> &'static str {
        "u_acting = u + F0"
    }

    fn source(&self) -> &'static str {
        "constant load disturbance: Åström and Hägglund, Advanced PID Control, 2006"
    }

    fn kinds(&self) -> &'static [Kind] {
        &[Kind::Drive, Kind::Process]
    }

    fn parameters(&self) -> &'static [ParameterSpec] {
        &[ParameterSpec {
            symbol: "F0",
            label: "constant load",
            dimension: Dimension::Force,
            range: Range::Signed,
        }]
    }

    fn starts(&self, probe: &Probe, _share: f64) -> Vec<Vec<f64>> {
        vec![vec![probe.offset()]]
    }

    fn atoms(&self, kind: Kind) -> Vec<Atom> {
        const COLUMNS: &[Part] = &[Part::Force(|_, _| 1.0)];
        match kind {
            Kind::Drive => vec![Atom::linear(COLUMNS, Values::Coefficients)],
            // The operating point of a process is a part of its baseline.
            Kind::Process => Vec::new(),
        }
    }

    fn apply(&self, values: &[f64], model: &mut Model) {
        model.constant_force += values[0];
    }
}
