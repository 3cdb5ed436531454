//! Where does the model fail? The part of an axis in which the squared error concentrates.

use super::axes::{Axis, Parts, axes};
use super::data::Data;
use super::fit::residuals;
use super::motion::Motion;
use super::output::Output;
use super::spectrum::Spectrum;
use crate::diagnosis::Finding;
use crate::measurement::Kind;
use crate::message::fixed;
use crate::msg;

/// Parts of equal sample count into which an axis is divided.
const BINS: usize = 20;

/// Least excess of the share of error over the share of samples for a region to be worth a sentence.
const LEAST_EXCESS: f64 = 0.1;

/// Most spans that are given for shading: all of a fast relay's record, or what is behind them looks free of error.
const MAX_SPANS: usize = 10_000;

/// Findings that are reported.
const MAX_FINDINGS: usize = 4;

/// A finding, and by how much more error than its size it has.
type Ranked = (f64, Finding);

/// The strongest regions, strongest first. `velocity_unit` is that of the drive or process output.
pub(super) fn locate(data: &Data, motion: &Motion, velocity_unit: &str) -> Vec<Finding> {
    let mut ranked = concentrations(data, motion, velocity_unit);
    for (output, residual) in data.outputs.iter().zip(residuals(data, motion)) {
        ranked.extend(band(data, output, &residual));
    }
    strongest(ranked)
}

/// Whether the size of what is left depends on time, on the motion or on the input.
pub(super) fn depends_on_the_motion(data: &Data, motion: &Motion, velocity_unit: &str) -> bool {
    !concentrations(data, motion, velocity_unit).is_empty()
}

/// The regions of all axes but frequency.
fn concentrations(data: &Data, motion: &Motion, velocity_unit: &str) -> Vec<Ranked> {
    let axes: Vec<(Axis, Parts)> = axes(data, motion, velocity_unit)
        .into_iter()
        .filter_map(|axis| axis.parts(0..data.len(), BINS).map(|parts| (axis, parts)))
        .collect();
    let mut ranked: Vec<Ranked> = Vec::new();
    for (output, residual) in data.outputs.iter().zip(residuals(data, motion)) {
        let error: Vec<f64> = residual.iter().map(|r| r * r).collect();
        let total: f64 = error.iter().sum();
        if total <= 0.0 {
            continue;
        }
        for (axis, parts) in &axes {
            ranked.extend(concentration(data, axis, parts, &error, total, output));
        }
    }
    ranked
}

/// The strongest findings, strongest first: for each axis that of the output which shows it best. What has a place in
/// the record is said first, since it can be shown there.
fn strongest(mut ranked: Vec<Ranked>) -> Vec<Finding> {
    ranked.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut findings: Vec<Finding> = Vec::new();
    for (_, finding) in ranked {
        if findings.iter().all(|f| f.axis != finding.axis) {
            findings.push(finding);
        }
    }
    if findings.len() > 1 && findings[0].spans.is_empty() {
        findings.swap(0, 1);
    }
    findings.truncate(MAX_FINDINGS);
    findings
}

/// Best contiguous run of parts, by excess of error over samples.
fn concentration(
    data: &Data,
    axis: &Axis,
    parts: &Parts,
    error: &[f64],
    total: f64,
    output: &Output,
) -> Option<Ranked> {
    let n = data.len() as f64;
    let share = |region: &[usize]| region.iter().map(|i| error[*i]).sum::<f64>() / total;
    let excess: Vec<f64> = (0..parts.len())
        .map(|k| {
            let part = parts.between(k, k + 1);
            share(part) - part.len() as f64 / n
        })
        .collect();
    let (mut best, mut range) = (0.0, (0, 0));
    for from in 0..excess.len() {
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
    let region = parts.between(range.0, range.1);
    let (low, high) = (axis.values[*region.first()?], axis.values[*region.last()?]);
    let (share_of_error, share_of_samples) = (share(region), region.len() as f64 / n);
    let finding = Finding {
        axis: axis.name.to_owned(),
        from: low,
        to: high,
        share_of_error,
        share_of_samples,
        text: msg!(
            "{} % of the {} comes from the {} % of samples {}.",
            fixed(100.0 * share_of_error, 0),
            error_name(data.kind, output),
            fixed(100.0 * share_of_samples, 0),
            axis.place(low, high)
        ),
        spans: spans(data, axis, low, high),
    };
    Some((share_of_error - share_of_samples, finding))
}

/// The band of frequencies with more of the error than its width and than the motion has there.
fn band(data: &Data, output: &Output, residual: &[f64]) -> Option<Ranked> {
    let band = Spectrum::of(data, &output.values, residual)?.strongest()?;
    if band.excess() < LEAST_EXCESS {
        return None;
    }
    let finding = Finding {
        axis: "frequency".to_owned(),
        from: band.from,
        to: band.to,
        share_of_error: band.error,
        share_of_samples: band.width,
        text: msg!(
            "{} % of the {} lies {}, which is {} % of the frequencies and has {} % of the power of the measured {}.",
            fixed(100.0 * band.error, 0),
            error_name(data.kind, output),
            band.place(),
            small_percentage(band.width),
            small_percentage(band.motion),
            signal_name(data.kind, output)
        ),
        spans: Vec::new(),
    };
    Some((band.excess(), finding))
}

/// A share in per cent with one digit after the point where that is the first.
fn small_percentage(share: f64) -> String {
    let digits = usize::from(share < 0.01);
    format!("{:.digits$}", 100.0 * share)
}

fn error_name(kind: Kind, output: &Output) -> &'static str {
    match (kind, output.is_velocity) {
        (Kind::Process, _) => "output error",
        (Kind::Drive, true) => "velocity error",
        (Kind::Drive, false) => "position error",
    }
}

