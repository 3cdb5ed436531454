//! Switches, half periods, amplitude and hysteresis of a relay test.

use serde::{Deserialize, Serialize};

use super::record::Record;
use crate::order::{median, quantile, range};

/// Part of the input's range around its middle in which a relay is seldom, and the most samples that may be there.
const BETWEEN: [f64; 2] = [0.3, 0.7];
const SELDOM: f64 = 0.1;

/// A pulse shorter than this share of the usual half period is flicker around the threshold, not a half period.
const FLICKER: f64 = 0.2;

/// A period that differs from the later ones by more than this share belongs to the start.
const START: f64 = 0.1;

/// What the cycle of a relay test looks like.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Cycle {
    /// Period, s: the mean of the whole periods that are used.
    pub period: f64,
    /// Half of peak to peak of the output, the mean over the periods.
    pub amplitude: f64,
    /// Mean time with the input up and down, s.
    pub half_periods: [f64; 2],
    /// Whole periods that are used.
    pub periods: usize,
    /// From where to where they are used, s.
    pub window: [f64; 2],
    /// Starts of these periods, and the end of the last one, s.
    pub marks: Vec<f64>,
    /// Mean input while down and up.
    pub levels: [f64; 2],
    /// Half the distance between the outputs at which the relay went down and up, as recorded; below 0 where noise or a
    /// late relay hides it.
    pub hysteresis: f64,
    /// Output at which it switches, in the middle.
    pub middle: f64,
    /// Scatter of the periods, s.
    pub scatter: f64,
    /// Switches, s, and whether the input goes up; flicker left out.
    pub switches: Vec<(f64, bool)>,
    /// Pulses that were taken for flicker.
    pub flicker: usize,
}

/// Two levels of a relay's input: the middle, or none where it takes values between.
pub(super) fn threshold(record: &Record) -> Option<f64> {
    let (low, high) = range(&record.input);
    if high <= low {
        return None;
    }
    let between = BETWEEN.map(|share| low + share * (high - low));
    let seldom = record
        .input
        .iter()
        .filter(|u| between[0] < **u && **u < between[1])
        .count();
    (seldom as f64 <= SELDOM * record.input.len() as f64).then_some(0.5 * (low + high))
}

/// Times at which the input passes `threshold`, and whether upwards.
fn switches(record: &Record, threshold: f64) -> Vec<(f64, bool)> {
    (1..record.time.len())
        .filter_map(|i| {
            let (before, now) = (record.input[i - 1] > threshold, record.input[i] > threshold);
            (before != now).then_some((record.time[i], now))
        })
        .collect()
}

/// The half period in which half of the time passes: between long ones there may be many short pulses.
fn usual(switches: &[(f64, bool)]) -> f64 {
    let mut lengths: Vec<f64> = switches.windows(2).map(|s| s[1].0 - s[0].0).collect();
    lengths.sort_by(f64::total_cmp);
    let half = 0.5 * lengths.iter().sum::<f64>();
    let mut sum = 0.0;
    let middle = lengths.iter().find(|l| {
        sum += **l;
        sum >= half
    });
    middle.copied().unwrap_or(0.0)
}

/// Leaves out pulses that are much shorter than the usual half period, which grows as they go.
fn without_flicker(mut switches: Vec<(f64, bool)>) -> (Vec<(f64, bool)>, usize) {
    let all = switches.len();
    loop {
        let shortest = FLICKER * usual(&switches);
        let mut kept: Vec<(f64, bool)> = Vec::with_capacity(switches.len());
        for s in &switches {
            // Both ends of a pulse go, so that what was before it goes on.
            if kept.last().is_some_and(|k| s.0 - k.0 < shortest) {
                kept.pop();
            } else {
                kept.push(*s);
            }
        }
        if kept.len() == switches.len() || kept.len() < 4 {
            let left_out = (all - switches.len()) / 2;
            return (switches, left_out);
        }
        switches = kept;
    }
}

/// Samples of the warm-up: those up to the second switch, where a whole period follows it.
fn warm_up(record: &Record) -> usize {
    let all = threshold(record).map_or_else(Vec::new, |middle| switches(record, middle));
    match all.as_slice() {
        [_, second, _, _, ..] => record.time.partition_point(|t| *t < second.0),
        _ => 0,
    }
}

