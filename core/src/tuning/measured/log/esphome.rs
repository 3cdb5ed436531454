//! `ESPHome`: the log of `climate.pid.autotune`, at any log level.

use std::f64::consts::PI;

use super::lines::{after, time, unwrapped};
use super::source::{Held, Levels, LogError, Source};
use crate::message::Message;
use crate::msg;
use crate::order::median;
use crate::tuning::measured::gains::Form;
use crate::tuning::measured::readings::{AmplitudeConvention, Readings};
use crate::tuning::measured::report::Settings;

/// Its noise band where the configuration does not set one.
const NOISEBAND: f64 = 0.25;

/// What it says of half periods of which the shorter lasts less than 0.66 of the longer.
const NOT_SYMMETRICAL: &str = "Frequency is not symmetrical";

/// What it says of a doubtful test, and what that means.
const DOUBTS: [(&str, &str); 3] = [
    (
        NOT_SYMMETRICAL,
        "ESPHome found the half periods of different length: 4d/(πa) does not hold there.",
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

pub(super) fn read(text: &str) -> Result<(Held, Levels, Settings), LogError> {
    let lines: Vec<&str> = text.lines().collect();
    let mut notes: Vec<Message> = DOUBTS
        .iter()
        .filter(|d| lines.iter().any(|l| l.contains(d.0)))
        .map(|d| d.1.into())
        .collect();
    let told = if relay(&lines).is_some() {
        [Levels::Told; 2]
    } else {
        [Levels::Assumed, Levels::AssumedByGain]
    };
    let oscillation = oscillation(&lines).map(|r| (r, told[0]));
    let (readings, told) = match oscillation.or_else(|| Some((of_gains(&lines)?, told[1]))) {
        Some(found) => found,
        None if lines
            .iter()
            .any(|l| l.contains("Autotune is still running")) =>
        {
            return Err(LogError::Unfinished(
                "the autotune of ESPHome is still running; let it run until 'State: Succeeded!'",
            ));
        }
        None => return Err(LogError::Garbled(Source::Esphome)),
    };
    notes.push(msg!(
        "The noise band was taken as {}, ESPHome's default; give --hysteresis where the configuration sets another.",
        NOISEBAND
    ));
    let settings = Settings {
        form: Form::Esphome,
        full_scale: Some(1.0),
        target: None,
        hysteresis: None,
        notes,
    };
    Ok((Held::Readings(readings), told, settings))
}

/// Whether it found the half periods of different length.
fn unequal(lines: &[&str]) -> bool {
    lines.iter().any(|l| l.contains(NOT_SYMMETRICAL))
}

/// Outputs of the relay, 0 and 1 where the log does not say them.
fn levels(lines: &[&str]) -> [f64; 2] {
    relay(lines).unwrap_or([0.0, 1.0])
}

/// Outputs of the relay, where the log says them.
fn relay(lines: &[&str]) -> Option<[f64; 2]> {
    let outputs: Vec<f64> = lines
        .iter()
        .filter_map(|l| after(l, "Turning output to "))
        .map(|p| p / 100.0)
        .collect();
    let (low, high) = crate::order::range(&outputs);
    (high > low).then_some([low, high])
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
        unequal: unequal(lines),
    })
}

/// Times with the output up and down, s, by the milliseconds between crossings of the set point. A crossing and the
/// turn of the relay may come in the same update, so that the stretch belongs to the output in the middle of it.
fn half_periods(lines: &[&str], period: f64) -> Option<[f64; 2]> {
    let [low, high] = levels(lines);
    let mut times: Vec<f64> = Vec::new();
    let timed: Vec<&str> = lines
        .iter()
        .copied()
        .filter(|l| time(l).map(|t| times.push(t)).is_some())
        .collect();
    unwrapped(&mut times);
    let turns: Vec<(f64, f64)> = times
        .iter()
        .zip(&timed)
        .filter_map(|(t, l)| Some((*t, after(l, "Turning output to ")? / 100.0)))
        .collect();
    let (mut up, mut down) = (Vec::new(), Vec::new());
    for (t, line) in times.iter().zip(&timed) {
        let Some(dt) = after(line, "dt:").map(|dt| dt / 1000.0) else {
            continue;
        };
        let before = turns.partition_point(|turn| turn.0 <= t - 0.5 * dt);
        let Some((_, output)) = before.checked_sub(1).and_then(|i| turns.get(i)) else {
            continue;
        };
        if *output > 0.5 * (low + high) {
            &mut up
        } else {
            &mut down
        }
        .push(dt);
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
        unequal: unequal(lines),
    })
}