/// What an output is called in a sentence.
pub(super) fn signal_name(kind: Kind, output: &Output) -> &'static str {
    match (kind, output.is_velocity) {
        (Kind::Process, _) => "output",
        (Kind::Drive, true) => "velocity",
        (Kind::Drive, false) => "position",
    }
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

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::backlash::sighted;
    use crate::measurement::{Channel, Measurement, Quantity, import_csv};
    use crate::rig::Random;

    const STEP: f64 = 1e-3;
    const NOISE: f64 = 1e-3;

    /// A drive that a relay swings with a period of 0.4 s while it goes on with `drift` rad/s: the motion itself, and
    /// data that an error of the model, given sample and position, and noise are added to.
    fn swing(drift: f64, error: impl Fn(usize, f64) -> f64) -> (Data, Motion) {
        let n = 4000;
        let mut random = Random::new(17);
        let input: Vec<f64> = (0..n)
            .map(|i| if i / 200 % 2 == 0 { 1.0 } else { -1.0 })
            .collect();
        let (mut x, mut v) = (0.0, -1.0);
        let mut motion = Motion::default();
        for u in &input {
            motion.position.push(x);
            motion.velocity.push(v + drift);
            x += STEP * (v + drift + 5.0 * u * STEP);
            v += 10.0 * u * STEP;
        }
        let mut noise = |size: f64| size * random.between(-1.0, 1.0);
        let (mut position, mut velocity) = (Vec::new(), Vec::new());
        for (i, (x, v)) in motion.position.iter().zip(&motion.velocity).enumerate() {
            position.push(x + noise(1e-2 * NOISE));
            velocity.push(v + noise(NOISE) + error(i, *x));
        }
        let channel = |name: &str, unit: &str, quantity, values| Channel {
            name: name.to_owned(),
            unit: unit.to_owned(),
            quantity,
            values,
        };
        let measurement = Measurement {
            name: "swing".to_owned(),
            kind: Kind::Drive,
            time: (0..n).map(|i| STEP * f64::from(i)).collect(),
            outputs: vec![
                channel("x1", "rad", Quantity::Position, position),
                channel("v1", "rad/s", Quantity::Velocity, velocity),
            ],
            input: channel("u", "N m", Quantity::Input, input),
            reference: Vec::new(),
            warnings: Vec::new(),
        };
        (Data::new(&measurement).unwrap(), motion)
    }

    fn found(data: &Data, motion: &Motion, axis: &str) -> Finding {
        let findings = locate(data, motion, "rad/s");
        let said = format!("{findings:#?}");
        findings.into_iter().find(|f| f.axis == axis).expect(&said)
    }

    #[test]
    fn an_error_at_a_position_is_found_there() {
        let (data, motion) = swing(0.0, |i, x| {
            let sign = if i % 2 == 0 { 1.0 } else { -1.0 };
            if (-0.04..-0.02).contains(&x) {
                0.05 * sign
            } else {
                0.0
            }
        });
        let finding = found(&data, &motion, "position");
        assert!(
            (finding.from + 0.04).abs() < 0.005 && (finding.to + 0.02).abs() < 0.005,
            "{finding:?}"
        );
        assert!(
            finding.share_of_error > 0.95 && finding.share_of_samples < 0.5,
            "{finding:?}"
        );
        assert!(
            finding
                .text
                .to_string()
                .contains(" of samples where the position is between -0.0")
                && finding.text.to_string().ends_with(" rad."),
            "{}",
            finding.text
        );
    }

    #[test]
    fn an_error_at_an_angle_is_found_in_every_turn() {
        let (data, motion) = swing(8.0, |i, x| {
            let sign = if i % 2 == 0 { 1.0 } else { -1.0 };
            if (2.0..3.0).contains(&x.rem_euclid(TAU)) {
                0.05 * sign
            } else {
                0.0
            }
        });
        let finding = found(&data, &motion, "turn_angle");
        assert!(
            (finding.from - 2.0).abs() < 0.4 && (finding.to - 3.0).abs() < 0.4,
            "{finding:?}"
        );
        assert!(
            finding.share_of_error > 0.8 && finding.spans.len() >= 5,
            "{finding:?}"
        );
    }

    #[test]
    fn an_error_while_the_velocity_falls_is_found_there() {
        let falls = |i: usize| i / 200 % 2 == 1;
        let (data, motion) = swing(0.0, |i, _| if falls(i) { 0.03 } else { 0.0 });
        let finding = found(&data, &motion, "acceleration_sign");
        assert_eq!((finding.from, finding.to), (-1.0, -1.0));
        assert!((finding.share_of_samples - 0.5).abs() < 0.01, "{finding:?}");
        assert!(
            finding
                .text
                .to_string()
                .contains("comes from the 50 % of samples where the acceleration is negative."),
            "{}",
            finding.text
        );
    }

    #[test]
    fn a_tone_is_said_as_a_band_but_not_first_where_a_place_is_known() {
        let error = |i: usize, _| {
            let late = if i < 2000 { 0.3 } else { 1.0 };
            0.05 * late * libm::sin(TAU * 60.0 * STEP * i as f64)
        };
        let (data, motion) = swing(0.0, error);
        let findings = locate(&data, &motion, "rad/s");
        assert_eq!(findings[0].axis, "time", "{findings:#?}");
        let finding = found(&data, &motion, "frequency");
        assert!(
            finding.from > 45.0 && finding.from < 60.0 && finding.to > 60.0 && finding.to < 75.0,
            "{finding:?}"
        );
        assert!(
            finding.share_of_error > 0.9 && finding.share_of_samples < 0.05,
            "{finding:?}"
        );
        assert!(
            finding
                .text
                .to_string()
                .contains("% of the velocity error lies between "),
            "{}",
            finding.text
        );
        assert!(
            finding.text.to_string().contains(" Hz, which is ")
                && finding
                    .text
                    .to_string()
                    .ends_with("of the power of the measured velocity."),
            "{}",
            finding.text
        );
    }

    #[test]
    fn noise_is_no_finding() {
        let (data, motion) = swing(8.0, |_, _| 0.0);
        let findings = locate(&data, &motion, "rad/s");
        assert!(findings.is_empty(), "{findings:#?}");
    }

    #[test]
    fn an_error_after_the_motor_felt_the_load_is_found_there() {
        let bytes = include_bytes!("../../../assets/measurements/drive-10.csv");
        let measurement = import_csv("drive-10.csv", bytes, None).unwrap();
        let (estimate, _) = sighted(&measurement).unwrap();
        let times: Vec<f64> = estimate.contacts.iter().map(|c| c.time).collect();
        let data = Data::new(&measurement).unwrap().with_contacts(&times);
        let felt = &data.felt;
        assert!(felt.len() > 10, "{}", felt.len());
        let series = |velocity: bool| {
            let output = data.outputs.iter().find(|o| o.is_velocity == velocity);
            output.map_or_else(|| vec![0.0; data.len()], |o| o.values.clone())
        };
        let mut motion = Motion {
            position: series(false),
            velocity: series(true),
            ..Motion::default()
        };
        // A velocity that is off in the ten samples after each contact.
        for i in felt.iter().flat_map(|s| *s..(s + 10).min(data.len())) {
            motion.velocity[i] += 1e-3;
        }
        let finding = found(&data, &motion, "time_since_impact");
        assert_eq!(finding.from, 0.0);
        assert!(finding.share_of_error > 0.95, "{finding:?}");
        assert!(
            finding
                .text
                .to_string()
                .ends_with(" after the motor felt the load."),
            "{}",
            finding.text
        );
    }
}
