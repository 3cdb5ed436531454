//! Klipper: the file that `PID_CALIBRATE ... WRITE_FILE=1` leaves, `klippy.log`, or the console.

use std::f64::consts::PI;

use super::lines::{after, leading};
use super::source::{Held, Levels, LogError, Source};
use crate::message::Message;
use crate::order::median;
use crate::tuning::measured::gains::Form;
use crate::tuning::measured::readings::{AmplitudeConvention, Readings};
use crate::tuning::measured::record::Record;
use crate::tuning::measured::report::Settings;

/// The heater switches off at the target and on 5 degrees below it.
const HYSTERESIS: f64 = 2.5;

/// Gains are for an output from 0 to this.
const SCALE: f64 = 255.0;

/// Fewest lines that make a record.
const FEWEST: usize = 40;

/// Whether it is the file of `WRITE_FILE=1`: lines `pwm: time value`, then `time temperature`.
pub(super) fn is_write_file(text: &str) -> bool {
    let pwm = text
        .lines()
        .filter(|l| l.starts_with("pwm: "))
        .take(3)
        .count();
    pwm >= 3
}

/// Whether it has the statistics of `klippy.log` with a heater's power.
pub(super) fn has_stats(text: &str) -> bool {
    text.lines()
        .any(|l| l.contains("Stats ") && l.contains(" pwm="))
}

pub(super) fn read(name: &str, text: &str) -> Result<(Held, Levels, Settings), LogError> {
    let settings = |notes: Vec<Message>, target: Option<f64>| Settings {
        form: Form::Klipper,
        full_scale: Some(1.0),
        target,
        hysteresis: None,
        notes,
    };
    if let Some(record) = written(name, text) {
        return Ok((
            Held::Record(record),
            Levels::Told,
            settings(Vec::new(), None),
        ));
    }
    if let Some((record, target)) = of_stats(name, text) {
        return Ok((
            Held::Record(record),
            Levels::Told,
            settings(Vec::new(), Some(target)),
        ));
    }
    // The gains alone do not say MAX_POWER.
    let (readings, levels) = raw(text)
        .map(|r| (r, Levels::Told))
        .or_else(|| Some((of_gains(text)?, Levels::AssumedByGain)))
        .ok_or(LogError::Garbled(Source::Klipper))?;
    let note = "Klipper switches 5 degrees below the target and at the target itself: with this hysteresis its cycle \
                is not at the ultimate point. Its formula ignores that and counts the full power as half of the \
                relay's swing, so that its ultimate gain is twice 4d/(πa). PID_CALIBRATE with WRITE_FILE=1 leaves \
                /tmp/heattest.txt, which tells more.";
    Ok((
        Held::Readings(readings),
        levels,
        settings(vec![note.into()], None),
    ))
}

/// The file of `WRITE_FILE=1`. The power changes between two temperatures: there the temperature is interpolated.
fn written(name: &str, text: &str) -> Option<Record> {
    let (mut power, mut temperature) = (Vec::new(), Vec::new());
    for line in text.lines() {
        let (of, rest) = match line.strip_prefix("pwm: ") {
            Some(rest) => (&mut power, rest),
            None => (&mut temperature, line),
        };
        let mut words = rest.split_whitespace();
        if let (Some(t), Some(v), None) = (
            words.next().and_then(leading),
            words.next().and_then(leading),
            words.next(),
        ) {
            of.push((t, v));
        }
    }
    if power.len() < 3 || temperature.len() < FEWEST {
        return None;
    }
    let (first, last) = (temperature[0].0, temperature[temperature.len() - 1].0);
    let mut times: Vec<f64> = temperature.iter().map(|t| t.0).collect();
    times.extend(
        power
            .iter()
            .map(|p| p.0)
            .filter(|t| (first..last).contains(t)),
    );
    times.sort_by(f64::total_cmp);
    times.dedup();
    let interpolated = |t: f64| {
        let i = temperature
            .partition_point(|s| s.0 <= t)
            .clamp(1, temperature.len() - 1);
        let ((a, ya), (b, yb)) = (temperature[i - 1], temperature[i]);
        ya + (yb - ya) * ((t - a) / (b - a)).clamp(0.0, 1.0)
    };
    Some(Record {
        name: name.to_owned(),
        input: times
            .iter()
            .map(|t| {
                power[..power.partition_point(|p| p.0 <= *t)]
                    .last()
                    .map_or(0.0, |p| p.1)
            })
            .collect(),
        output: times.iter().map(|t| interpolated(*t)).collect(),
        time: times,
        input_unit: "1".to_owned(),
        output_unit: "°C".to_owned(),
    })
}

