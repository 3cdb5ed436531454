//! Time series and phase portrait, with the place that the playback has reached.

use egui_plot::{
    AxisHints, HLine, Line, LineStyle, Plot, PlotPoints, Points, VLine, uniform_grid_spacer,
};
use hysteron_core::explore::ExploreData;
use hysteron_core::relay::Relay;

use crate::theme;

/// Points between labels of an axis, where they begin to show and where they are full.
const LABELS: egui::Rangef = egui::Rangef {
    min: 28.0,
    max: 40.0,
};

pub fn curve(points: &[[f64; 2]]) -> PlotPoints<'static> {
    points.iter().copied().collect()
}

/// A plot that shows its data and stays where it is.
pub fn still(name: &'static str, x: &'static str, y: &'static str, height: f32) -> Plot<'static> {
    Plot::new(name)
        .height(height)
        .custom_x_axes(vec![AxisHints::new_x().label(x).label_spacing(LABELS)])
        .custom_y_axes(vec![AxisHints::new_y().label(y).label_spacing(LABELS)])
        .x_grid_spacer(uniform_grid_spacer(|input| grid(input.bounds)))
        .y_grid_spacer(uniform_grid_spacer(|input| grid(input.bounds)))
        .allow_scroll(false)
        .allow_zoom(false)
        .allow_boxed_zoom(false)
        .allow_axis_zoom_drag(false)
        .allow_drag(false)
}

/// Grid lines at 1, 2 or 5 times a power of ten, some seven across, with a finer and a coarser set.
fn grid(bounds: (f64, f64)) -> [f64; 3] {
    let wanted = ((bounds.1 - bounds.0) / 7.0).max(f64::MIN_POSITIVE);
    let decade = 10_f64.powf(wanted.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0]
        .into_iter()
        .find(|s| s * decade >= wanted)
        .map_or(wanted, |s| s * decade);
    [0.5 * step, step, 10.0 * step]
}

/// Names of the curves in their colours, above a plot: they hide nothing.
pub fn caption_ui(ui: &mut egui::Ui, title: &str, curves: &[(&str, egui::Color32)]) {
    ui.horizontal(|ui| {
        ui.strong(title);
        for (name, color) in curves {
            let (rect, _) = ui.allocate_exact_size(egui::vec2(14.0, 4.0), egui::Sense::hover());
            ui.painter().rect_filled(rect, 1.0, *color);
            ui.label(*name);
        }
    });
}

/// Index of the sample at a time.
fn index_at(data: &ExploreData, clock: f64) -> usize {
    let after = data.time.partition_point(|t| *t <= clock);
    after.saturating_sub(1)
}

/// Amplitude that the output has reached at a time, between those at its extrema.
pub fn swing_at(data: &ExploreData, clock: f64) -> Option<f64> {
    let after = data.swing.partition_point(|s| s[0] <= clock);
    let next = data.swing.get(after);
    let before = after.checked_sub(1).and_then(|i| data.swing.get(i));
    match (before, next) {
        (Some(b), Some(n)) => Some(b[1] + (n[1] - b[1]) * (clock - b[0]) / (n[0] - b[0])),
        (Some(only), None) | (None, Some(only)) => Some(only[1]),
        (None, None) => None,
    }
}

pub fn phase_ui(ui: &mut egui::Ui, data: &ExploreData, clock: f64, height: f32) {
    let start = theme::SIMULATED.gamma_multiply(0.6);
    caption_ui(
        ui,
        "Phase portrait",
        &[("from the start", start), ("limit cycle", theme::EXACT)],
    );
    let now = data.phase.get(index_at(data, clock)).copied();
    still("phase", "output y", "its rate dy/dt [1/s]", height).show(ui, |plot| {
        plot.line(
            Line::new("from the start", curve(&data.phase))
                .color(start)
                .width(1.2),
        );
        if data.simulated.is_some() {
            plot.line(
                Line::new("limit cycle", curve(&data.cycle))
                    .color(theme::EXACT)
                    .width(3.0),
            );
        }
        if let Some(now) = now {
            plot.points(dot("now", now));
        }
    });
}

/// The place that the playback has reached.
pub fn dot(name: &'static str, at: [f64; 2]) -> Points<'static> {
    Points::new(name, vec![at]).color(theme::MODEL).radius(6.0)
}

pub fn time_ui(ui: &mut egui::Ui, relay: &Relay, data: &ExploreData, clock: f64, height: f32) {
    caption_ui(
        ui,
        "Time",
        &[
            ("output y", theme::SIMULATED),
            ("input u", theme::INPUT),
            ("thresholds ±ε", theme::NOISE),
        ],
    );
    let i = index_at(data, clock);
    let now = data.time.get(i).zip(data.output.get(i));
    still("time", "time [s]", "output y, input u", height).show(ui, |plot| {
        plot.line(
            Line::new("input u", curve(&data.input))
                .color(theme::INPUT)
                .width(1.2)
                .allow_band(false),
        );
        let output: PlotPoints<'_> = data
            .time
            .iter()
            .zip(&data.output)
            .map(|(t, y)| [*t, *y])
            .collect();
        plot.line(
            Line::new("output y", output)
                .color(theme::SIMULATED)
                .width(2.5),
        );
        for eps in [relay.hysteresis, -relay.hysteresis] {
            plot.hline(
                HLine::new("±ε", eps)
                    .color(theme::NOISE)
                    .style(LineStyle::dashed_dense()),
            );
        }
        if let Some((t, y)) = now {
            plot.vline(
                VLine::new("now", *t)
                    .color(theme::MODEL.gamma_multiply(0.7))
                    .width(1.0),
            );
            plot.points(dot("now", [*t, *y]));
        }
    });
}
