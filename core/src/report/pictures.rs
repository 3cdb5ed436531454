//! The pictures of a report.

use super::html::figure;
use super::input::Tongue;
use super::svg::{Axis, Bar, Chart, bars, range};
use crate::curve::envelope;
use crate::diagnosis::{Finding, MissingPart, Profile, ReplayChannel, Step};
use crate::effect::StepPart;
use crate::measurement::{Channel, Measurement, less_model};
use crate::message::Message;
use crate::msg;
use crate::uncertain::brief;

/// Size of a wide picture.
const WIDE: f64 = 920.0;
const TALL: f64 = 230.0;
const LOW: f64 = 170.0;

/// Size of a picture beside another.
const HALF: f64 = 450.0;

/// Samples that are shown in detail: a few periods at usual sampling.
const DETAIL: usize = 400;

/// Stretches into which a long curve is divided; each shows its extremes.
const STRETCHES: usize = 900;

/// Name of the axis that is logarithmic.
const FREQUENCY: &str = "frequency";

/// Axes that are drawn.
const MOST_AXES: usize = 3;

/// Above this ratio of largest to smallest bars are logarithmic.
const LOGARITHMIC_FROM: f64 = 40.0;

/// The error of every model and the noise floor.
pub(super) fn waterfall(tongue: Tongue, steps: &[Step], floor: f64) -> String {
    let mut rows: Vec<(Message, f64, &'static str)> = Vec::new();
    let mut before: Option<&Step> = None;
    for step in steps {
        rows.push((change(step, before), step.error, "bar"));
        before = Some(step);
    }
    rows.push(("noise floor".into(), floor, "floor"));
    let (least, most) = range(rows.iter().map(|r| r.1).filter(|e| *e > 0.0)).unwrap_or((1.0, 1.0));
    let logarithmic = most > LOGARITHMIC_FROM * least;
    let bars_of: Vec<Bar> = rows
        .into_iter()
        .map(|(label, error, class)| Bar {
            label,
            value: brief(error).into(),
            share: if logarithmic {
                libm::log(error / (0.5 * least)) / libm::log(most / (0.5 * least))
            } else {
                error / most
            },
            class,
        })
        .collect();
    let mut out = String::new();
    let caption = if logarithmic {
        "Error on held-back data in units of the measurement noise; bars on a logarithmic scale."
    } else {
        "Error on held-back data in units of the measurement noise."
    };
    figure(
        &mut out,
        tongue,
        &bars(tongue, WIDE, &bars_of, "Error of every model"),
        caption,
    );
    out
}

/// What was added to and taken from the model before.
fn change(step: &Step, before: Option<&Step>) -> Message {
    let Some(before) = before else {
        return "baseline".into();
    };
    let changes = step.changes_from(before);
    if changes.is_empty() {
        "refitted".into()
    } else {
        changes
    }
}

/// One output: a stretch in detail, and the residual of the whole record.
pub(super) fn output(
    out: &mut String,
    tongue: Tongue,
    time: &[f64],
    measured: &Channel,
    modelled: &ReplayChannel,
    findings: &[Finding],
) {
    let residual: Vec<f64> = measured
        .values
        .iter()
        .zip(&modelled.modelled)
        .map(|(y, m)| y - m)
        .collect();
    let n = time.len().min(residual.len());
    if n == 0 {
        return;
    }
    let (from, to) = detail(&residual[..n]);
    let spans = findings.first().map_or(&[][..], |f| f.spans.as_slice());
    let part =
        |values: &[f64]| -> Vec<[f64; 2]> { (from..to).map(|i| [time[i], values[i]]).collect() };
    let x = || Axis::new("time", "s", (time[from], time[to - 1]));
    let shown = measured.values[from..to]
        .iter()
        .chain(&modelled.modelled[from..to]);
    let name = || Message::name(&measured.name);
    let y = Axis::roomy(
        name(),
        &measured.unit,
        range(shown.copied()).unwrap_or((0.0, 1.0)),
    );
    let mut chart = Chart::new(tongue, WIDE, TALL, x(), y);
    chart.shade(spans);
    chart.line(&part(&measured.values), "measured");
    chart.line(&part(&modelled.modelled), "model");
    let title = msg!("{} measured and modelled", name());
    figure(
        out,
        tongue,
        &chart.finish(title),
        "In detail: the stretch of the record where the model is furthest off.",
    );
    let noise = 2.0 * modelled.noise;
    let residual_axis = |values: &[f64]| {
        let own = values.iter().copied().chain([-noise, noise]);
        Axis::roomy(
            less_model(&measured.name),
            &measured.unit,
            range(own).unwrap_or((0.0, 1.0)),
        )
    };
    let mut chart = Chart::new(tongue, WIDE, LOW, x(), residual_axis(&residual[from..to]));
    chart.shade(spans);
    chart.line(&part(&residual), "residual");
    chart.level(noise, "noise");
    chart.level(-noise, "noise");
    figure(
        out,
        tongue,
        &chart.finish(msg!("Residual of {}", name())),
        "The residual there, with twice the noise on either side.",
    );
    let whole = Axis::new("time", "s", (time[0], time[n - 1]));
    let mut chart = Chart::new(tongue, WIDE, LOW, whole, residual_axis(&residual));
    chart.line(
        &envelope(&time[..n], &residual[..n], 2 * STRETCHES),
        "residual",
    );
    chart.level(noise, "noise");
    chart.level(-noise, "noise");
    figure(
        out,
        tongue,
        &chart.finish(msg!("Residual of {} over the whole record", name())),
        "The residual over the whole record.",
    );
}

/// The stretch with the largest squared residual; not the very start, where states settle.
fn detail(residual: &[f64]) -> (usize, usize) {
    let n = residual.len();
    if n <= DETAIL {
        return (0, n);
    }
    let squares: Vec<f64> = residual
        .iter()
        .map(|r| if r.is_finite() { r * r } else { 0.0 })
        .collect();
    let mut sum: f64 = squares[..DETAIL].iter().sum();
    let (mut best, mut at) = (sum, 0);
    for end in DETAIL..n {
        sum += squares[end] - squares[end - DETAIL];
        if sum > best {
            (best, at) = (sum, end + 1 - DETAIL);
        }
    }
    (at, at + DETAIL)
}

/// Pictures with captions of the residual over the wanted axes, the strongest first: how large it is there
/// with the first model and with the last.
pub(super) fn profiles(
    tongue: Tongue,
    measurement: &Measurement,
    wanted: &[&str],
    first: &[Profile],
    last: &[Profile],
) -> Vec<(String, Message)> {
    let mut axes: Vec<&str> = Vec::new();
    let others = last.iter().map(|p| p.axis.as_str());
    for axis in wanted.iter().copied().chain(others) {
        if !axes.contains(&axis) && axes.len() < MOST_AXES {
            axes.push(axis);
        }
    }
    let mut pictures = Vec::new();
    for axis in axes {
        for profile in last.iter().filter(|p| p.axis == axis) {
            let before = first
                .iter()
                .find(|p| p.axis == axis && p.output == profile.output);
            let output = measurement
                .outputs
                .get(profile.output)
                .map_or("", |o| o.name.as_str());
            let name = Message::words(axis.replace('_', " "));
            pictures.push((
                profile_chart(tongue, &name, profile, before),
                msg!(
                    "Residual of {} against {}: root mean square, in units of the noise.",
                    Message::name(output),
                    &name
                ),
            ));
        }
    }
    pictures
}

/// Estimates that are drawn.
const MOST_ESTIMATES: usize = 4;

/// Pictures with captions of what is missing, estimated without a model.
pub(super) fn missing(tongue: Tongue, parts: &[MissingPart]) -> Vec<(String, Message)> {
    parts
        .iter()
        .take(MOST_ESTIMATES)
        .map(|m| {
            let lower = |p: &StepPart| p.value - 2.0 * p.std_error;
            let upper = |p: &StepPart| p.value + 2.0 * p.std_error;
            let values = m.parts.iter().map(|p| p.value);
            // Bands that know nothing would squeeze the rest.
            let known = range(values.chain([0.0])).unwrap_or((0.0, 1.0));
            let size = known.1 - known.0;
            let (low, high) = (known.0 - size, known.1 + size);
            let bands = m.parts.iter().flat_map(|p| [lower(p), upper(p)]);
            let y = range(bands.map(|v| v.clamp(low, high)).chain([known.0, known.1]));
            let x = range(m.parts.iter().flat_map(|p| [p.from, p.to])).unwrap_or((0.0, 1.0));
            let mut chart = Chart::new(
                tongue,
                HALF,
                TALL,
                Axis::new(Message::words(m.axis.clone()), &m.axis_unit, x),
                Axis::roomy(
                    msg!("missing {}", Message::words(m.what.clone())),
                    &m.unit,
                    y.unwrap_or((0.0, 1.0)),
                ),
            );
            for p in &m.parts {
                let (a, b) = (lower(p), upper(p));
                chart.band(&[(p.from, a, b), (p.to, a, b)], "band");
            }
            let ends = m
                .parts
                .iter()
                .flat_map(|p| [[p.from, p.value], [p.to, p.value]]);
            chart.line(&ends.collect::<Vec<_>>(), "estimate");
            chart.level(0.0, "noise");
            let [what, axis] = [&m.what, &m.axis].map(|name| Message::words(name.clone()));
            let title = msg!("Missing {} against {}", what, axis);
            (chart.finish(title), m.text.clone())
        })
        .collect()
}

fn profile_chart(
    tongue: Tongue,
    name: &Message,
    profile: &Profile,
    before: Option<&Profile>,
) -> String {
    let steps = |p: &Profile| -> Vec<[f64; 2]> {
        p.bins
            .iter()
            .flat_map(|b| [[b.from, b.rms], [b.to, b.rms]])
            .filter(|p| profile.axis != FREQUENCY || p[0] > 0.0)
            .collect()
    };
    let own = steps(profile);
    let other = before.map(steps).unwrap_or_default();
    let ends = range(own.iter().map(|p| p[0])).unwrap_or((0.0, 1.0));
    let x = if profile.axis == FREQUENCY {
        Axis::sized(name, &profile.unit, ends)
    } else {
        Axis::new(name, &profile.unit, ends)
    };
    let sizes = own.iter().chain(&other).map(|p| p[1]).chain([1.0]);
    let y = Axis::sized("residual / noise", "1", range(sizes).unwrap_or((0.0, 1.0)));
    let mut chart = Chart::new(tongue, HALF, LOW + 20.0, x, y);
    chart.line(&other, "before");
    chart.line(&own, "residual");
    chart.level(1.0, "noise");
    chart.finish(msg!("Residual against {}", name))
}
