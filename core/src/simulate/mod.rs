//! What happens? Linear plants under relays, from switch to switch by exact flows.
//!
//! [`simulate`] runs one loop; [`run`] takes all options, and [`run_multivariable`] several relays at
//! once. Switching instants are roots of series that carry the output over whole steps (see
//! [`Trajectory`] for what is recorded).

mod engine;
pub(crate) mod flow;
mod noise;
pub(crate) mod series;
mod sliding;
mod trajectory;

use nalgebra::DVector;

pub use engine::MAX_STEPS;
pub(crate) use engine::{Change, Engine};
pub(crate) use flow::{Flow, State};
pub use noise::Noise;
pub(crate) use noise::NoiseAlong;
pub use trajectory::{Cut, Trajectory};

use crate::message::{Message, says};
use crate::msg;
use crate::plant::{MAX_ORDER, Multivariable, PlantError, StateSpace};
use crate::relay::{Relay, RelayError};
pub(crate) use sliding::Sliding;

/// Switches after which a run ends, as chattering or as too long, unless the caller says otherwise.
pub const MAX_SWITCHES: usize = 20_000;

/// Samples that a run may have.
pub const MAX_SAMPLES: usize = 10_000_000;

/// How to run a loop.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Duration, s; above 0.
    pub duration: f64,
    /// Distance of samples, s; `None` for no samples, only events.
    pub step: Option<f64>,
    /// State at the start; at rest if `None`.
    pub initial: Option<DVector<f64>>,
    /// Measurement noise.
    pub noise: Option<Noise>,
    /// Switches after which the run ends.
    pub max_switches: usize,
}

impl Options {
    /// A run from rest over `duration` s with samples every `step` s.
    pub fn new(duration: f64, step: f64) -> Self {
        Self {
            duration,
            step: Some(step),
            initial: None,
            noise: None,
            max_switches: MAX_SWITCHES,
        }
    }

    pub(crate) fn check(&self, order: usize) -> Result<(), SimulateError> {
        fits("duration", self.duration, self.duration > 0.0, "above 0 s")?;
        if let Some(step) = self.step {
            fits("step", step, step > 0.0, "above 0 s")?;
            fits(
                "number of samples",
                self.duration / step,
                self.duration / step <= MAX_SAMPLES as f64,
                "at most 10,000,000: a shorter duration or a longer step",
            )?;
        }
        if let Some(noise) = self.noise {
            noise.check(self.duration)?;
        }
        if let Some(x) = &self.initial {
            if x.len() != order {
                return Err(SimulateError::InitialState {
                    found: x.len(),
                    order,
                });
            }
            for value in x.iter() {
                fits("initial state", *value, true, "a number")?;
            }
        }
        Ok(())
    }
}

impl Noise {
    /// Checks it for a run of `duration` s.
    pub(crate) fn check(self, duration: f64) -> Result<(), SimulateError> {
        let Self {
            std_dev, interval, ..
        } = self;
        fits("noise std_dev", std_dev, std_dev >= 0.0, "0 or more")?;
        fits("noise interval", interval, interval > 0.0, "above 0 s")?;
        let values = duration / interval;
        fits(
            "number of noise values",
            values,
            values <= MAX_SAMPLES as f64,
            "at most 10,000,000: a shorter duration or a longer interval",
        )
    }
}

/// An option that is a number and what it must be, or the error that says so.
fn fits(
    name: &'static str,
    value: f64,
    fits: bool,
    range: &'static str,
) -> Result<(), SimulateError> {
    if value.is_finite() && fits {
        Ok(())
    } else {
        Err(SimulateError::Option { name, value, range })
    }
}

