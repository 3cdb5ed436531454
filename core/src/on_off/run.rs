//! A loop, and what a run of it records.

use nalgebra::DVector;

use super::plant::OnOffPlant;
use super::relay::{OnOffRelay, Position};
use crate::simulate::{Cut, SimulateError};

/// An on-off controller around a plant.
#[derive(Clone, Debug, PartialEq)]
pub struct OnOffLoop {
    /// The plant.
    pub plant: OnOffPlant,
    /// The controller.
    pub relay: OnOffRelay,
    /// State at the start; at rest if `None`.
    pub initial: Option<DVector<f64>>,
}

/// Why the controller switched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cause {
    /// The output rose through a threshold.
    Rising,
    /// It fell through one.
    Falling,
    /// The shortest time in a position was over, and the output beyond a threshold.
    HoldEnd,
    /// It was seen beyond a threshold at a sampling instant.
    Sample,
}

/// A switch of the controller.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Switch {
    /// When, s.
    pub time: f64,
    /// To which position.
    pub to: Position,
    /// Why.
    pub cause: Cause,
    /// Smallest and largest output since the switch before, or since the start.
    pub swing: [f64; 2],
}

/// A simulated run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OnOffRun {
    /// Times of the samples, s.
    pub time: Vec<f64>,
    /// Output there.
    pub output: Vec<f64>,
    /// Acting input as `[t, u]`, at the start and at each change.
    pub input: Vec<[f64; 2]>,
    /// The controller's switches.
    pub switches: Vec<Switch>,
    /// Why the run was cut before its end, if it was.
    pub cut: Option<Cut>,
}

impl OnOffLoop {
    /// Checks plant, controller and start.
    ///
    /// # Errors
    /// What is wrong.
    pub fn validate(&self) -> Result<(), SimulateError> {
        self.plant.validate()?;
        self.relay.validate()?;
        if let (Some(plant), Some(relay)) = (self.plant.sampling(), self.relay.sampling)
            && plant != relay
        {
            return Err(SimulateError::Option {
                name: "sampling of the relay",
                value: relay,
                range: "that of the plant, or left out",
            });
        }
        let order = self.plant.order();
        match &self.initial {
            Some(x) if x.len() != order => Err(SimulateError::InitialState {
                found: x.len(),
                order,
            }),
            Some(x) if x.iter().any(|v| !v.is_finite()) => Err(SimulateError::Option {
                name: "initial state",
                value: f64::NAN,
                range: "a number",
            }),
            _ => Ok(()),
        }
    }

    /// Dead time and delay, s.
    pub fn lag(&self) -> f64 {
        self.plant.dead_time() + self.relay.relay.delay
    }

    /// Time from one look at the output to the next, s.
    pub fn clock(&self) -> Option<f64> {
        self.plant.sampling().or(self.relay.sampling)
    }
}
