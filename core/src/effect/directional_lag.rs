//! A time constant that differs by direction: what is heated fast cools slowly.

use super::{Dimension, Effect, EffectId, ParameterSpec, Probe, Range};
use crate::measurement::Kind;
use crate::model::Model;

pub(super) const ID: EffectId = EffectId::new("directional_lag");

pub(super) struct DirectionalLag;

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

    fn apply(&self, values: &[f64], model: &mut Model) {
        model.slow_fall += values[0];
    }
}
