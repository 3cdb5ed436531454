//! Everything about one on-off loop, for drawing: prediction beside simulation.

use num_complex::Complex;
use serde::{Deserialize, Serialize};

use super::cycle::{OnOffCycle, settled};
use super::describing_function::{Balance, curves, describing_function};
use super::discrete::DiscretePlant;
use super::plant::OnOffPlant;
use super::relay::{OnOffRelay, Position};
use super::run::OnOffLoop;
use super::simulation::run;
use crate::plant::{StateSpace, TransferFunction};
use crate::simulate::SimulateError;

/// A plant as it is given.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum GivenPlant {
    /// In continuous time.
    Continuous(TransferFunction),
    /// In discrete time: numerator and denominator in `z`, highest power first, and the sampling time in s.
    Discrete(Vec<f64>, Vec<f64>, f64),
}

/// An on-off controller around a plant, as a plain value.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct OnOffInput {
    /// The plant.
    pub plant: GivenPlant,
    /// The controller.
    pub relay: OnOffRelay,
    /// Output at the start, where it stands still, in its unit.
    pub start: f64,
}

/// What there is to see.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct OnOffData {
    /// Times of the simulation, s.
    pub time: Vec<f64>,
    /// Output.
    pub output: Vec<f64>,
    /// Acting input, `[t, u]` at the corners of its steps.
    pub input: Vec<[f64; 2]>,
    /// The exact cycle.
    pub exact: Option<OnOffCycle>,
    /// The cycle to which the simulation comes.
    pub simulated: Option<OnOffCycle>,
    /// The position in which the controller stays for ever, where it does.
    pub rests: Option<Position>,
    /// The harmonic balances; `None` where the first harmonic is not known.
    pub describing_function: Option<Vec<Balance>>,
    /// Nyquist curve with all delays, as real and imaginary parts; empty where the two curves do not tell.
    pub nyquist: Vec<[f64; 2]>,
    /// `-1/N(A)`, the same way.
    pub inverse_df: Vec<[f64; 2]>,
    /// Where they meet.
    pub meetings: Vec<[f64; 2]>,
}

/// Switches that are shown, and periods at least; or typical times where it rests or does not repeat.
const SWITCHES: f64 = 24.0;
const PERIODS: f64 = 2.0;
const TIMES: f64 = 40.0;

/// Longest run, in typical times of the loop: a fast cycle far from its start is not followed to it.
const LONGEST: f64 = 400.0;

/// Samples of a run.
const SAMPLES: f64 = 2000.0;

impl OnOffInput {
    /// The same of a loop. Of a start that moves only the output is kept.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn of(on_off: &OnOffLoop) -> Result<Self, SimulateError> {
        on_off.validate()?;
        let (plant, c) = match &on_off.plant {
            OnOffPlant::Continuous(plant, space) => {
                (GivenPlant::Continuous(plant.clone()), &space.c)
            }
            OnOffPlant::Discrete(plant) => {
                // The same matrices stand for it, whether the variable is s or z.
                let space = StateSpace {
                    a: plant.a.clone(),
                    b: plant.b.clone(),
                    c: plant.c.clone(),
                };
                let function = space.transfer_function(0.0)?;
                let given =
                    GivenPlant::Discrete(function.numerator, function.denominator, plant.sampling);
                (given, &plant.c)
            }
        };
        Ok(Self {
            plant,
            relay: on_off.relay,
            start: on_off.initial.as_ref().map_or(0.0, |x| c.dot(x)),
        })
    }

    /// The loop with its start.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn on_off_loop(&self) -> Result<OnOffLoop, SimulateError> {
        let plant = match &self.plant {
            GivenPlant::Continuous(plant) => {
                plant.validate()?;
                OnOffPlant::Continuous(plant.clone(), plant.state_space())
            }
            GivenPlant::Discrete(numerator, denominator, sampling) => {
                OnOffPlant::Discrete(DiscretePlant::new(numerator, denominator, *sampling)?)
            }
        };
        let initial = (self.start != 0.0)
            .then(|| plant.standing_at(self.start))
            .flatten();
        let on_off = OnOffLoop {
            plant,
            relay: self.relay,
            initial,
        };
        on_off.validate()?;
        Ok(on_off)
    }
}

/// Computes everything; the same input gives the same data.
///
/// # Errors
/// What is wrong with the loop.
pub fn view(input: &OnOffInput) -> Result<OnOffData, SimulateError> {
    let on_off = input.on_off_loop()?;
    let settled = settled(&on_off)?;
    let relay = &on_off.relay;
    let typical = on_off.plant.typical_time() + on_off.lag() + relay.min_on + relay.min_off;
    let cycle = settled.exact.as_ref().or(settled.simulated.as_ref());
    let duration = cycle.map_or(TIMES * typical, |c| {
        c.period * PERIODS.max(SWITCHES / c.positions.len() as f64)
    });
    let duration = duration.min(LONGEST * typical);
    let run = run(&on_off, duration, duration / SAMPLES, None)?;
    let describing_function = describing_function(&on_off);
    let drawn = curves(&on_off, describing_function.as_deref().unwrap_or_default());
    Ok(OnOffData {
        input: crate::curve::corners(&run.input, duration),
        time: run.time,
        output: run.output,
        exact: settled.exact,
        simulated: settled.simulated,
        rests: settled.rests,
        describing_function,
        nyquist: drawn.nyquist.into_iter().map(pair).collect(),
        inverse_df: drawn.inverse.into_iter().map(pair).collect(),
        meetings: drawn.meetings.into_iter().map(pair).collect(),
    })
}

fn pair(value: Complex<f64>) -> [f64; 2] {
    [value.re, value.im]
}