/// Times at which the output passes its middle upwards, after it was well below: whole rounds, whatever the input does
/// in between. The middle is that of the cycle: a warm-up goes through a much wider range.
pub(super) fn rounds(record: &Record) -> Vec<f64> {
    let mut sorted = record.output[warm_up(record)..].to_vec();
    let (low, high) = (quantile(&mut sorted, 0.05), quantile(&mut sorted, 0.95));
    let [below, above] = BETWEEN.map(|share| low + share * (high - low));
    let mut was_below = false;
    let mut marks = Vec::new();
    for (t, y) in record.time.iter().zip(&record.output) {
        if *y < below {
            was_below = true;
        } else if *y > above && was_below {
            was_below = false;
            marks.push(*t);
        }
    }
    marks
}

/// The cycle, if input and output go round at least twice.
pub(super) fn find(record: &Record) -> Option<Cycle> {
    let all = switches(record, threshold(record)?);
    let raw = all.len();
    let (switches, left_out) = without_flicker(all);
    let at = |up: bool| {
        switches
            .iter()
            .filter(|s| s.1 == up)
            .map(|s| s.0)
            .collect::<Vec<f64>>()
    };
    let (ups, downs) = (at(true), at(false));
    // Counted from the kind of switch that makes more whole periods; where the input flickers, by the output.
    let marks = match left_out {
        0 if ups.len() > downs.len() => ups,
        0 => downs,
        _ => rounds(record),
    };
    let marks = settled(&marks);
    if marks.len() < 3 {
        return None;
    }
    let flicker = if left_out > 0 {
        raw.saturating_sub(2 * marks.len()) / 2
    } else {
        0
    };
    let (from, to) = (marks[0], marks[marks.len() - 1]);
    let lengths: Vec<f64> = marks.windows(2).map(|m| m[1] - m[0]).collect();
    let periods = lengths.len();
    let period = (to - from) / periods as f64;
    let inside = |t: f64| (from..to).contains(&t);
    let mut time_up = 0.0;
    let mut sums = [0.0; 2];
    let middle_input = threshold(record)?;
    for i in 1..record.time.len() {
        let (a, b) = (record.time[i - 1], record.time[i]);
        if inside(a) && b <= to {
            let up = record.input[i - 1] > middle_input;
            if up {
                time_up += b - a;
            }
            sums[usize::from(up)] += record.input[i - 1] * (b - a);
        }
    }
    let time_down = to - from - time_up;
    if time_up <= 0.0 || time_down <= 0.0 {
        return None;
    }
    let up = time_up / periods as f64;
    let (hysteresis, middle) = thresholds(record, &switches, from, to);
    let scatter =
        (lengths.iter().map(|l| (l - period).powi(2)).sum::<f64>() / periods as f64).sqrt();
    Some(Cycle {
        period,
        amplitude: amplitude(record, marks),
        half_periods: [up, period - up],
        periods,
        window: [from, to],
        marks: marks.to_vec(),
        levels: [sums[0] / time_down, sums[1] / time_up],
        hysteresis,
        middle,
        scatter,
        switches,
        flicker,
    })
}

/// Marks of periods without the first ones, as long as these are of another length than the later ones.
fn settled(marks: &[f64]) -> &[f64] {
    let lengths: Vec<f64> = marks.windows(2).map(|m| m[1] - m[0]).collect();
    let later = &lengths[lengths.len() / 2..];
    let usual = median(&mut later.to_vec());
    let most = lengths.len().saturating_sub(2);
    let start = lengths
        .iter()
        .take(most)
        .position(|l| (l - usual).abs() <= START * usual)
        .unwrap_or(most);
    &marks[start..]
}

/// Half of peak to peak, mean over the periods; peaks by quantiles, so that a single noisy sample does not make them.
fn amplitude(record: &Record, marks: &[f64]) -> f64 {
    let mut sum = 0.0;
    for m in marks.windows(2) {
        let mut values = record.output[record.between(m[0], m[1])].to_vec();
        let (low, high) = (quantile(&mut values, 0.01), quantile(&mut values, 0.99));
        sum += 0.5 * (high - low);
    }
    sum / (marks.len() - 1).max(1) as f64
}

/// Half the distance, and the middle, of the outputs between the two samples of a switch.
fn thresholds(record: &Record, switches: &[(f64, bool)], from: f64, to: f64) -> (f64, f64) {
    let at = |up: bool| {
        let mut values: Vec<f64> = switches
            .iter()
            .filter(|s| s.1 == up && (from..=to).contains(&s.0))
            .filter_map(|s| {
                let i = record.time.partition_point(|t| *t < s.0);
                let before = record.output.get(i.checked_sub(1)?)?;
                Some(0.5 * (before + record.output.get(i)?))
            })
            .collect();
        median(&mut values)
    };
    let (up, down) = (at(true), at(false));
    (0.5 * (down - up), 0.5 * (down + up))
}
