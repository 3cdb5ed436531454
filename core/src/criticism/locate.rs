//! Where does the model fail? The part of an axis in which the squared error concentrates.

use super::Finding;
use super::data::Data;
use super::fit::{Motion, residuals};
use crate::measurement::Kind;

/// Parts of equal sample count into which an axis is divided.
const BINS: usize = 20;

/// Least excess of the share of error over the share of samples for a region to be worth a sentence.
const LEAST_EXCESS: f64 = 0.1;

/// Most spans that are given for shading.
const MAX_SPANS: usize = 400;

/// Findings that are reported.
const MAX_FINDINGS: usize = 4;

/// Most levels of an input that counts as a relay's.
const RELAY_LEVELS: usize = 6;

/// One axis: a value for every sample, `NaN` where it has none.
pub(super) struct Axis {
    pub name: &'static str,
    pub values: Vec<f64>,
    say: fn(f64, f64, bool) -> String,
}

/// The strongest regions, strongest first. `velocity_unit` is that of the drive or process output.
pub(super) fn locate(data: &Data, motion: &Motion, velocity_unit: &str) -> Vec<Finding> {
    let axes = axes(data, motion);
    let mut findings: Vec<Finding> = Vec::new();
    for (output, r) in data.outputs.iter().zip(residuals(data, motion)) {
        let error: Vec<f64> = r.iter().map(|r| r * r).collect();
        let total: f64 = error.iter().sum();
        if total <= 0.0 {
            continue;
        }
        let what = match (data.kind, output.is_velocity) {
            (Kind::Process, _) => "squared error",
            (Kind::Drive, true) => "squared velocity error",
            (Kind::Drive, false) => "squared position error",
        };
        for axis in &axes {
            let found = concentration(data, axis, &error, total, velocity_unit, what);
            findings.extend(found);
        }
    }
    findings.sort_by(|a, b| {
        (b.share_of_error - b.share_of_samples).total_cmp(&(a.share_of_error - a.share_of_samples))
    });
    // One sentence for an axis: that of the output which shows it best.
    let mut seen: Vec<String> = Vec::new();
    findings.retain(|f| {
        let new = !seen.contains(&f.axis);
        seen.push(f.axis.clone());
        new
    });
    findings.truncate(MAX_FINDINGS);
    findings
}

/// Every axis on which the residual is looked at.
pub(super) fn axes(data: &Data, motion: &Motion) -> Vec<Axis> {
    let time = &data.time;
    let switches: Vec<bool> = (0..data.len())
        .map(|i| i > 0 && data.input[i] != data.input[i - 1])
        .collect();
    let reversals: Vec<bool> = (0..data.len())
        .map(|i| i > 0 && motion.velocity[i] * motion.velocity[i - 1] < 0.0)
        .collect();
    let mut axes = vec![Axis {
        name: "time",
        values: time.clone(),
        say: |a, b, _| format!("between {} and {}", seconds(a), seconds(b)),
    }];
    let value = |a: f64, b: f64, drive: bool| {
        format!(
            "where the {} is between {a:.3} and {b:.3}",
            if drive { "velocity" } else { "output" }
        )
    };
    axes.push(Axis {
        name: "velocity",
        values: motion.velocity.clone(),
        say: value,
    });
    if data.kind == Kind::Drive {
        axes.push(Axis {
            name: "time_since_reversal",
            values: since(time, &reversals),
            say: |a, b, _| span_after(a, b, "a velocity reversal"),
        });
    }
    if levels(&data.input) <= RELAY_LEVELS {
        axes.push(Axis {
            name: "time_since_switch",
            values: since(time, &switches),
            say: |a, b, _| span_after(a, b, "the input switched"),
        });
        axes.push(Axis {
            name: "relay_phase",
            values: relay_phase(data),
            say: |a, b, _| {
                format!(
                    "between {:.0} % and {:.0} % of the relay period",
                    100.0 * a,
                    100.0 * b
                )
            },
        });
    }
    axes
}

