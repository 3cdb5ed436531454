//! What can go wrong while a controller is tuned.

use serde::{Deserialize, Serialize};

use crate::message::{Message, fixed, says};
use crate::msg;
use crate::plant::PlantError;
use crate::relay::RelayError;
use crate::uncertain::{brief, digits};

/// Why there is no controller.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, thiserror::Error)]
pub enum TuningError {
    /// The plant cannot be.
    #[serde(skip)]
    Plant(#[from] PlantError),
    /// The relay cannot be.
    #[serde(skip)]
    Relay(#[from] RelayError),
    /// A setting out of its range.
    Setting {
        /// Its name.
        name: Message,
        /// What it was.
        value: f64,
        /// What it may be.
        range: Message,
    },
    /// A rule that is not in the registry.
    UnknownRule(String),
    /// The relay switches without end.
    Chattering {
        /// Its hysteresis, in the unit of the output.
        hysteresis: f64,
    },
    /// A mode of the plant is so fast that the experiment would take millions of steps.
    TooFast,
    /// The loop does not settle into a cycle with two switches a period.
    NoOscillation {
        /// How long the experiment lasted, s.
        duration: f64,
        /// Gain of the relay.
        gain: f64,
        /// Its hysteresis, in the unit of the output.
        hysteresis: f64,
    },
    /// An identification that needs different half periods.
    Symmetric {
        /// Time with the relay up, s.
        on: f64,
        /// Time with the relay down, s.
        off: f64,
        /// Asymmetry of the relay.
        asymmetry: f64,
    },
    /// The measured numbers do not fit a first-order lag or integrator with dead time.
    NotFirstOrder {
        /// Which number.
        what: Message,
        /// Its value.
        value: f64,
        /// What it would be.
        range: Message,
    },
    /// A controller that cannot turn a point of the Nyquist curve as far as wanted.
    OutOfReach {
        /// Wanted turn, rad.
        turn: f64,
        /// Least possible turn, rad.
        least: f64,
        /// Largest possible turn, rad.
        most: f64,
    },
    /// The gain adaptation did not reach the wanted amplitude.
    NotConverged {
        /// Relay runs made.
        runs: usize,
        /// Last gain.
        gain: f64,
        /// Last error of the amplitude, relative.
        error: f64,
    },
    /// Numbers that left the range of floating point.
    NotFinite(Message),
}

impl TuningError {
    /// In words.
    pub fn message(&self) -> Message {
        match self {
            Self::Plant(error) => error.message(),
            Self::Relay(error) => error.message(),
            Self::Setting { name, value, range } => msg!(
                "{} is {}: it must be {}",
                name,
                value,
                range
            ),
            Self::UnknownRule(given) => msg!(
                "there is no tuning rule `{}`: take one of the registry's ids",
                Message::name(given)
            ),
            Self::Chattering { hysteresis } => msg!(
                "the relay chatters with hysteresis {}: nothing limits its frequency, so there is no period to \
                 measure; give it more hysteresis",
                hysteresis
            ),
            Self::TooFast => {
                "a part of the plant is far too fast for the rest, so that the experiment would take millions \
                 of steps; leave that part out"
                    .into()
            }
            Self::NoOscillation { duration, gain, hysteresis } => msg!(
                "no settled oscillation after {} s with relay gain {} and hysteresis {}: more gain or less \
                 hysteresis may help",
                duration,
                gain,
                hysteresis
            ),
            Self::Symmetric { on, off, asymmetry } => msg!(
                "the half periods {} s and {} s under asymmetry {} say nothing: the relay must push harder one way \
                 than the other",
                digits(*on, 4),
                digits(*off, 4),
                asymmetry
            ),
            Self::NotFirstOrder { what, value, range } => msg!(
                "no first-order model fits: {} is {}, but a lag or an integrator with dead time has it {}",
                what,
                fixed(*value, 4),
                range
            ),
            Self::OutOfReach { turn, least, most } => msg!(
                "the point must be turned by {} rad: this controller turns it by more than {} and less than {} \
                 rad",
                fixed(*turn, 4),
                fixed(*least, 4),
                fixed(*most, 4)
            ),
            Self::NotConverged { runs, gain, error } => msg!(
                "the gain adaptation has reached gain {} with a relative amplitude error of {} after {} relay runs: \
                 the wanted phase may be out of this plant's reach",
                fixed(*gain, 4),
                brief(*error),
                runs
            ),
            Self::NotFinite(given) => msg!(
                "{} is not finite: the plant's numbers are too far apart to compute with",
                given
            ),
        }
    }
}

says!(TuningError);

/// Checks that `value` is finite and `fits`.
pub(super) fn check(
    name: &'static str,
    value: f64,
    fits: bool,
    range: impl Into<Message>,
) -> Result<(), TuningError> {
    if value.is_finite() && fits {
        Ok(())
    } else {
        Err(TuningError::Setting {
            name: name.into(),
            value,
            range: range.into(),
        })
    }
}
