//! Valve stiction: the stem sticks until the command has moved far enough, and slips.

use super::{Dimension, Effect, EffectId, ParameterSpec, Probe, Range};
use crate::measurement::Kind;
use crate::model::{Actuator, Model};

pub(super) const ID: EffectId = EffectId::new("valve_stiction");

pub(super) struct ValveStiction;

impl Effect for ValveStiction {
    fn id(&self) -> EffectId {
        ID
    }

    fn name(&self) -> &'static str {
        "Valve stiction"
    }

    fn sentence(&self) -> &'static str {
        "The valve sticks when the command turns back, and lets go with a jump once it has been pushed far enough."
    }

    fn equation(&self) -> &'static str {
        "x rests until |u - x| > b + J, and slips to u -+ b; u_acting = x"
    }

    fn source(&self) -> &'static str {
        "Choudhury, Thornhill and Shah, Modelling valve stiction, 2005; He, Wang, Pottmann and Qin, 2007"
    }

    fn kinds(&self) -> &'static [Kind] {
        &[Kind::Process]
    }

    fn parameters(&self) -> &'static [ParameterSpec] {
        &[
            ParameterSpec {
                symbol: "b",
                label: "how far the valve lags behind",
                dimension: Dimension::Force,
                range: Range::NonNegative,
            },
            ParameterSpec {
                symbol: "J",
                label: "jump with which it breaks loose",
                dimension: Dimension::Force,
                range: Range::NonNegative,
            },
        ]
    }

    fn starts(&self, probe: &Probe, _share: f64) -> Vec<Vec<f64>> {
        let largest = probe.largest_input();
        [0.02, 0.07, 0.2]
            .map(|share| vec![share * largest, 0.0])
            .to_vec()
    }

    fn apply(&self, values: &[f64], model: &mut Model) {
        model.actuator = Some(Actuator::Stiction {
            behind: values[0],
            jump: values[1],
        });
    }
}
