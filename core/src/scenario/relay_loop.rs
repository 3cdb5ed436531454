//! A relay loop around a linear plant in continuous time.

use nalgebra::DVector;
use serde::Deserialize;

use super::error::{ScenarioError, located};
use super::plant::PlantTable;
use super::relay::RelayTable;
use crate::limit_cycle::{LongRun, LongRunResult, Prediction};
use crate::plant::{MAX_ORDER, StateSpace, TransferFunction};
use crate::relay::Relay;
use crate::simulate::{Flow, MAX_SWITCHES, Noise, Options, SimulateError, Trajectory, run};

/// A loop and how to run it.
#[derive(Clone, Debug, PartialEq)]
pub struct Scenario {
    /// The plant.
    pub plant: TransferFunction,
    /// The same without dead time, in the states of the file if it gives them.
    pub space: StateSpace,
    /// The relay.
    pub relay: Relay,
    /// How to run it.
    pub options: Options,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    plant: PlantTable,
    relay: RelayTable,
    run: Option<RunTable>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RunTable {
    pub duration: f64,
    pub step: Option<f64>,
    pub initial: Option<Vec<f64>>,
    pub noise: Option<Noise>,
}

impl Default for RunTable {
    fn default() -> Self {
        Self {
            duration: DURATION,
            step: None,
            initial: None,
            noise: None,
        }
    }
}

/// Duration of a run that the file does not set, s.
const DURATION: f64 = 60.0;

/// Samples of a run whose step the file does not set.
pub(super) const SAMPLES: f64 = 2000.0;

impl Scenario {
    /// Reads a scenario.
    ///
    /// # Errors
    /// Line and column of what is no TOML or not expected, or the table and value that cannot be.
    pub fn from_toml(text: &str) -> Result<Self, ScenarioError> {
        let file: File = toml::from_str(text).map_err(|e| located(text, &e))?;
        let (plant, space) = file.plant.read()?;
        let relay = file.relay.relay()?;
        let run = file.run.unwrap_or_default();
        let options = Options {
            duration: run.duration,
            step: Some(run.step.unwrap_or(run.duration / SAMPLES)),
            initial: run.initial.map(DVector::from_vec),
            noise: run.noise,
            max_switches: MAX_SWITCHES,
        };
        options.check(space.b.len()).map_err(ScenarioError::Run)?;
        Ok(Self {
            plant,
            space,
            relay,
            options,
        })
    }

    /// Dead time and delay, s.
    pub fn lag(&self) -> f64 {
        self.plant.dead_time + self.relay.delay
    }

    /// What becomes of the loop in the end, however long that takes, from the file's start and in its noise.
    ///
    /// # Errors
    /// What is wrong with the noise.
    pub fn long_run(&self, prediction: &Prediction) -> Result<LongRunResult, SimulateError> {
        let run = LongRun {
            plant: &self.plant,
            space: &self.space,
            relay: &self.relay,
            initial: self.options.initial.as_ref(),
            push: self.push(),
            noise: self.options.noise,
        };
        run.run(prediction)
    }

    /// How long an ideal relay pushes from rest before it begins to look at the output, s.
    fn push(&self) -> f64 {
        let options = &self.options;
        options.step.unwrap_or(options.duration / SAMPLES)
    }

    /// Runs the loop as the file says. From rest an ideal relay without any delay would never leave
    /// its threshold; it begins after one step of upward push.
    pub fn run(&self) -> Result<Trajectory, SimulateError> {
        let mut options = self.options.clone();
        let stuck = self.relay.hysteresis == 0.0 && self.lag() == 0.0;
        if stuck && options.initial.is_none() {
            let push = self.push();
            let flow = Flow::single(&self.space, push);
            let pushed = flow.after(&[0.0; MAX_ORDER], &[self.relay.output(false)], push);
            options.initial = Some(flow.outer(&pushed));
        }
        run(&self.space, &self.relay, self.lag(), &options)
    }
}