/// The heater of `klippy.log` that has a target, and the highest of its targets.
fn of_stats(name: &str, text: &str) -> Option<(Record, f64)> {
    let heaters = ["extruder:", "heater_bed:"];
    heaters.into_iter().find_map(|heater| {
        let mut rows: Vec<[f64; 4]> = Vec::new();
        for line in text.lines().filter(|l| l.contains("Stats ")) {
            let Some((_, own)) = line.split_once(heater) else {
                continue;
            };
            let row = [
                after(line, "Stats "),
                after(own, "temp="),
                after(own, "pwm="),
                after(own, "target="),
            ];
            if let [Some(t), Some(y), Some(u), Some(r)] = row
                && r > 0.0
                && rows.last().is_none_or(|before| t > before[0])
            {
                rows.push([t, y, u, r]);
            }
        }
        let target = rows.iter().map(|r| r[3]).fold(0.0, f64::max);
        (rows.len() >= FEWEST).then(|| {
            let column = |i: usize| rows.iter().map(|r| r[i]).collect::<Vec<f64>>();
            let record = Record {
                name: name.to_owned(),
                time: column(0),
                input: column(2),
                output: column(1),
                input_unit: "1".to_owned(),
                output_unit: "°C".to_owned(),
            };
            (record, target)
        })
    })
}

/// Lines `Autotune: raw=(peak to peak)/(power) Ku=... Tu=...`: the middle one.
fn raw(text: &str) -> Option<Readings> {
    let (mut swings, mut powers, mut periods) = (Vec::new(), Vec::new(), Vec::new());
    for line in text.lines() {
        let Some((_, rest)) = line.split_once("raw=") else {
            continue;
        };
        let (swing, power) = (
            leading(rest),
            rest.split_once('/').and_then(|(_, p)| leading(p)),
        );
        if let (Some(swing), Some(power), Some(period)) = (swing, power, after(line, "Tu=")) {
            swings.push(swing.abs());
            powers.push(power);
            periods.push(period);
        }
    }
    (!swings.is_empty()).then(|| Readings {
        amplitude: median(&mut swings),
        convention: AmplitudeConvention::PeakToPeak,
        period: median(&mut periods),
        levels: [0.0, median(&mut powers)],
        hysteresis: HYSTERESIS,
        half_periods: None,
        unequal: false,
    })
}

/// From `pid_Kp=... pid_Ki=... pid_Kd=...`, which are 0.6 Ku 255, Kp/(Tu/2) and Kp Tu/8, with a Ku of `4 power/(pi a)`,
/// at full power.
fn of_gains(text: &str) -> Option<Readings> {
    let find = |key: &str| text.lines().rev().find_map(|l| after(l, key));
    let (kp, ki, _) = (find("pid_Kp=")?, find("pid_Ki=")?, find("pid_Kd=")?);
    let gain = kp / (0.6 * SCALE);
    Some(Readings {
        amplitude: 4.0 / (PI * gain),
        convention: AmplitudeConvention::Half,
        period: 2.0 * kp / ki,
        levels: [0.0, 1.0],
        hysteresis: HYSTERESIS,
        half_periods: None,
        unequal: false,
    })
}
