//! Whose log it is, what it holds, and why it tells nothing.

use serde::{Deserialize, Serialize};

use crate::message::{Message, says};
use crate::msg;
use crate::tuning::measured::readings::Readings;
use crate::tuning::measured::record::{Record, RecordError};

/// Whose log it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Source {
    /// Klipper's `PID_CALIBRATE`: console, `klippy.log` or the file of `WRITE_FILE=1`.
    Klipper,
    /// Marlin's `M303`.
    Marlin,
    /// `ESPHome`'s `climate.pid.autotune`.
    Esphome,
    /// Mycodo's PID autotune, and thermostats of Home Assistant with the same tuner.
    Mycodo,
}

impl Source {
    /// As it is called in sentences.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Klipper => "Klipper PID_CALIBRATE",
            Self::Marlin => "Marlin M303",
            Self::Esphome => "ESPHome autotune",
            Self::Mycodo => "Mycodo or Home Assistant autotune",
        }
    }

    /// What its log must have at least.
    pub(super) const fn needs(self) -> &'static str {
        match self {
            Self::Klipper => {
                "the lines 'pwm: ...' with temperatures, 'Stats ...' with the heater, 'Autotune: raw=...', or \
                 'pid_Kp=... pid_Ki=... pid_Kd=...'"
            }
            Self::Marlin => {
                "a line with 'bias: ... d: ... min: ... max: ...' followed by 'Ku: ... Tu: ...'"
            }
            Self::Esphome => "the lines 'kp: ...' and 'ki: ...', or those of the oscillation",
            Self::Mycodo => {
                "the lines 'found peak: ...' and 'switched state: ...' with their times, or the gains of the rule \
                 ziegler-nichols"
            }
        }
    }
}

/// Why a log tells nothing.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LogError {
    /// Recognised, but what is needed is not whole.
    Garbled(Source),
    /// The tuner had not come to its end.
    Unfinished(&'static str),
    /// Levels were given where the log has them, or there is none.
    Levels,
    /// The tuner gave up.
    Failed(String, &'static str),
    /// It was read, but its numbers are impossible.
    Impossible {
        /// Whose log it is.
        log: Source,
        /// What is wrong.
        error: RecordError,
    },
    /// The same of a record.
    Numbers(#[from] RecordError),
}

impl LogError {
    /// In words.
    pub fn message(&self) -> Message {
        match self {
            Self::Garbled(given) => msg!(
                "this looks like a log of {}, but no cycle can be read from it: expected {}",
                given.name(),
                given.needs()
            ),
            Self::Unfinished(given) => msg!("the log ends before the result: {}", given),
            Self::Levels => {
                "levels are for numbers, and for a log that does not give them: leave --levels out"
                    .into()
            }
            Self::Failed(first, second) => {
                msg!(
                    "the tuner gave up: '{}'; {}",
                    Message::name(first.clone()),
                    second
                )
            }
            Self::Impossible { log, error } => msg!(
                "this looks like a log of {}, but it cannot be used: {}",
                log.name(),
                error
            ),
            Self::Numbers(error) => msg!("{}", error),
        }
    }
}

says!(LogError);

/// Where the levels of the input come from, and what else follows from them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Levels {
    /// The log tells them.
    #[default]
    Told,
    /// They were taken as its owner has them where nothing else is set.
    Assumed,
    /// The same, and the amplitude was computed from a gain in proportion to the upper one.
    AssumedByGain,
}

/// What a log holds.
#[derive(Clone, Debug, PartialEq)]
pub enum Held {
    /// Temperatures and power in time.
    Record(Record),
    /// What the tuner read off the cycle.
    Readings(Readings),
}
