//! `ESPHome`: the log of `climate.pid.autotune`, at any log level.

use std::f64::consts::PI;

use super::lines::after;
use super::source::{Held, LogError, Source};
use crate::order::median;
use crate::tuning::measured::gains::Form;
use crate::tuning::measured::readings::{AmplitudeConvention, Readings};
use crate::tuning::measured::report::Settings;

/// Its noise band where the configuration does not set one.
const NOISEBAND: f64 = 0.25;

/// What it says of a doubtful test, and what that means.
const DOUBTS: [(&str, &str); 3] = [
    (
        "Frequency is not symmetrical",
        "ESPHome found the half periods of different length: 4d/(pi a) does not hold there.",
    ),
    (
        "oscillation amplitude",
        "ESPHome found the amplitude to change from cycle to cycle.",
    ),
    (
        "Setpoint changed",
        "The set point was changed during the test.",
    ),
];

pub(super) fn read(text: &str) -> Result<(Held, Settings), LogError> {
    let lines: Vec<&str> = text.lines().collect();
    let mut notes: Vec<String> = DOUBTS
        .iter()
        .filter(|d| lines.iter().any(|l| l.contains(d.0)))
        .map(|d| d.1.to_owned())
        .collect();
    let readings = match oscillation(&lines).or_else(|| of_gains(&lines)) {
        Some(readings) => readings,
        None if lines
            .iter()
            .any(|l| l.contains("Autotune is still running")) =>
        {
            return Err(LogError::Failed(
                "Autotune is still running!".to_owned(),
                "the log ends before the result: let it run until 'State: Succeeded!'",
            ));
        }
        None => return Err(LogError::Garbled(Source::Esphome)),
    };
    notes.push(format!(
        "The noise band was taken as {NOISEBAND}, ESPHome's default; give --hysteresis where the configuration sets another."
    ));
    let settings = Settings {
        form: Form::Esphome,
        full_scale: Some(1.0),
        target: None,
        notes,
    };
    Ok((Held::Readings(readings), settings))
}

/// Outputs of the relay, 0 and 1 where the log does not say them.
fn levels(lines: &[&str]) -> [f64; 2] {
    let outputs: Vec<f64> = lines
        .iter()
        .filter_map(|l| after(l, "Turning output to "))
        .map(|p| p / 100.0)
        .collect();
    let (low, high) = crate::order::range(&outputs);
    if high > low { [low, high] } else { [0.0, 1.0] }
}

/// The oscillation as the verbose log has it, with the half periods by the times at which it crosses the set point.
fn oscillation(lines: &[&str]) -> Option<Readings> {
    let last = |key: &str| lines.iter().rev().find_map(|l| after(l, key));
    let period = last("Oscillation Period:")?;
    let amplitude = last("Oscillation Amplitude:")?;
    Some(Readings {
        amplitude,
        convention: AmplitudeConvention::Half,
        period,
        levels: levels(lines),
        hysteresis: NOISEBAND.min(0.99 * amplitude),
        half_periods: half_periods(lines, period),
    })
}

/// Times with the output up and down, s, by the milliseconds between crossings.
fn half_periods(lines: &[&str], period: f64) -> Option<[f64; 2]> {
    let (mut up, mut down) = (Vec::new(), Vec::new());
    let mut output: Option<f64> = None;
    let [low, high] = levels(lines);
    for line in lines {
        // The stretch that ends is named before the relay turns.
        if let (Some(dt), Some(output)) = (after(line, "dt:"), output) {
            if output > 0.5 * (low + high) {
                &mut up
            } else {
                &mut down
            }
            .push(dt / 1000.0);
        }
        output = after(line, "Turning output to ")
            .map(|p| p / 100.0)
            .or(output);
    }
    if up.is_empty() || down.is_empty() {
        return None;
    }
    let (up, down) = (median(&mut up), median(&mut down));
    let scale = period / (up + down);
    Some([up * scale, down * scale])
}

/// From the gains of the Ziegler-Nichols rule, 0.6 Ku and 1.2 Ku/Tu, for an output from 0 to 1.
fn of_gains(lines: &[&str]) -> Option<Readings> {
    let own = |key: &str| {
        lines
            .iter()
            .rev()
            .filter(|l| !l.contains("kp:") || !l.contains("ki:"))
            .find_map(|l| after(l, key))
    };
    let (kp, ki) = (own("kp:")?, own("ki:")?);
    let gain = kp / 0.6;
    let [low, high] = levels(lines);
    let amplitude = 2.0 * (high - low) / (PI * gain);
    Some(Readings {
        amplitude,
        convention: AmplitudeConvention::Half,
        period: 1.2 * gain / ki,
        levels: [low, high],
        hysteresis: NOISEBAND.min(0.99 * amplitude),
        half_periods: None,
    })
}
