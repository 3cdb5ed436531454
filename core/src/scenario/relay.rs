//! The table `[relay]` of a loop around a linear plant.

use serde::Deserialize;

use super::error::ScenarioError;
use crate::on_off::OnOffRelay;
use crate::relay::Relay;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RelayTable {
    gain: Option<f64>,
    levels: Option<[f64; 2]>,
    #[serde(default)]
    hysteresis: f64,
    #[serde(default)]
    asymmetry: f64,
    #[serde(default)]
    bias: f64,
    #[serde(default)]
    delay: f64,
    #[serde(default)]
    reference: f64,
    #[serde(default)]
    dead_zone: f64,
    #[serde(default)]
    min_on: f64,
    #[serde(default)]
    min_off: f64,
    sampling: Option<f64>,
}

impl RelayTable {
    /// Gain, hysteresis, asymmetry, bias and delay.
    pub fn relay(&self) -> Result<Relay, ScenarioError> {
        let relay = Relay {
            gain: self.gain.unwrap_or_default(),
            hysteresis: self.hysteresis,
            asymmetry: self.asymmetry,
            bias: self.bias,
            delay: self.delay,
        };
        let relay = match self.levels {
            None if self.gain.is_none() => {
                return Err(ScenarioError::Levels("there is neither a gain nor levels"));
            }
            None => relay,
            Some(_) if self.gain.is_some() || self.asymmetry != 0.0 || self.bias != 0.0 => {
                return Err(ScenarioError::Levels(
                    "levels replace gain, asymmetry and bias",
                ));
            }
            Some([low, high]) => {
                let (gain, mean) = (0.5 * (high - low), 0.5 * (high + low));
                // Of three positions the one between is 0.
                let (asymmetry, bias) = if self.dead_zone > 0.0 {
                    (mean / gain, 0.0)
                } else {
                    (0.0, mean)
                };
                Relay {
                    gain,
                    asymmetry,
                    bias,
                    ..relay
                }
            }
        };
        relay.validate()?;
        Ok(relay)
    }

    /// The whole controller.
    pub fn on_off(&self) -> Result<OnOffRelay, ScenarioError> {
        let relay = OnOffRelay {
            relay: self.relay()?,
            reference: self.reference,
            dead_zone: self.dead_zone,
            min_on: self.min_on,
            min_off: self.min_off,
            sampling: self.sampling,
        };
        relay.validate()?;
        Ok(relay)
    }
}
