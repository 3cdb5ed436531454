//! The point of the Nyquist curve with what is not known of it, and the record.

use hysteron_core::msg;
use std::f64::consts::TAU;

use egui_plot::{Line, MarkerShape, PlotPoint, Points, Text};
use hysteron_core::tuning::measured::{MeasuredTuning, Point, Record};
use hysteron_work::tasks::MeasuredReport;

use super::super::draw::{CAPTION, curve, plot, series};
use crate::language::tr;
use crate::theme;
use crate::widgets::chart::{Shape, caption_ui};

/// Standard errors that are drawn.
const ERRORS: f64 = 2.0;

/// How far the plot reaches, in magnitudes of the point.
const REACH: f64 = 2.2;

/// Radius of the arc of the phase, in magnitudes of the point.
const ARC: f64 = 0.25;

/// Where the plant is at the frequency of the cycle.
pub fn nyquist_ui(ui: &mut egui::Ui, report: &MeasuredReport, height: f32) {
    let tuning = &report.tuning;
    let mut curves = Vec::new();
    if !report.nyquist.is_empty() {
        curves.push(("preferred model", theme::MODEL, Shape::Line));
    }
    if tuning.point.is_some() {
        curves.push((
            "measured point, 2 standard errors",
            theme::MEASURED,
            Shape::Diamond,
        ));
    }
    if tuning.ultimate.is_some() {
        curves.push(("-1/Ku", theme::EXACT, Shape::Square));
    }
    if curves.is_empty() {
        return;
    }
    caption_ui(ui, "", &curves);
    let chart = plot(
        "measured nyquist",
        height - CAPTION,
        "real part",
        "imaginary part",
    );
    let reach = tuning
        .point
        .map_or_else(|| largest(&report.nyquist), |p| REACH * p.magnitude);
    // As wide as it is high needs it, the origin to the right.
    let wide = 1.3 * reach * f64::from(ui.available_width() / (height - CAPTION).max(1.0));
    chart
        .with(|plot| {
            plot.data_aspect(1.0)
                .default_x_bounds(-0.7 * wide, 0.3 * wide)
                .default_y_bounds(-0.9 * reach, 0.4 * reach)
        })
        .show(ui, |plot| {
            if !report.nyquist.is_empty() {
                plot.line(
                    Line::new(tr("preferred model"), curve(&report.nyquist))
                        .color(theme::MODEL)
                        .width(2.0),
                );
            }
            if let Some(point) = &tuning.point {
                plot.line(
                    Line::new(tr("2 standard errors"), curve(&region(point)))
                        .color(theme::MEASURED)
                        .width(1.5),
                );
                let value = point.value();
                let [ray, arc] = phase(point);
                for drawn in [ray, arc] {
                    plot.line(
                        Line::new(tr("phase"), curve(&drawn))
                            .color(theme::MEASURED)
                            .width(1.0)
                            .allow_hover(false),
                    );
                }
                let [x, y] = polar(1.5 * ARC * point.magnitude, 0.5 * point.phase_deg);
                plot.text(
                    Text::new(
                        tr("phase"),
                        PlotPoint::new(x, y),
                        format!("{:.0}°", point.phase_deg),
                    )
                    .color(theme::MEASURED)
                    .allow_hover(false),
                );
                plot.points(
                    Points::new(tr("measured point"), curve(&[[value.re, value.im]]))
                        .color(theme::MEASURED)
                        .radius(6.0)
                        .shape(MarkerShape::Diamond),
                );
            }
            if let Some(ultimate) = &tuning.ultimate {
                plot.points(
                    Points::new(tr("-1/Ku"), curve(&[[-1.0 / ultimate.gain, 0.0]]))
                        .color(theme::EXACT)
                        .radius(6.0)
                        .shape(MarkerShape::Square),
                );
            }
        });
}

/// The ray to the point, and the arc of its phase from the positive real axis.
fn phase(point: &Point) -> [Vec<[f64; 2]>; 2] {
    let value = point.value();
    let arc = (0..=48).map(|i| polar(ARC * point.magnitude, point.phase_deg * f64::from(i) / 48.0));
    [vec![[0.0, 0.0], [value.re, value.im]], arc.collect()]
}

/// Within which magnitudes and phases it lies.
fn region(point: &Point) -> Vec<[f64; 2]> {
    (0..=72)
        .map(|i| TAU * f64::from(i) / 72.0)
        .map(|turn| {
            let magnitude = point.magnitude + ERRORS * point.std_error_magnitude * turn.cos();
            let phase = point.phase_deg + ERRORS * point.std_error_phase_deg * turn.sin();
            polar(magnitude.max(0.0), phase)
        })
        .collect()
}

/// A complex number of this magnitude and phase.
fn polar(magnitude: f64, phase_deg: f64) -> [f64; 2] {
    let (sin, cos) = phase_deg.to_radians().sin_cos();
    [magnitude * cos, magnitude * sin]
}

/// The largest part of any point.
fn largest(points: &[[f64; 2]]) -> f64 {
    let size = |p: &[f64; 2]| p[0].abs().max(p[1].abs());
    points.iter().map(size).fold(0.0, f64::max)
}

/// Output, thresholds, and the input between the ends of the output.
pub fn record_ui(ui: &mut egui::Ui, record: &Record, tuning: &MeasuredTuning, height: f32) {
    let ends = |values: &[f64]| {
        let fold = |f: fn(f64, f64) -> f64, start| values.iter().copied().fold(start, f);
        [
            fold(f64::min, f64::INFINITY),
            fold(f64::max, f64::NEG_INFINITY),
        ]
    };
    let ([low, high], [down, up]) = (ends(&record.output), ends(&record.input));
    let scale = (high - low) / (up - down).max(f64::MIN_POSITIVE);
    let input: Vec<[f64; 2]> = steps(record)
        .map(|[t, u]| [t, low + scale * (u - down)])
        .collect();
    let curves = [
        ("output y", theme::MEASURED, Shape::Line),
        ("input u, scaled to the output", theme::INPUT, Shape::Line),
    ];
    caption_ui(ui, "", &curves);
    let axis = msg!("{} [{}]", "output y", &tuning.output_unit);
    plot("measured test", height - CAPTION, "time [s]", axis).show(ui, |plot| {
        plot.line(
            Line::new(tr("input u, scaled to the output"), curve(&input))
                .color(theme::INPUT)
                .width(1.0),
        );
        plot.line(
            Line::new(tr("output y"), series(&record.time, &record.output))
                .color(theme::MEASURED)
                .width(2.0),
        );
    });
}

/// The held input as corners.
fn steps(record: &Record) -> impl Iterator<Item = [f64; 2]> + '_ {
    let before = record.input.first().into_iter().chain(&record.input);
    let pairs = record.time.iter().zip(before).zip(&record.input);
    pairs
        .filter(|((_, before), now)| before != now)
        .flat_map(|((t, before), now)| [[*t, *before], [*t, *now]])
        .chain(
            record
                .time
                .last()
                .copied()
                .zip(record.input.last().copied())
                .map(|(t, u)| [t, u]),
        )
}
