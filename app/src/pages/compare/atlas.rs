//! Where the model fails: the residual over every axis, as small pictures.

use egui::Color32;
use egui_plot::{HLine, Line, LineStyle, Points, Span};
use hysteron_core::diagnosis::{Finding, Profile, ProfileBin, StepReport};
use hysteron_core::message::Message;
use hysteron_core::msg;
use hysteron_core::uncertain::titled;

use super::parts::Part;
use super::state::Compare;
use crate::language::tr;
use crate::theme;
use crate::widgets::chart::{Chart, Pen, Shape, caption_ui};

/// Least width of a picture, and its height, points.
const WIDTH: f32 = 260.0;
const HEIGHT: f32 = 150.0;

/// Name of the axis that is logarithmic.
const FREQUENCY: &str = "frequency";

/// Width of the labels of y.
const AXIS_WIDTH: f32 = 44.0;

pub(super) fn ui(page: &Compare, ui: &mut egui::Ui) {
    let (Some(report), Some(measurement)) = (page.report_in(Part::Plots), &page.measurement) else {
        return;
    };
    let mut curves = vec![
        ("this model", theme::RESIDUAL, Shape::Line),
        ("noise", theme::NOISE, Shape::Dashes),
    ];
    let before = page.report_before().filter(|_| page.before);
    if before.is_some() {
        curves.insert(0, ("the previous step", theme::BEFORE, Shape::Line));
    }
    tests_ui(report, ui);
    caption_ui(ui, "Size of the residual, in units of the noise", &curves);
    let finding = report.step.findings.get(page.finding);
    let many = measurement.outputs.len() > 1;
    // Where the findings are comes first.
    let mut profiles: Vec<&Profile> = report.atlas.iter().collect();
    profiles.sort_by_key(|p| {
        let mut findings = report.step.findings.iter();
        findings
            .position(|f| f.axis == p.axis)
            .unwrap_or(usize::MAX)
    });
    grid_ui(&profiles, ui, |profile, ui| {
        let name = measurement
            .outputs
            .get(profile.output)
            .map_or("", |c| c.title());
        let title = if many {
            msg!("{} against {}", Message::name(name), words(&profile.axis))
        } else {
            msg!("against {}", words(&profile.axis))
        };
        ui.label(tr(title));
        let earlier = before.and_then(|b| twin(b, profile));
        picture_ui(profile, earlier, finding, ui);
    });
}

/// What to make of a test that fails although the verdict says noise.
const SMALL: &str = "A long record shows correlations that are far too small to matter: a few hundredths of the \
                     square do not mean that an effect is missing. The rounding of a counter is not white either.";

/// Whether what is left is white and no longer follows the input, in words.
fn tests_ui(report: &StepReport, ui: &mut egui::Ui) {
    if report.step.tests.is_empty() {
        return;
    }
    ui.collapsing(
        tr("Is what is left only noise? Two tests of each output"),
        |ui| {
            for test in &report.step.tests {
                ui.label(tr(&test.text));
            }
            if report.step.tests.iter().any(|t| !t.passed) {
                ui.label(tr(SMALL));
            }
        },
    );
}

/// Draws each profile in a cell of a grid that fits the width.
pub(super) fn grid_ui(
    profiles: &[&Profile],
    ui: &mut egui::Ui,
    mut cell: impl FnMut(&Profile, &mut egui::Ui),
) {
    let columns = ((ui.available_width() / WIDTH) as usize).clamp(1, 3);
    for row in profiles.chunks(columns) {
        ui.columns(columns, |cells| {
            for (ui, profile) in cells.iter_mut().zip(row) {
                cell(profile, ui);
            }
        });
    }
}

/// The profile of another step over the same axis.
fn twin<'a>(report: &'a StepReport, profile: &Profile) -> Option<&'a Profile> {
    let mut all = report.atlas.iter();
    all.find(|p| p.output == profile.output && p.axis == profile.axis)
}

/// Name of an axis in words.
pub(super) fn words(axis: &str) -> Message {
    Message::words(axis.replace('_', " "))
}

/// Label of an axis with its unit.
fn axis_label(profile: &Profile) -> Message {
    titled(words(&profile.axis), &profile.unit)
}

/// Share of an axis within which bins are one point: a sampled axis has only so many values.
const CLOSE: f64 = 0.01;

/// Where a value of an axis is drawn: a frequency at its logarithm.
fn place(axis: &str, value: f64) -> f64 {
    if axis == FREQUENCY {
        value.log10()
    } else {
        value
    }
}

