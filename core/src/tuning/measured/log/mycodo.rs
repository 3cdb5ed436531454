//! Mycodo's daemon log and that of Home Assistant's thermostats: both have the tuner of `pid-autotune`.

use std::f64::consts::PI;

use super::lines::{after, time, unwrapped};
use super::source::{Held, Levels, LogError, Source};
use crate::msg;
use crate::order::median;
use crate::tuning::measured::gains::Form;
use crate::tuning::measured::readings::{AmplitudeConvention, Readings};
use crate::tuning::measured::report::Settings;

/// The words of Home Assistant's thermostat before its gains.
pub(super) const THERMOSTAT: &str = "PID Autotuner output with";

/// By how much it divides the ultimate gain for `Kp` of its rule `ziegler-nichols`, and the period for `Kp/Ki`.
const DIVISORS: [f64; 2] = [34.0, 40.0];

/// Levels where the log does not say them, and the noise band where it is not set.
const ASSUMED: [f64; 2] = [0.0, 100.0];
const NOISEBAND: f64 = 0.5;

/// Peaks that its amplitude is the mean of.
const LAST: usize = 6;

pub(super) fn read(text: &str) -> Result<(Held, Levels, Settings), LogError> {
    if let Some(line) = text
        .lines()
        .find(|l| l.contains("state: failed") || l.contains("state:   failed"))
    {
        return Err(LogError::Failed(
            line.trim().chars().take(120).collect(),
            "the amplitude did not settle within 20 peaks: less noise, a larger output step or a longer look-back \
             helps",
        ));
    }
    let mut notes = vec![
        "The tuner counts its output step as half the relay's swing; where the output cannot go below 0, it switches \
         between 0 and the step, and its ultimate gain comes out twice as large as it should be."
            .into(),
        "Its rules divide by numbers 20 times too large (34, 40, 160 instead of 1.7, 2, 8): Kp comes out 20 times too \
         small and Kd 400 times."
            .into(),
    ];
    let (readings, levels) = if let Some(found) = found(text) {
        found
    } else {
        notes.push(msg!("The amplitude was computed from the gains in the log, and the noise band taken as {}, the \
                         tuner's default; give --hysteresis if another was set. At log level DEBUG the log has the \
                         peaks and the times.", NOISEBAND));
        of_gains(text).ok_or(LogError::Garbled(Source::Mycodo))?
    };
    let settings = Settings {
        form: Form::Parallel,
        full_scale: None,
        target: None,
        hysteresis: None,
        notes,
    };
    Ok((Held::Readings(readings), levels, settings))
}

/// By the peaks and switches of its lines for debugging.
fn found(text: &str) -> Option<(Readings, Levels)> {
    let (mut peaks, mut switches) = (Vec::new(), Vec::new());
    let (mut ends, mut amplitude) = ([Vec::new(), Vec::new()], None);
    for line in text.lines() {
        if let Some(peak) = after(line, "found peak:") {
            peaks.push(peak);
        } else if let Some((_, state)) = line.split_once("switched state: relay step ") {
            switches.push((time(line)?, state.trim_start().starts_with("up")));
        } else if let (Some(value), Some((_, up))) = (after(line, "input:"), switches.last()) {
            ends[usize::from(*up)].push(value);
        } else if let Some(value) = after(line, "amplitude:") {
            amplitude = Some(value);
        }
    }
    let (half_periods, period) = half_periods(&switches)?;
    let late = &peaks[peaks.len().saturating_sub(LAST)..];
    let mut swings: Vec<f64> = late.windows(2).map(|p| (p[1] - p[0]).abs()).collect();
    if swings.is_empty() {
        return None;
    }
    let swing = median(&mut swings);
    // Its own "ultimate gain" tells the output step: 4 step/(pi amplitude).
    let by_gain = own_gains(text)[0]
        .zip(amplitude)
        .map(|(kp, a)| [0.0, DIVISORS[0] * kp * PI * a / 4.0]);
    let told = outputs(text).map(|o| o.0).or(by_gain);
    let levels = told.map_or(Levels::Assumed, |_| Levels::Told);
    let [mut at_up, mut at_down] = [ends[1].clone(), ends[0].clone()];
    let hysteresis = 0.5 * (median(&mut at_down) - median(&mut at_up)).abs();
    let readings = Readings {
        amplitude: swing,
        convention: AmplitudeConvention::PeakToPeak,
        period,
        levels: told.unwrap_or(ASSUMED),
        hysteresis: hysteresis.min(0.49 * swing),
        half_periods: Some(half_periods),
        unequal: false,
    };
    Some((readings, levels))
}

