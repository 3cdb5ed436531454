//! Inverse response: the output first goes the wrong way.

use super::effect::slower_is_the_process;
use super::{Dimension, Effect, EffectId, ParameterSpec, Probe, Range, second_lag};
use crate::measurement::Kind;
use crate::model::Model;

pub(super) const ID: EffectId = EffectId::new("inverse_response");

pub(super) struct InverseResponse;

impl Effect for InverseResponse {
    fn id(&self) -> EffectId {
        ID
    }

    fn name(&self) -> &'static str {
        "Inverse response"
    }

    fn sentence(&self) -> &'static str {
        "Two paths lead from the input to the output, a fast one and a stronger one that works against it: the output \
         first goes the wrong way."
    }

    fn equation(&self) -> &'static str {
        "T_2 dz/dt = u - z, u_acting = z - T_z dz/dt, in series with the first lag"
    }

    fn source(&self) -> &'static str {
        "right half-plane zero: Stephanopoulos, Chemical Process Control, 1984"
    }

    fn kinds(&self) -> &'static [Kind] {
        &[Kind::Process]
    }

    fn parameters(&self) -> &'static [ParameterSpec] {
        &[
            ParameterSpec {
                symbol: "T2",
                label: "second time constant",
                dimension: Dimension::Time,
                range: Range::Positive,
            },
            ParameterSpec {
                symbol: "T_z",
                label: "time constant of the inverse response",
                dimension: Dimension::Time,
                range: Range::NonNegative,
            },
        ]
    }

    fn contains(&self) -> &'static [EffectId] {
        &[second_lag::ID]
    }

    fn starts(&self, probe: &Probe, _share: f64) -> Vec<Vec<f64>> {
        let time = probe.scales.time_constant;
        [[0.05, 0.05], [0.2, 0.1], [0.2, 0.4]]
            .map(|shares| shares.map(|share| share * time).to_vec())
            .to_vec()
    }

    fn order(&self, kind: Kind, body: &mut [f64], values: &mut [f64]) -> bool {
        slower_is_the_process(kind, body, values)
    }

    fn apply(&self, values: &[f64], model: &mut Model) {
        let (lag, zero) = (values[0], values[1]);
        model.lag = Some(lag);
        model.load_before_lag = true;
        // z - T_z dz/dt = z - (T_z/T2) (u - z)
        model.direct = -zero / lag;
    }
}
