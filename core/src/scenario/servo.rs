//! A servo in a file.

use serde::Deserialize;

use super::error::{ScenarioError, located};
use super::relay_loop::SAMPLES;
use crate::hunting::Servo;

/// A servo and how to run it.
#[derive(Clone, Debug, PartialEq)]
pub struct ServoScenario {
    /// Drive and controller.
    pub servo: Servo,
    /// Duration of the run, s.
    pub duration: f64,
    /// Distance of its samples, s.
    pub step: f64,
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
}

impl Default for Run {
    fn default() -> Self {
        Self {
            duration: 10.0,
            step: None,
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
        let duration = file.run.duration;
        let step = file.run.step.unwrap_or(duration / SAMPLES);
        Ok(Self {
            servo: file.servo,
            duration,
            step,
        })
    }
}
