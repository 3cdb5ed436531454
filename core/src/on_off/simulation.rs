//! What does a loop do?

use super::course::Course;
use super::run::{OnOffLoop, OnOffRun};
use crate::plant::MAX_ORDER;
use crate::simulate::{MAX_SAMPLES, MAX_SWITCHES, SimulateError};

/// Runs a loop for `duration` s with samples every `step` s, or at every sample of a plant in discrete time.
///
/// # Errors
/// What is wrong with the loop or with these times.
pub fn run(loop_: &OnOffLoop, duration: f64, step: f64) -> Result<OnOffRun, SimulateError> {
    loop_.validate()?;
    let step = loop_.plant.sampling().unwrap_or(step);
    let times = [("duration", duration), ("step", step)];
    for (name, value) in times {
        if !(value.is_finite() && value > 0.0) {
            let range = "above 0 s";
            return Err(SimulateError::Option { name, value, range });
        }
    }
    if duration / step > MAX_SAMPLES as f64 {
        return Err(SimulateError::Option {
            name: "number of samples",
            value: duration / step,
            range: "at most 10,000,000: a shorter duration or a longer step",
        });
    }
    let motion = loop_.plant.motion(0.25 * duration);
    let x = loop_
        .initial
        .as_ref()
        .map_or([0.0; MAX_ORDER], |x| motion.inner(x));
    let mut course = Course::new(loop_, &motion, x, MAX_SWITCHES);
    course.record_every(step);
    course.run(duration);
    Ok(course.out)
}
