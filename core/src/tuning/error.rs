//! What can go wrong while a controller is tuned.

use serde::{Deserialize, Serialize};

use crate::plant::PlantError;
use crate::relay::RelayError;
use crate::uncertain::{brief, digits};

/// Why there is no controller.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, thiserror::Error)]
pub enum TuningError {
    /// The plant cannot be.
    #[error(transparent)]
    #[serde(skip)]
    Plant(#[from] PlantError),
    /// The relay cannot be.
    #[error(transparent)]
    #[serde(skip)]
    Relay(#[from] RelayError),
    /// A setting out of its range.
    #[error("{name} is {value}: it must be {range}")]
    Setting {
        /// Its name.
        name: String,
        /// What it was.
        value: f64,
        /// What it may be.
        range: String,
    },
    /// A rule that is not in the registry.
    #[error("there is no tuning rule `{0}`: take one of the registry's ids")]
    UnknownRule(String),
    /// The relay switches without end.
    #[error(
        "the relay chatters with hysteresis {hysteresis}: nothing limits its frequency, so there is no period to measure; give it more hysteresis"
    )]
    Chattering {
        /// Its hysteresis, in the unit of the output.
        hysteresis: f64,
    },
    /// A mode of the plant is so fast that the experiment would take millions of steps.
    #[error(
        "a part of the plant is far too fast for the rest, so that the experiment would take millions of steps; leave that part out"
    )]
    TooFast,
    /// The loop does not settle into a cycle with two switches a period.
    #[error(
        "no settled oscillation after {duration} s with relay gain {gain} and hysteresis {hysteresis}: more gain or less hysteresis may help"
    )]
    NoOscillation {
        /// How long the experiment lasted, s.
        duration: f64,
        /// Gain of the relay.
        gain: f64,
        /// Its hysteresis, in the unit of the output.
        hysteresis: f64,
    },
    /// An identification that needs different half periods.
    #[error(
        "the half periods {} s and {} s under asymmetry {asymmetry} tell nothing apart: the relay must push harder one way than the other",
        digits(*on, 4),
        digits(*off, 4)
    )]
    Symmetric {
        /// Time with the relay up, s.
        on: f64,
        /// Time with the relay down, s.
        off: f64,
        /// Asymmetry of the relay.
        asymmetry: f64,
    },
    /// The measured numbers do not fit a first-order lag or integrator with dead time.
    #[error(
        "no first-order model fits: {what} is {value:.4}, but a lag or an integrator with dead time has it {range}"
    )]
    NotFirstOrder {
        /// Which number.
        what: String,
        /// Its value.
        value: f64,
        /// What it would be.
        range: String,
    },
    /// A controller that cannot turn a point of the Nyquist curve as far as wanted.
    #[error(
        "the point must be turned by {turn:.4} rad: this controller turns it by more than {least:.4} and less than {most:.4} rad"
    )]
    OutOfReach {
        /// Wanted turn, rad.
        turn: f64,
        /// Least possible turn, rad.
        least: f64,
        /// Largest possible turn, rad.
        most: f64,
    },
    /// The gain adaptation did not reach the wanted amplitude.
    #[error(
        "the gain adaptation stands at gain {gain:.4} with a relative amplitude error of {} after {runs} relay runs: the wanted phase may be out of this plant's reach",
        brief(*error)
    )]
    NotConverged {
        /// Relay runs made.
        runs: usize,
        /// Last gain.
        gain: f64,
        /// Last error of the amplitude, relative.
        error: f64,
    },
    /// Numbers that left the range of floating point.
    #[error("{0} is not finite: the plant's numbers are too far apart to compute with")]
    NotFinite(String),
}

/// Checks that `value` is finite and `fits`.
pub(super) fn check(name: &str, value: f64, fits: bool, range: &str) -> Result<(), TuningError> {
    if value.is_finite() && fits {
        Ok(())
    } else {
        Err(TuningError::Setting {
            name: name.to_owned(),
            value,
            range: range.to_owned(),
        })
    }
}
