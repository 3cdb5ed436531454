//! Inverse response: the output first goes the wrong way.

use super::atom::Values;
use super::effect::slower_is_the_process;
use super::{
    Atom, Dimension, Effect, EffectId, ParameterSpec, Part, Probe, Range, Series, second_lag,
};
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
        "Two ways lead from the input to the output, a fast one and a stronger one against it: the output first goes the wrong way."
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
                label: "time constant of the wrong way",
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

    /// `T T2 y'' + (T + T2) y' + y = K (u - T_z u')`.
    fn atoms(&self, _: Kind) -> Vec<Atom> {
        const COLUMNS: &[Part] = &[Part::Motion(|track, _| {
            let negative = |values: &[f64]| values.iter().map(|y| -y).collect();
            vec![
                Series {
                    derivative: 2,
                    values: negative(track.velocity),
                },
                Series {
                    derivative: 1,
                    values: negative(track.input),
                },
            ]
        })];
        vec![Atom::linear(
            COLUMNS,
            Values::From(|solved| {
                let (body, lag) = second_lag::lags(solved.body, solved.coefficients[0])?;
                let zero = solved.coefficients[1];
                (zero > 0.0).then(|| (body, vec![lag, zero]))
            }),
        )]
    }

    fn apply(&self, values: &[f64], model: &mut Model) {
        let (lag, zero) = (values[0], values[1]);
        model.lag = Some(lag);
        model.load_before_lag = true;
        // z - T_z dz/dt = z - (T_z/T2) (u - z)
        model.direct = -zero / lag;
    }
}