/// Best contiguous run of bins, by excess of error over samples.
fn concentration(
    data: &Data,
    axis: &Axis,
    error: &[f64],
    total: f64,
    unit: &str,
    what: &str,
) -> Option<Finding> {
    let mut order: Vec<usize> = (0..data.len())
        .filter(|i| axis.values[*i].is_finite())
        .collect();
    if order.len() < 2 * BINS {
        return None;
    }
    order.sort_by(|a, b| axis.values[*a].total_cmp(&axis.values[*b]));
    let n = data.len() as f64;
    let edge = |k: usize| k * order.len() / BINS;
    let excess: Vec<f64> = (0..BINS)
        .map(|k| {
            let bin = &order[edge(k)..edge(k + 1)];
            bin.iter().map(|i| error[*i]).sum::<f64>() / total - bin.len() as f64 / n
        })
        .collect();
    let (mut best, mut range) = (0.0, (0, 0));
    for from in 0..BINS {
        let mut sum = 0.0;
        for (to, e) in excess.iter().enumerate().skip(from) {
            sum += e;
            if sum > best {
                (best, range) = (sum, (from, to + 1));
            }
        }
    }
    if best < LEAST_EXCESS {
        return None;
    }
    let region = &order[edge(range.0)..edge(range.1)];
    let (low, high) = (axis.values[*region.first()?], axis.values[*region.last()?]);
    let share_of_error = region.iter().map(|i| error[*i]).sum::<f64>() / total;
    let share_of_samples = region.len() as f64 / n;
    let drive = data.kind == Kind::Drive;
    let mut place = (axis.say)(low, high, drive);
    if axis.name == "velocity" && unit != "1" {
        place.push(' ');
        place.push_str(unit);
    }
    Some(Finding {
        axis: if axis.name == "velocity" && !drive {
            "output"
        } else {
            axis.name
        }
        .to_owned(),
        from: low,
        to: high,
        share_of_error,
        share_of_samples,
        text: format!(
            "{:.0} % of the {what} lies {place}, which is {:.0} % of the samples.",
            100.0 * share_of_error,
            100.0 * share_of_samples
        ),
        spans: spans(data, axis, low, high),
    })
}

/// Time spans in which the axis lies between `low` and `high`.
fn spans(data: &Data, axis: &Axis, low: f64, high: f64) -> Vec<(f64, f64)> {
    let step = data.excitation.mean_step();
    let mut spans: Vec<(f64, f64)> = Vec::new();
    for (t, v) in data.time.iter().zip(&axis.values) {
        if !(*v >= low && *v <= high) {
            continue;
        }
        if let Some(last) = spans.last_mut().filter(|last| *t - last.1 < 1.5 * step) {
            last.1 = *t;
        } else if spans.len() < MAX_SPANS {
            spans.push((*t, *t));
        } else {
            break;
        }
    }
    for span in &mut spans {
        span.0 -= 0.5 * step;
        span.1 += 0.5 * step;
    }
    spans
}

/// Time since the last event, s; `NaN` before the first.
fn since(time: &[f64], event: &[bool]) -> Vec<f64> {
    let mut last = f64::NAN;
    time.iter()
        .zip(event)
        .map(|(t, e)| {
            if *e {
                last = *t;
            }
            t - last
        })
        .collect()
}

/// Share of the relay period, counted from each upward switch.
fn relay_phase(data: &Data) -> Vec<f64> {
    let ups: Vec<usize> = (1..data.len())
        .filter(|i| data.input[*i] > data.input[i - 1])
        .collect();
    let mut phase = vec![f64::NAN; data.len()];
    for pair in ups.windows(2) {
        let (from, to) = (data.time[pair[0]], data.time[pair[1]]);
        for (p, t) in phase[pair[0]..pair[1]]
            .iter_mut()
            .zip(&data.time[pair[0]..pair[1]])
        {
            *p = (t - from) / (to - from);
        }
    }
    phase
}

/// Number of different values, counted up to one more than a relay may have.
fn levels(input: &[f64]) -> usize {
    let mut seen: Vec<f64> = Vec::new();
    for u in input {
        if !seen.contains(u) {
            seen.push(*u);
            if seen.len() > RELAY_LEVELS {
                break;
            }
        }
    }
    seen.len()
}

fn span_after(from: f64, to: f64, what: &str) -> String {
    if from <= 0.0 {
        format!("within {} after {what}", seconds(to))
    } else {
        format!("from {} to {} after {what}", seconds(from), seconds(to))
    }
}

/// A duration in a unit that suits it.
pub(super) fn seconds(t: f64) -> String {
    let size = t.abs();
    if size == 0.0 || size >= 1.0 {
        format!("{t:.2} s")
    } else if size >= 1e-3 {
        format!("{:.1} ms", 1e3 * t)
    } else {
        format!("{:.0} us", 1e6 * t)
    }
}