/// `Kp` and `Ki` of its rule `ziegler-nichols`: in the lines after the rule's, or behind it in the same line.
fn own_gains(text: &str) -> [Option<f64>; 2] {
    let (mut rule, mut found) = ("", [None; 2]);
    for line in text.lines() {
        if let Some((_, rest)) = line.split_once(THERMOSTAT) {
            if rest.trim_start().starts_with("ziegler-nichols") {
                found = ["Kp=", "Ki="].map(|key| after(rest, key));
            }
        } else if let Some((_, name)) = line.split_once("rule: ") {
            rule = name.trim();
        } else if rule == "ziegler-nichols" {
            for (value, key) in found.iter_mut().zip(["Kp:", "Ki:"]) {
                *value = after(line, key).or(*value);
            }
        }
    }
    found
}

/// When an output changes, s, and whether to the higher one.
type Switch = (f64, bool);

/// The two outputs that Mycodo writes at every sample, and when they change.
fn outputs(text: &str) -> Option<([f64; 2], Vec<Switch>)> {
    let rows: Vec<(f64, f64)> = text
        .lines()
        .filter_map(|l| Some((time(l)?, after(l, "output:")?)))
        .collect();
    let (low, high) = rows
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), r| {
            (a.min(r.1), b.max(r.1))
        });
    let is_up = |value: f64| value > 0.5 * (low + high);
    let switches = rows
        .windows(2)
        .filter(|r| is_up(r[0].1) != is_up(r[1].1))
        .map(|r| (r[1].0, is_up(r[1].1)))
        .collect();
    (high > low).then_some(([low, high], switches))
}

/// From its gains, where nothing else is in the log: its ultimate gain is `4 step/(pi amplitude)`, the step the upper
/// level.
fn of_gains(text: &str) -> Option<(Readings, Levels)> {
    let [Some(kp), Some(ki)] = own_gains(text) else {
        return None;
    };
    let (levels, told, cycle) = match outputs(text) {
        Some((levels, switches)) => (levels, Levels::Told, half_periods(&switches)),
        None => (ASSUMED, Levels::AssumedByGain, None),
    };
    let amplitude = 4.0 * levels[1].abs() / (PI * DIVISORS[0] * kp);
    let readings = Readings {
        amplitude,
        convention: AmplitudeConvention::Half,
        period: cycle.map_or(DIVISORS[1] * kp / ki, |c| c.1),
        levels,
        hysteresis: NOISEBAND.min(0.99 * amplitude),
        half_periods: cycle.map(|c| c.0),
        unequal: false,
    };
    Some((readings, told))
}

/// Times up and down, and the period.
fn half_periods(switches: &[Switch]) -> Option<([f64; 2], f64)> {
    let mut times: Vec<f64> = switches.iter().map(|s| s.0).collect();
    unwrapped(&mut times);
    let (mut up, mut down) = (Vec::new(), Vec::new());
    for (span, from) in times.windows(2).zip(switches) {
        if from.1 { &mut up } else { &mut down }.push(span[1] - span[0]);
    }
    if up.is_empty() || down.is_empty() {
        return None;
    }
    let (up, down) = (median(&mut up), median(&mut down));
    Some(([up, down], up + down))
}
