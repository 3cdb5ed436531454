//! A simulated run.

use serde::{Deserialize, Serialize};

use super::course::{Course, End, Place};
use super::servo::{Servo, ServoError};
use crate::message::{Message, says};
use crate::msg;
use crate::simulate::{Noise, Options, SimulateError};

/// A run from rest at 0, sampled.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct HuntingRun {
    /// Times, s.
    pub time: Vec<f64>,
    /// The controller's output, N m (or N).
    pub input: Vec<f64>,
    /// Position of the motor, rad (or m).
    pub position: Vec<f64>,
    /// Its velocity, rad/s (or m/s).
    pub velocity: Vec<f64>,
    /// Position behind the play, which the controller sees, without the noise.
    pub measured: Vec<f64>,
    /// Intervals in which the motor stuck, s.
    pub stuck: Vec<[f64; 2]>,
    /// Whether it was cut before its end: it ran away, or took too many steps.
    pub cut: bool,
}

/// Why a servo cannot be run.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum HuntingError {
    /// The servo.
    Servo(#[from] ServoError),
    /// Duration, step or noise.
    Run(#[from] SimulateError),
}

impl HuntingError {
    /// In words.
    pub fn message(&self) -> Message {
        match self {
            Self::Servo(error) => msg!("[servo]: {}", error),
            Self::Run(error) => msg!("[run]: {}", error),
        }
    }
}

says!(HuntingError);

/// At rest at 0, in the middle of the play.
pub(super) fn at_rest(servo: &Servo) -> (Place, f64) {
    let place = Place {
        x: 0.0,
        v: 0.0,
        integral: 0.0,
        w: 0.0,
        noise: 0.0,
    };
    let size = servo.reference.abs() + servo.half_gap;
    (place, if size > 0.0 { size } else { 1.0 })
}

/// Runs a servo for `duration` s with samples every `step` s; with noise on the position that the controller sees, if
/// there is some (the velocity that it sees is that of the motor).
///
/// # Errors
/// What of the servo, of these times or of the noise cannot be.
pub fn run(
    servo: &Servo,
    duration: f64,
    step: f64,
    noise: Option<Noise>,
) -> Result<HuntingRun, HuntingError> {
    servo.validate()?;
    let options = Options {
        noise,
        ..Options::new(duration, step)
    };
    options.check(0)?;
    let (place, size) = at_rest(servo);
    let mut course = Course::in_noise(servo, place, size, noise);
    let mut run = HuntingRun::default();
    let mut stuck_since = (course.way == 0.0).then_some(0.0);
    for k in 0..=(duration / step) as u64 {
        let until = k as f64 * step;
        while course.now < until {
            let end = course.advance(until);
            match (end, stuck_since) {
                (End::Standstill, None) if course.way == 0.0 => stuck_since = Some(course.now),
                (End::Breakaway, Some(since)) => {
                    run.stuck.push([since, course.now]);
                    stuck_since = None;
                }
                (End::Cut, _) => {
                    run.cut = true;
                    return Ok(run);
                }
                _ => {}
            }
        }
        let place = course.place;
        let asked = servo.asked(place.seen(), place.v, place.integral);
        run.time.push(until);
        run.input.push(servo.limited(asked));
        run.position.push(place.x);
        run.velocity.push(place.v);
        run.measured.push(place.w);
    }
    run.stuck
        .extend(stuck_since.map(|since| [since, course.now]));
    Ok(run)
}
