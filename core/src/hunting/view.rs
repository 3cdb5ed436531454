//! Everything about one servo, for drawing: prediction beside simulation.

use serde::{Deserialize, Serialize};

use super::cycle::{HuntingCycle, settled};
use super::describing_function::{HuntingBalance, describing_function};
use super::run::{HuntingError, HuntingRun, run};
use super::servo::Servo;

/// What there is to see.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct HuntingData {
    /// The run from rest at 0.
    pub run: HuntingRun,
    /// The exact cycle.
    pub exact: Option<HuntingCycle>,
    /// The cycle to which the simulation comes.
    pub simulated: Option<HuntingCycle>,
    /// Distance from the reference at which it comes to rest, where it does, rad (or m).
    pub error_at_rest: Option<f64>,
    /// It runs away.
    pub unbounded: bool,
    /// The harmonic balances.
    pub describing_function: Vec<HuntingBalance>,
}

/// Periods that are shown, and typical times before them.
const PERIODS: f64 = 6.0;
const TIMES: f64 = 60.0;

/// Longest run, in typical times: more is not seen in a picture.
const LONGEST: f64 = 2000.0;

/// Samples of a run.
const SAMPLES: f64 = 3000.0;

/// Computes everything; the same servo gives the same data.
///
/// # Errors
/// What of the servo cannot be.
pub fn view(servo: &Servo) -> Result<HuntingData, HuntingError> {
    let settled = settled(servo)?;
    let typical = servo.typical_time();
    let cycle = settled.exact.as_ref().or(settled.simulated.as_ref());
    let periods = cycle.map_or(0.0, |c| PERIODS * c.period);
    let duration = (TIMES * typical + periods).min(LONGEST * typical);
    Ok(HuntingData {
        run: run(servo, duration, duration / SAMPLES, None)?,
        exact: settled.exact,
        simulated: settled.simulated,
        error_at_rest: settled.error_at_rest,
        unbounded: settled.unbounded,
        describing_function: describing_function(servo),
    })
}