/// A point in the middle of each bin, with the mean of those that are in the same place.
fn points(profile: &Profile, value: impl Fn(&ProfileBin) -> f64) -> Vec<[f64; 2]> {
    let at = |value: f64| place(&profile.axis, value);
    let range = match (profile.bins.first(), profile.bins.last()) {
        (Some(first), Some(last)) => at(last.to) - at(first.from),
        _ => 0.0,
    };
    // The lowest frequencies are from 0 on: no two are close then.
    let close = if range.is_finite() {
        CLOSE * range
    } else {
        0.0
    };
    // Place, sum and number of the bins there.
    let mut places: Vec<(f64, f64, f64)> = Vec::new();
    for bin in &profile.bins {
        let middle = at(f64::midpoint(bin.from, bin.to));
        match places.last_mut() {
            Some(last) if middle - last.0 < close => {
                last.1 += value(bin);
                last.2 += 1.0;
            }
            _ => places.push((middle, value(bin), 1.0)),
        }
    }
    places.into_iter().map(|(x, sum, n)| [x, sum / n]).collect()
}

/// Radius of the point of a single value, and what is shaded and is left free on either side of it.
const RADIUS: f32 = 5.0;
const SHADED: f64 = 0.2;
const FREE: f64 = 0.5;

/// Share of such a plot that is left free around its points: none is cut at the edge.
const MARGIN: egui::Vec2 = egui::vec2(0.05, 0.1);

/// Whether an axis has single values, such as a sign: there is nothing between them.
fn is_discrete(profile: &Profile) -> bool {
    profile.bins.iter().all(|b| b.from == b.to)
}

/// Draws a curve over an axis: points where it has single values.
pub(super) fn draw(
    plot: &mut Pen<'_, '_>,
    profile: &Profile,
    value: impl Fn(&ProfileBin) -> f64,
    (name, color): (&'static str, Color32),
    style: impl FnOnce(Line<'static>) -> Line<'static>,
) {
    let (name, points) = (tr(name), points(profile, value));
    if !is_discrete(profile) {
        plot.line(style(Line::new(name, points).color(color)));
        return;
    }
    plot.points(Points::new(name, points).color(color).radius(RADIUS));
}

/// A small plot that stays where it is.
pub(super) fn small(id: String, profile: &Profile, y: &'static str) -> Chart<'static> {
    let axes = [axis_label(profile), y.into()];
    let chart = Chart::new(id, axes, HEIGHT, AXIS_WIDTH).still();
    match (profile.bins.first(), profile.bins.last()) {
        (Some(first), Some(last)) if is_discrete(profile) => chart.with(|plot| {
            plot.include_x(first.from - FREE)
                .include_x(last.from + FREE)
                .set_margin_fraction(MARGIN)
        }),
        _ => chart,
    }
}

fn picture_ui(
    profile: &Profile,
    before: Option<&Profile>,
    finding: Option<&Finding>,
    ui: &mut egui::Ui,
) {
    let id = format!("atlas {} {}", profile.output, profile.axis);
    let region = finding
        .filter(|f| f.axis == profile.axis && (f.from < f.to || is_discrete(profile)))
        .map(|f| {
            if is_discrete(profile) {
                return f.from - SHADED..=f.to + SHADED;
            }
            // Its logarithmic axis has no 0: such a band begins where the curve does.
            let first = profile.bins.first().map_or(f.from, |b| 0.5 * b.to);
            let low = if f.axis == FREQUENCY {
                f.from.max(first)
            } else {
                f.from
            };
            place(&f.axis, low)..=place(&f.axis, f.to)
        });
    let mut chart = small(id, profile, "rms [× noise]");
    if profile.axis == FREQUENCY {
        chart = chart.decades();
    }
    chart.with(|plot| plot.include_y(0.0)).show(ui, |plot| {
        if let Some(region) = region {
            let color = theme::SHADE.gamma_multiply(0.2);
            plot.add(Span::new("", region).fill(color).border_width(0.0));
        }
        if let Some(before) = before {
            let name = ("the previous step", theme::BEFORE);
            draw(plot, before, |b| b.rms, name, |line| line.width(1.5));
        }
        let name = ("this model", theme::RESIDUAL);
        draw(plot, profile, |b| b.rms, name, |line| line.width(2.0));
        let noise = HLine::new(tr("noise"), 1.0).color(theme::NOISE).width(1.5);
        plot.hline(noise.style(LineStyle::dashed_dense()));
    });
}
