//! Logs of auto-tuners in firmwares and home controllers, after their public documentation.
//!
//! Where a log holds the temperatures and the heater's power, it is a `Record`; else what its tuner read off the cycle
//! is taken, never the gains that it computed, but for where nothing else is in it.

mod esphome;
mod klipper;
mod lines;
mod marlin;
mod mycodo;
mod source;

use super::gains::Form;
use super::number::number;
use super::readings::tune_readings;
use super::report::{MeasuredTuning, Settings, tune_record};
use super::wishes::Wishes;
use crate::msg;

pub use source::{Held, Levels, LogError, Source};

/// A log that was read.
#[derive(Clone, Debug, PartialEq)]
pub struct Log {
    /// Whose.
    pub source: Source,
    /// What it holds.
    pub held: Held,
    /// Where its levels come from.
    pub levels: Levels,
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
    if has(&[
        "found peak:",
        "state: relay step",
        "pid_autotune",
        "rule: ziegler-nichols",
        mycodo::THERMOSTAT,
    ]) {
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
    Some(found.map(|(held, levels, settings)| Log {
        source,
        held,
        levels,
        settings,
    }))
}

impl Log {
    /// What the user says beats what a log does not know.
    ///
    /// # Errors
    /// [`LogError::Levels`] where levels are given that the log tells itself.
    pub fn with(mut self, wishes: &Wishes) -> Result<Self, LogError> {
        match (&mut self.held, wishes.levels) {
            (Held::Readings(readings), Some(levels)) if self.levels != Levels::Told => {
                if self.levels == Levels::AssumedByGain {
                    readings.amplitude *= (levels[1] / readings.levels[1]).abs();
                }
                readings.levels = levels;
                self.levels = Levels::Told;
            }
            (_, Some(_)) => return Err(LogError::Levels),
            _ => {}
        }
        if let (Held::Readings(readings), Some(hysteresis)) = (&mut self.held, wishes.hysteresis) {
            readings.hysteresis = hysteresis;
        }
        self.settings.hysteresis = wishes.hysteresis.or(self.settings.hysteresis);
        self.settings.full_scale = wishes.full_scale.or(self.settings.full_scale);
        self.settings.target = wishes.target.or(self.settings.target);
        Ok(self)
    }

    /// What it tells, with gains in `form`, or in that of its owner.
    ///
    /// # Errors
    /// Numbers that cannot be.
    pub fn tune(&self, form: Option<Form>) -> Result<MeasuredTuning, LogError> {
        let mut settings = Settings {
            form: form.unwrap_or(self.settings.form),
            ..self.settings.clone()
        };
        if let (Held::Readings(readings), true) = (&self.held, self.levels != Levels::Told) {
            let [low, high] = readings.levels.map(number);
            settings.notes.push(msg!(
                "The log does not give the levels of the input: {} and {} were assumed, and every gain is in \
                 proportion to them; give --levels if they are different.",
                low,
                high
            ));
        }
        let found = match &self.held {
            Held::Record(record) => tune_record(record, &settings),
            Held::Readings(readings) => tune_readings(readings, &settings),
        };
        found.map_err(|error| LogError::Impossible {
            log: self.source,
            error,
        })
    }
}
