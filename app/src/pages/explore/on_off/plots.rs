//! The plots of an on-off loop: output, input, and the curves of the describing function.

use egui_plot::{HLine, Line, LineStyle, MarkerShape, Points};
use hysteron_core::on_off::{OnOffData, OnOffInput, Position};

use crate::language::tr;
use crate::theme;
use crate::widgets::chart::{Chart, Shape, caption_ui, curve, still};

/// Share of the height of both that the output has.
const OUTPUT: f32 = 0.62;

/// Space for the captions, points.
const CAPTION: f32 = 34.0;

/// Least width of the labels of y, points: both times stand below each other.
const LABELS: f32 = 62.0;

/// How far the curves are seen, in distances of their meeting from the origin.
const FAR: f64 = 2.5;

/// The plots that show the moment at which one of them is read.
fn moment() -> egui::Id {
    egui::Id::unique("moment_of_on_off")
}

/// Output above input.
pub fn time_ui(ui: &mut egui::Ui, input: &OnOffInput, data: &OnOffData, height: f32) {
    let height = height - CAPTION;
    caption_ui(
        ui,
        "Time",
        &[
            ("output y", theme::SIMULATED, Shape::Line),
            ("thresholds", theme::NOISE, Shape::Dashes),
            ("input u", theme::INPUT, Shape::Line),
        ],
    );
    let output: Vec<[f64; 2]> = (data.time.iter().zip(&data.output))
        .map(|(t, y)| [*t, *y])
        .collect();
    let chart = Chart::new("output", ["time [s]", "output y"], OUTPUT * height, LABELS)
        .still()
        .linked(moment());
    chart.show(ui, |plot| {
        plot.line(
            Line::new(tr("output y"), curve(&output))
                .color(theme::SIMULATED)
                .width(2.5),
        );
        for level in thresholds(input) {
            plot.hline(
                HLine::new(tr("threshold"), level)
                    .color(theme::NOISE)
                    .style(LineStyle::dashed_dense()),
            );
        }
    });
    let chart = Chart::new(
        "input",
        ["time [s]", "input u"],
        (1.0 - OUTPUT) * height,
        LABELS,
    )
    .still()
    .linked(moment());
    chart.show(ui, |plot| {
        plot.line(
            Line::new(tr("input u"), curve(&data.input))
                .color(theme::INPUT)
                .width(1.5),
        );
    });
}

/// Where the controller switches.
fn thresholds(input: &OnOffInput) -> Vec<f64> {
    let mut levels: Vec<f64> = [Position::Up, Position::Off, Position::Down]
        .into_iter()
        .filter(|p| input.relay.has_three_positions() || *p != Position::Off)
        .flat_map(|p| input.relay.guards(p))
        .filter(|level| level.is_finite())
        .collect();
    levels.sort_by(f64::total_cmp);
    levels.dedup();
    levels
}

/// Plant and `-1/N(A)`, where the describing function is known.
pub fn curves_ui(ui: &mut egui::Ui, data: &OnOffData, height: f32) {
    caption_ui(
        ui,
        "Nyquist plot",
        &[
            ("P(jω)", theme::MEASURED, Shape::Line),
            ("-1/N(a)", theme::DESCRIBING, Shape::Dashes),
        ],
    );
    let reach = reach(data);
    let plot = still("curves", "real part", "imaginary part", height - CAPTION)
        .fixed()
        .with(|plot| plot.data_aspect(1.0));
    plot.show(ui, |plot| {
        plot.set_plot_bounds_y(-reach..=0.5 * reach);
        plot.set_plot_bounds_x(-1.5 * reach..=reach);
        plot.line(
            Line::new(tr("plant P(jω)"), curve(&data.nyquist))
                .color(theme::MEASURED)
                .width(2.5),
        );
        plot.line(
            Line::new(tr("-1/N(a)"), curve(&data.inverse_df))
                .color(theme::DESCRIBING)
                .width(2.5)
                .style(LineStyle::dashed_loose()),
        );
        plot.points(
            Points::new(tr("predicted oscillation"), curve(&data.meetings))
                .color(theme::EXACT)
                .radius(7.0)
                .shape(MarkerShape::Diamond),
        );
    });
}

/// How far from the origin the curves are seen: around where they meet, or as near as they come to it.
fn reach(data: &OnOffData) -> f64 {
    let size = |p: &[f64; 2]| p[0].hypot(p[1]);
    let farthest = data.meetings.iter().map(size).fold(0.0, f64::max);
    if farthest > 0.0 {
        return FAR * farthest;
    }
    let nearest = data
        .inverse_df
        .iter()
        .map(size)
        .fold(f64::INFINITY, f64::min);
    let plant = data.nyquist.iter().map(size).fold(0.0, f64::max);
    let seen = (FAR * nearest).min(plant);
    if seen > 0.0 && seen.is_finite() {
        seen
    } else {
        1.0
    }
}