/// Why a loop cannot be run.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SimulateError {
    /// The plant.
    Plant(#[from] PlantError),
    /// The relay.
    Relay(#[from] RelayError),
    /// An option out of range.
    Option {
        /// Which.
        name: &'static str,
        /// Its value.
        value: f64,
        /// What would be right.
        range: &'static str,
    },
    /// An initial state of the wrong size.
    InitialState {
        /// Values given.
        found: usize,
        /// Values needed.
        order: usize,
    },
    /// The number of relays is not that of the plant's channels.
    Relays {
        /// Relays given.
        relays: usize,
        /// Delays given.
        lags: usize,
        /// Channels of the plant.
        channels: usize,
    },
}

impl SimulateError {
    /// In words.
    pub fn message(&self) -> Message {
        match self {
            Self::Plant(error) => error.message(),
            Self::Relay(error) => error.message(),
            Self::Option { name, value, range } => {
                msg!("{} is {}: it must be {}", name, value, range)
            }
            Self::InitialState { found, order } => msg!(
                "the initial state has {} values: a plant of order {} needs {}",
                found,
                order,
                order
            ),
            Self::Relays {
                relays,
                lags,
                channels,
            } => msg!(
                "there are {} relays and {} delays for a plant with {} inputs and outputs",
                relays,
                lags,
                channels
            ),
        }
    }
}

says!(SimulateError);

/// Runs `plant` under `relay`, whose output acts `lag` s (relay's delay and dead time) after a switch.
///
/// From rest `h` is -1, so that the relay pushes up, unless the initial state says otherwise. An ideal
/// relay that starts at rest at its own threshold stays there: give it an initial state.
pub fn run(
    plant: &StateSpace,
    relay: &Relay,
    lag: f64,
    options: &Options,
) -> Result<Trajectory, SimulateError> {
    plant.validate()?;
    relay.validate()?;
    options.check(plant.b.len())?;
    if !(lag.is_finite() && lag >= 0.0) {
        return Err(PlantError::DeadTime(lag).into());
    }
    let flow = Flow::single(plant, longest_step(options.duration));
    let x = options
        .initial
        .as_ref()
        .map_or([0.0; MAX_ORDER], |x| flow.inner(x));
    let mut engine = Engine::new(&flow, &[*relay], &[lag], x, options.max_switches);
    if relay.hysteresis == 0.0 && lag == 0.0 {
        engine.allow_sliding(Sliding::new(plant, &flow, options.duration));
    }
    prepare(&mut engine, options);
    engine.run(options.duration);
    Ok(engine.finish().into_iter().next().unwrap_or_default())
}

/// Runs a square plant with one relay per output: relay `i` sees output `i` only and drives input `i`,
/// `lags[i]` s after its switches. One trajectory per relay. Sliding is not resolved: a relay that
/// would slide ends the run as chattering.
pub fn run_multivariable(
    plant: &Multivariable,
    relays: &[Relay],
    lags: &[f64],
    options: &Options,
) -> Result<Vec<Trajectory>, SimulateError> {
    plant.validate()?;
    let channels = plant.c.nrows();
    if relays.len() != channels || lags.len() != channels {
        return Err(SimulateError::Relays {
            relays: relays.len(),
            lags: lags.len(),
            channels,
        });
    }
    for relay in relays {
        relay.validate()?;
    }
    for lag in lags {
        if !(lag.is_finite() && *lag >= 0.0) {
            return Err(PlantError::DeadTime(*lag).into());
        }
    }
    options.check(plant.a.nrows())?;
    let flow = Flow::new(&plant.a, &plant.b, &plant.c, longest_step(options.duration));
    let x = options
        .initial
        .as_ref()
        .map_or([0.0; MAX_ORDER], |x| flow.inner(x));
    let mut engine = Engine::new(&flow, relays, lags, x, options.max_switches);
    prepare(&mut engine, options);
    engine.run(options.duration);
    Ok(engine.finish())
}

fn prepare(engine: &mut Engine<'_>, options: &Options) {
    if let Some(noise) = options.noise {
        engine.add_noise(noise);
    }
    if let Some(step) = options.step {
        engine.sample_every(step);
    }
}

/// Steps longer than this share of a run save nothing.
fn longest_step(duration: f64) -> f64 {
    0.25 * duration
}

/// Runs `plant` (without its dead time) under `relay`, whose output acts `lag` seconds after a switch.
///
/// Starts from rest after one `step` of upward push, since an ideal relay would never leave the
/// origin; `steps` samples `step` seconds apart. A plant or relay that is not valid gives an empty run.
pub fn simulate(
    plant: &StateSpace,
    relay: &Relay,
    lag: f64,
    step: f64,
    steps: usize,
) -> Trajectory {
    let valid = plant.validate().is_ok() && relay.validate().is_ok();
    let times = step.is_finite() && step > 0.0 && lag.is_finite() && lag >= 0.0;
    if !(valid && times) {
        return Trajectory::default();
    }
    let duration = step * steps as f64;
    let flow = Flow::single(plant, longest_step(duration).min(MAX_STEPS_AT_ONCE * step));
    let push = [relay.output(false)];
    let x = flow.after(&[0.0; MAX_ORDER], &push, step);
    let mut engine = Engine::new(&flow, &[*relay], &[lag], x, MAX_SWITCHES);
    if relay.hysteresis == 0.0 && lag == 0.0 {
        engine.allow_sliding(Sliding::new(plant, &flow, duration));
    }
    engine.sample_every(step);
    engine.run(duration);
    engine.finish().into_iter().next().unwrap_or_default()
}

/// Samples that one step of [`simulate`] spans at most: about half a period as its callers sample.
const MAX_STEPS_AT_ONCE: f64 = 64.0;
