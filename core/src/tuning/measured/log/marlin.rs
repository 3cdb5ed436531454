//! Marlin: the serial log of `M303`.

use super::lines::{after, time, unwrapped};
use super::source::{Held, Levels, LogError, Source};
use crate::tuning::measured::gains::Form;
use crate::tuning::measured::readings::{AmplitudeConvention, Readings};
use crate::tuning::measured::record::Record;
use crate::tuning::measured::report::Settings;

/// Full scale of its outputs.
const SCALE: f64 = 255.0;

/// It reports the temperature every 2 s while it tunes, the power from 0 to 127.
const REPORT: f64 = 2.0;
const POWER: f64 = 2.0;

/// Fewest reports that make a record.
const FEWEST: usize = 60;

/// Temperature and power of the hot end and of the bed in a report.
const HEATERS: [[&str; 2]; 2] = [["T:", "@:"], ["B:", "B@:"]];

/// What it says where it gives up, and what that means.
const FAILURES: [(&str, &str); 3] = [
    (
        "Temperature too high",
        "the temperature passed the target by more than 20 to 30 degrees: the heater is far stronger than needed, or \
         the sensor responds late; tune at a lower power, or at a target nearer to the one in use",
    ),
    (
        "timeout",
        "no cycle was completed within 20 minutes: the target is beyond what the heater reaches, or the plant cools \
         too slowly; choose a lower target or a stronger heater",
    ),
    (
        "Bad heater id",
        "there is no heater with this number; E0 is the first hot end, E-1 the bed",
    ),
];

pub(super) fn read(name: &str, text: &str) -> Result<(Held, Levels, Settings), LogError> {
    let lines: Vec<&str> = text.lines().collect();
    let settings = |notes| Settings {
        form: Form::Marlin,
        full_scale: Some(SCALE),
        target: None,
        hysteresis: None,
        notes,
    };
    // The heater that is tuned is the one whose power changes.
    let record = HEATERS.iter().find_map(|h| reported(name, &lines, *h));
    if let Some(record) = record {
        return Ok((Held::Record(record), Levels::Told, settings(Vec::new())));
    }
    if let Some(readings) = cycle(&lines) {
        let note = "Marlin moves the bias from cycle to cycle until both half periods are alike, and keeps each of \
                    them at 5 s or more; with the temperature reports of the log (T: and @:) the whole record could be \
                    used.";
        return Ok((
            Held::Readings(readings),
            Levels::Told,
            settings(vec![note.into()]),
        ));
    }
    let failed = lines.iter().find_map(|l| {
        let found = FAILURES.iter().find(|f| l.contains(f.0))?;
        l.contains("failed")
            .then(|| LogError::Failed(l.trim().chars().take(80).collect(), found.1))
    });
    Err(failed.unwrap_or(LogError::Garbled(Source::Marlin)))
}

/// The last line of a cycle: with `Ku` and `Tu` in it or behind it.
fn cycle(lines: &[&str]) -> Option<Readings> {
    let at = (0..lines.len()).rev().find(|&i| {
        let l = lines[i];
        after(l, "bias:").is_some()
            && [l, lines.get(i + 1).unwrap_or(&"")]
                .iter()
                .any(|l| after(l, "Tu:").is_some())
    })?;
    let (line, next) = (lines[at], lines.get(at + 1).copied().unwrap_or_default());
    let (bias, d) = (after(line, "bias:")?, after(line, "d:")?);
    let (low, high) = (after(line, "min:")?, after(line, "max:")?);
    Some(Readings {
        amplitude: high - low,
        convention: AmplitudeConvention::PeakToPeak,
        period: after(line, "Tu:").or_else(|| after(next, "Tu:"))?,
        levels: [bias - d, bias + d],
        hysteresis: 0.0,
        half_periods: None,
        unequal: false,
    })
}

/// Reports such as `T:201.2 /210.0 B:60.0 /60.0 @:127 B@:0`, with the host's time or every 2 s.
fn reported(name: &str, lines: &[&str], [temperature, power]: [&str; 2]) -> Option<Record> {
    let begin = lines
        .iter()
        .position(|l| l.contains("PID Autotune start"))
        .unwrap_or(0);
    let (mut times, mut output, mut input) = (Vec::new(), Vec::new(), Vec::new());
    for line in &lines[begin..] {
        if let (Some(y), Some(u)) = (after(line, temperature), after(line, power)) {
            times.push(time(line));
            output.push(y);
            input.push(POWER * u);
        }
    }
    if output.len() < FEWEST {
        return None;
    }
    let mut time: Vec<f64> = if times.iter().all(Option::is_some) {
        times.into_iter().flatten().collect()
    } else {
        (0..output.len()).map(|i| REPORT * i as f64).collect()
    };
    unwrapped(&mut time);
    let record = Record {
        name: name.to_owned(),
        time,
        input,
        output,
        input_unit: "1".to_owned(),
        output_unit: "°C".to_owned(),
    };
    record.validate().is_ok().then_some(record)
}
