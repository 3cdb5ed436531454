//! Mycodo's daemon log and that of Home Assistant's thermostats: both have the tuner of `pid-autotune`.

use std::f64::consts::PI;

use super::lines::{after, time, unwrapped};
use super::source::{Held, LogError, Source};
use crate::order::median;
use crate::tuning::measured::gains::Form;
use crate::tuning::measured::readings::{AmplitudeConvention, Readings};
use crate::tuning::measured::report::Settings;

/// By how much it divides the ultimate gain for `Kp` of its rule `ziegler-nichols`.
const DIVISOR: f64 = 34.0;

/// Peaks that its amplitude is the mean of.
const LAST: usize = 6;

pub(super) fn read(text: &str) -> Result<(Held, Settings), LogError> {
    if let Some(line) = text
        .lines()
        .find(|l| l.contains("state: failed") || l.contains("state:   failed"))
    {
        return Err(LogError::Failed(
            line.trim().chars().take(120).collect(),
            "the amplitude did not settle within 20 peaks: less noise, a larger output step, or a longer look-back lets it",
        ));
    }
    let readings = readings(text).ok_or(LogError::Garbled(Source::Mycodo))?;
    let notes = vec![
        "The tuner takes its output step for half the relay's swing; where the output cannot go below 0 it switches \
         between 0 and the step, and its ultimate gain is twice too large."
            .to_owned(),
        "Its rules divide by twentieths (34, 40, 160 for 1.7, 2, 8): Kp comes out 20 times and Kd 400 times too small."
            .to_owned(),
    ];
    let settings = Settings {
        form: Form::Parallel,
        full_scale: None,
        target: None,
        notes,
    };
    Ok((Held::Readings(readings), settings))
}

fn readings(text: &str) -> Option<Readings> {
    let (mut peaks, mut switches) = (Vec::new(), Vec::new());
    let (mut ends, mut amplitude, mut gain) = ([Vec::new(), Vec::new()], None, None);
    let mut rule = "";
    for line in text.lines() {
        if let Some(peak) = after(line, "found peak:") {
            peaks.push(peak);
        } else if let Some((_, state)) = line.split_once("switched state: relay step ") {
            switches.push((time(line)?, state.trim_start().starts_with("up")));
        } else if let (Some(value), Some((_, up))) = (after(line, "input:"), switches.last()) {
            ends[usize::from(*up)].push(value);
        } else if let Some(value) = after(line, "amplitude:") {
            amplitude = Some(value);
        } else if let Some((_, name)) = line.split_once("rule: ") {
            rule = name.trim();
        } else if let (Some(value), "ziegler-nichols") = (after(line, "Kp:"), rule) {
            gain = Some(DIVISOR * value);
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
    let step = gain
        .zip(amplitude)
        .map_or(1.0, |(gain, a): (f64, f64)| gain * PI * a / 4.0);
    let [mut at_up, mut at_down] = [ends[1].clone(), ends[0].clone()];
    let hysteresis = 0.5 * (median(&mut at_down) - median(&mut at_up)).abs();
    Some(Readings {
        amplitude: swing,
        convention: AmplitudeConvention::PeakToPeak,
        period,
        levels: [0.0, step],
        hysteresis: hysteresis.min(0.49 * swing),
        half_periods: Some(half_periods),
    })
}

/// Times up and down, and the period.
fn half_periods(switches: &[(f64, bool)]) -> Option<([f64; 2], f64)> {
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
