//! Rate limit: the actuator follows the command at a limited rate.

use super::{Dimension, Effect, EffectId, ParameterSpec, Probe, Range};
use crate::measurement::Kind;
use crate::model::{Actuator, Model};

pub(super) const ID: EffectId = EffectId::new("rate_limit");

pub(super) struct RateLimit;

impl Effect for RateLimit {
    fn id(&self) -> EffectId {
        ID
    }

    fn name(&self) -> &'static str {
        "Rate limit"
    }

    fn sentence(&self) -> &'static str {
        "The actuator cannot jump: however large the step of the command, it moves there at its own speed."
    }

    fn equation(&self) -> &'static str {
        "|du_acting/dt| <= r"
    }

    fn source(&self) -> &'static str {
        "rate limiter: Duda, Effects of rate limiting elements in flight control systems, 1995"
    }

    fn kinds(&self) -> &'static [Kind] {
        &[Kind::Drive, Kind::Process]
    }

    fn parameters(&self) -> &'static [ParameterSpec] {
        &[ParameterSpec {
            symbol: "r",
            label: "largest rate of the input",
            dimension: Dimension::Rise,
            range: Range::Positive,
        }]
    }

    fn starts(&self, probe: &Probe, _share: f64) -> Vec<Vec<f64>> {
        let largest = probe.largest_input();
        [2.0, 8.0, 30.0]
            .map(|samples| vec![largest / (samples * probe.scales.step)])
            .to_vec()
    }

    fn apply(&self, values: &[f64], model: &mut Model) {
        model.actuator = Some(Actuator::Rate(values[0]));
    }
}
