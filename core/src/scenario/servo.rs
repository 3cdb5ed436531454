//! A servo in a file.

use serde::Deserialize;

use super::error::{ScenarioError, located};
use super::relay_loop::SAMPLES;
use crate::hunting::{HuntingError, HuntingRun, Servo, run};
use crate::simulate::Noise;

/// A servo and how to run it.
#[derive(Clone, Debug, PartialEq)]
pub struct ServoScenario {
    /// Drive and controller.
    pub servo: Servo,
    /// Duration of the run, s.
    pub duration: f64,
    /// Distance of its samples, s.
    pub step: f64,
    /// Noise on the position that the controller sees.
    pub noise: Option<Noise>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    servo: Servo,
    #[serde(default)]
    run: Run,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Run {
    duration: f64,
    step: Option<f64>,
    noise: Option<Noise>,
}

impl Default for Run {
    fn default() -> Self {
        Self {
            duration: 10.0,
            step: None,
            noise: None,
        }
    }
}

impl ServoScenario {
    /// Reads a scenario.
    ///
    /// # Errors
    /// Line and column of what is no TOML or not expected, or the value that cannot be.
    pub fn from_toml(text: &str) -> Result<Self, ScenarioError> {
        let file: File = toml::from_str(text).map_err(|e| located(text, &e))?;
        file.servo.validate().map_err(ScenarioError::Servo)?;
        let (duration, noise) = (file.run.duration, file.run.noise);
        if let Some(noise) = noise {
            noise.check(duration).map_err(ScenarioError::Run)?;
        }
        let step = file.run.step.unwrap_or(duration / SAMPLES);
        Ok(Self {
            servo: file.servo,
            duration,
            step,
            noise,
        })
    }

    /// Runs the servo as the file says.
    ///
    /// # Errors
    /// What is wrong with its times.
    pub fn run(&self) -> Result<HuntingRun, HuntingError> {
        run(&self.servo, self.duration, self.step, self.noise)
    }
}
