//! What does a loop do?

use super::course::Course;
use super::run::{OnOffLoop, OnOffRun};
use crate::plant::MAX_ORDER;
use crate::simulate::{MAX_SWITCHES, Noise, Options, SimulateError};

/// Runs a loop for `duration` s with samples every `step` s, or at every sample of a plant in discrete time; with noise
/// on the output that the controller sees, if there is some. What is recorded is the output without it.
///
/// # Errors
/// What is wrong with the loop, with these times or with the noise.
pub fn run(
    loop_: &OnOffLoop,
    duration: f64,
    step: f64,
    noise: Option<Noise>,
) -> Result<OnOffRun, SimulateError> {
    loop_.validate()?;
    let step = loop_.plant.sampling().unwrap_or(step);
    let options = Options {
        noise,
        ..Options::new(duration, step)
    };
    options.check(loop_.plant.order())?;
    let motion = loop_.plant.motion(0.25 * duration);
    let x = loop_
        .initial
        .as_ref()
        .map_or([0.0; MAX_ORDER], |x| motion.inner(x));
    let mut course = Course::new(loop_, &motion, x, MAX_SWITCHES);
    if let Some(noise) = noise {
        course.add_noise(noise);
    }
    course.record_every(step);
    course.run(duration);
    Ok(course.out)
}
