//! First-order lag between the commanded and the acting input of a drive.

use super::{Dimension, Effect, EffectId, ParameterSpec, Probe, Range};
use crate::measurement::Kind;
use crate::model::Model;

pub(super) struct ActuatorLag;

impl Effect for ActuatorLag {
    fn id(&self) -> EffectId {
        EffectId::new("actuator_lag")
    }

    fn name(&self) -> &'static str {
        "Actuator lag"
    }

    fn sentence(&self) -> &'static str {
        "The actuator follows the command gradually, like a filter: fast at first, then ever slower towards the full value."
    }

    fn equation(&self) -> &'static str {
        "T_a du_acting/dt = u - u_acting"
    }

    fn source(&self) -> &'static str {
        "first-order actuator, e.g. the current loop of a drive: Leonhard, Control of Electrical Drives, 2001"
    }

    fn kinds(&self) -> &'static [Kind] {
        &[Kind::Drive]
    }

    fn parameters(&self) -> &'static [ParameterSpec] {
        &[ParameterSpec {
            symbol: "T_a",
            label: "actuator time constant",
            dimension: Dimension::Time,
            range: Range::Positive,
        }]
    }

    fn starts(&self, probe: &Probe, _share: f64) -> Vec<Vec<f64>> {
        [0.5, 1.5, 5.0, 15.0, 50.0]
            .iter()
            .map(|samples| vec![samples * probe.scales.step])
            .collect()
    }

    fn apply(&self, values: &[f64], model: &mut Model) {
        model.lag = Some(values[0]);
    }
}
