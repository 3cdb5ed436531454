//! An on-off controller as it is built, in a file.

use nalgebra::DVector;
use serde::Deserialize;
use serde::de::IgnoredAny;

use super::error::{ScenarioError, located};
use super::plant::PlantTable;
use super::relay::RelayTable;
use super::relay_loop::{RunTable, SAMPLES};
use crate::on_off::{OnOffLoop, OnOffPlant, OnOffRun, run};
use crate::simulate::{Noise, SimulateError};

/// A loop and how to run it.
#[derive(Clone, Debug, PartialEq)]
pub struct OnOffScenario {
    /// Plant, controller and start.
    pub on_off: OnOffLoop,
    /// Duration of the run, s.
    pub duration: f64,
    /// Distance of its samples, s.
    pub step: f64,
    /// Noise on the output that the controller sees.
    pub noise: Option<Noise>,
}

/// Whether a file has a key that only an on-off controller or a plant in discrete time has.
pub(super) fn is_on_off(text: &str) -> bool {
    #[derive(Default, Deserialize)]
    struct Relay {
        reference: Option<IgnoredAny>,
        dead_zone: Option<IgnoredAny>,
        min_on: Option<IgnoredAny>,
        min_off: Option<IgnoredAny>,
        sampling: Option<IgnoredAny>,
    }
    #[derive(Default, Deserialize)]
    struct Plant {
        sampling_time: Option<IgnoredAny>,
    }
    #[derive(Deserialize)]
    struct Keys {
        #[serde(default)]
        relay: Relay,
        #[serde(default)]
        plant: Plant,
    }
    // What is no TOML is said by who reads it whole.
    toml::from_str(text).is_ok_and(|Keys { relay, plant }| {
        let keys = [
            relay.reference,
            relay.dead_zone,
            relay.min_on,
            relay.min_off,
            relay.sampling,
            plant.sampling_time,
        ];
        keys.iter().any(Option::is_some)
    })
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    plant: PlantTable,
    relay: RelayTable,
    #[serde(default)]
    run: RunTable,
}

impl OnOffScenario {
    /// Reads a scenario.
    ///
    /// # Errors
    /// Line and column of what is no TOML or not expected, or the table and value that cannot be.
    pub fn from_toml(text: &str) -> Result<Self, ScenarioError> {
        let file: File = toml::from_str(text).map_err(|e| located(text, &e))?;
        let plant = if let Some(plant) = file.plant.read_discrete() {
            OnOffPlant::Discrete(plant?)
        } else {
            let (plant, space) = file.plant.read()?;
            OnOffPlant::Continuous(plant, space)
        };
        let on_off = OnOffLoop {
            plant,
            relay: file.relay.on_off()?,
            initial: file.run.initial.map(DVector::from_vec),
        };
        on_off.validate().map_err(ScenarioError::Run)?;
        let (duration, noise) = (file.run.duration, file.run.noise);
        if let Some(noise) = noise {
            noise.check(duration).map_err(ScenarioError::Run)?;
        }
        let step = file.run.step.unwrap_or(duration / SAMPLES);
        Ok(Self {
            on_off,
            duration,
            step,
            noise,
        })
    }

    /// Runs the loop as the file says.
    ///
    /// # Errors
    /// What is wrong with its times.
    pub fn run(&self) -> Result<OnOffRun, SimulateError> {
        run(&self.on_off, self.duration, self.step, self.noise)
    }
}
