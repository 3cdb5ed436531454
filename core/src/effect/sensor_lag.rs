//! Sensor lag: the measured signal follows the true one late.
//!
//! On a drive it is the velocity that lags: an encoder counts without delay, the velocity made from
//! it is filtered. Where the position is all that is measured, that lags.

use super::effect::slower_is_the_process;
use super::{Dimension, Effect, EffectId, ParameterSpec, Probe, Range};
use crate::measurement::Kind;
use crate::model::Model;

pub(super) const ID: EffectId = EffectId::new("sensor_lag");

pub(super) struct SensorLag;

impl Effect for SensorLag {
    fn id(&self) -> EffectId {
        ID
    }

    fn name(&self) -> &'static str {
        "Sensor lag"
    }

    fn sentence(&self) -> &'static str {
        "The sensor follows the true value with a lag: what is read is a smoothed, late copy of what happens."
    }

    fn equation(&self) -> &'static str {
        "T_s dy_measured/dt = y - y_measured"
    }

    fn source(&self) -> &'static str {
        "first-order measuring lag: Åström and Hägglund, Advanced PID Control, 2006"
    }

    fn kinds(&self) -> &'static [Kind] {
        &[Kind::Drive, Kind::Process]
    }

    fn parameters(&self) -> &'static [ParameterSpec] {
        &[ParameterSpec {
            symbol: "T_s",
            label: "sensor time constant",
            dimension: Dimension::Time,
            range: Range::Positive,
        }]
    }

    fn starts(&self, probe: &Probe, _share: f64) -> Vec<Vec<f64>> {
        let scales = &probe.scales;
        match probe.kind {
            Kind::Drive => [0.5, 2.0, 8.0, 30.0]
                .iter()
                .map(|samples| vec![samples * scales.step])
                .collect(),
            Kind::Process => [0.03, 0.1, 0.3]
                .iter()
                .map(|share| vec![share * scales.time_constant])
                .collect(),
        }
    }

    fn order(&self, kind: Kind, body: &mut [f64], values: &mut [f64]) -> bool {
        slower_is_the_process(kind, body, values)
    }

    fn apply(&self, values: &[f64], model: &mut Model) {
        model.sensor_lag = Some(values[0]);
    }
}
