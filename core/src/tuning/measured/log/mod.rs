//! Logs of auto-tuners in firmwares and home controllers, after their public documentation.
//!
//! Where a log holds the temperatures and the heater's power, it is a [`Record`]; else what its tuner read off the cycle
//! is taken, never the gains that it computed, but for where nothing else is in it.

mod esphome;
mod klipper;
mod lines;
mod marlin;
mod mycodo;

use serde::{Deserialize, Serialize};

use super::gains::Form;
use super::readings::{Readings, tune_readings};
use super::record::{Record, RecordError};
use super::report::{MeasuredTuning, Settings, tune_record};

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
    const fn needs(self) -> &'static str {
        match self {
            Self::Klipper => {
                "the lines 'pwm: ...' with temperatures, 'Stats ...' with the heater, 'Autotune: raw=...', or 'pid_Kp=... \
                 pid_Ki=... pid_Kd=...'"
            }
            Self::Marlin => {
                "a line with 'bias: ... d: ... min: ... max: ...' followed by 'Ku: ... Tu: ...'"
            }
            Self::Esphome => "the lines 'kp: ...' and 'ki: ...', or those of the oscillation",
            Self::Mycodo => {
                "the lines 'found peak: ...' and 'switched state: ...' with their times"
            }
        }
    }
}

/// Why a log tells nothing.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LogError {
    /// Recognised, but what is needed is not whole.
    #[error("this looks like a log of {name}, but no cycle can be read from it: expected {needs}", name = .0.name(), needs = .0.needs())]
    Garbled(Source),
    /// The tuner gave up.
    #[error("the tuner gave up: '{0}'; {1}")]
    Failed(String, &'static str),
    /// It was read, but its numbers cannot be.
    #[error("{0}")]
    Numbers(#[from] RecordError),
}

/// What a log holds.
#[derive(Clone, Debug, PartialEq)]
pub enum Held {
    /// Temperatures and power in time.
    Record(Record),
    /// What the tuner read off the cycle.
    Readings(Readings),
}

/// A log that was read.
#[derive(Clone, Debug, PartialEq)]
pub struct Log {
    /// Whose.
    pub source: Source,
    /// What it holds.
    pub held: Held,
    /// Form in which its owner wants gains, full scale of the input, target, and what is to be said of it.
    pub settings: Settings,
}

/// Whose log a text is, if it is one.
pub fn recognise(text: &str) -> Option<Source> {
    let has = |words: &[&str]| words.iter().any(|w| text.contains(w));
    if has(&["PID_CALIBRATE", "pid_Kp", "Autotune: raw="])
        || klipper::is_write_file(text)
        || klipper::has_stats(text)
    {
        return Some(Source::Klipper);
    }
    if has(&["found peak:", "switched state: relay", "pid_autotune"]) {
        return Some(Source::Mycodo);
    }
    if has(&[
        "pid.autotune",
        "pid.climate",
        "PID Autotune finished!\n  ",
        "Oscillation Period:",
        "Ziegler-Nichols PID",
    ]) {
        return Some(Source::Esphome);
    }
    has(&["PID Autotune", "M303", " bias:"]).then_some(Source::Marlin)
}

/// Reads a log.
///
/// # Errors
/// One sentence that says what was expected.
pub fn read(name: &str, text: &str) -> Option<Result<Log, LogError>> {
    let source = recognise(text)?;
    let found = match source {
        Source::Klipper => klipper::read(name, text),
        Source::Marlin => marlin::read(name, text),
        Source::Esphome => esphome::read(text),
        Source::Mycodo => mycodo::read(text),
    };
    Some(found.map(|(held, settings)| Log {
        source,
        held,
        settings,
    }))
}

impl Log {
    /// What it tells, with gains in `form`, or in that of its owner.
    ///
    /// # Errors
    /// Numbers that cannot be.
    pub fn tune(&self, form: Option<Form>) -> Result<MeasuredTuning, LogError> {
        let settings = Settings {
            form: form.unwrap_or(self.settings.form),
            ..self.settings.clone()
        };
        Ok(match &self.held {
            Held::Record(record) => tune_record(record, &settings)?,
            Held::Readings(readings) => tune_readings(readings, &settings)?,
        })
    }
}
