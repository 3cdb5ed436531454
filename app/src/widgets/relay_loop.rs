//! The plots of a relay loop, with the place that the playback has reached, and the numbers behind them.

use egui_plot::{HLine, Line, LineStyle, PlotPoints, VLine};
use hysteron_core::explore::ExploreData;
use hysteron_core::relay::Relay;

use crate::export::Table;
use crate::language::tr;
use crate::theme;
use crate::widgets::chart::{Pen, Shape, caption_ui, curve, dot, still};
use crate::widgets::chart_cursor::{mark_ui, point, pointed};

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

/// Colour of the way to the cycle.
fn on_the_way() -> egui::Color32 {
    theme::SIMULATED.gamma_multiply(0.6)
}

/// The caption of a phase portrait.
pub fn phase_caption_ui(ui: &mut egui::Ui) {
    caption_ui(
        ui,
        "Phase portrait",
        &[
            ("from the start", on_the_way(), Shape::Line),
            ("limit cycle", theme::EXACT, Shape::Line),
        ],
    );
}

/// Its lines: all that was passed, and the cycle where there is one.
pub fn phase_lines(plot: &mut Pen<'_, '_>, passed: &[[f64; 2]], cycle: Option<&[[f64; 2]]>) {
    plot.line(
        Line::new(tr("from the start"), curve(passed))
            .color(on_the_way())
            .width(1.2),
    );
    if let Some(cycle) = cycle {
        plot.line(
            Line::new(tr("limit cycle"), curve(cycle))
                .color(theme::EXACT)
                .width(3.0),
        );
    }
}

pub fn phase_ui(ui: &mut egui::Ui, data: &ExploreData, clock: f64, height: f32) {
    phase_caption_ui(ui);
    let now = data.phase.get(index_at(data, clock)).copied();
    let shown = still("phase", "output y", "its rate of change [1/s]", height).show(ui, |plot| {
        let cycle = data.simulated.map(|_| &*data.cycle);
        phase_lines(plot, &data.phase, cycle);
        if let Some(now) = now {
            plot.points(dot("now", now));
        }
        // A cycle passes a place again and again: the first time counts.
        let passed = plot.pointed_among(&data.phase);
        passed.and_then(|i| data.time.get(i).copied())
    });
    point(ui.ctx(), moment(), shown.response.id, shown.inner);
    if let Some((_, time)) = pointed(ui.ctx(), moment())
        && let Some(at) = data.phase.get(index_at(data, time))
    {
        mark_ui(ui, &shown.transform, *at);
    }
}

/// The plots that show the moment that one of them is pointed at.
fn moment() -> egui::Id {
    egui::Id::unique("moment_of_loop")
}

pub fn time_ui(ui: &mut egui::Ui, relay: &Relay, data: &ExploreData, clock: f64, height: f32) {
    caption_ui(
        ui,
        "Time",
        &[
            ("output y", theme::SIMULATED, Shape::Line),
            ("input u", theme::INPUT, Shape::Line),
            ("thresholds ±ε", theme::NOISE, Shape::Dashes),
        ],
    );
    let i = index_at(data, clock);
    let now = data.time.get(i).zip(data.output.get(i));
    let chart = still("time", "time [s]", "output y, input u", height).linked(moment());
    chart.show(ui, |plot| {
        plot.line(
            Line::new(tr("input u"), curve(&data.input))
                .color(theme::INPUT)
                .width(1.2),
        );
        let output: PlotPoints<'_> = data
            .time
            .iter()
            .zip(&data.output)
            .map(|(t, y)| [*t, *y])
            .collect();
        plot.line(
            Line::new(tr("output y"), output)
                .color(theme::SIMULATED)
                .width(2.5),
        );
        for eps in [relay.hysteresis, -relay.hysteresis] {
            plot.hline(
                HLine::new(tr("±ε"), eps)
                    .color(theme::NOISE)
                    .style(LineStyle::dashed_dense()),
            );
        }
        if let Some((t, y)) = now {
            plot.vline(
                VLine::new(tr("now"), *t)
                    .color(theme::MODEL.gamma_multiply(0.7))
                    .width(1.0),
            );
            plot.points(dot("now", [*t, *y]));
        }
    });
}

/// Names of [`tables`].
pub const TABLES: [&str; 5] = [
    "time series",
    "relay input",
    "phase portrait",
    "limit cycle",
    "Nyquist curve",
];

/// The numbers behind the plots.
pub fn tables(data: &ExploreData) -> Vec<Table> {
    let [y, rate] = ["output y", "its rate of change [1/s]"];
    vec![
        Table::new(TABLES[0])
            .with("time [s]", data.time.iter().copied())
            .with(y, data.output.iter().copied()),
        Table::curve(TABLES[1], ["time [s]", "input u"], &data.input),
        Table::curve(TABLES[2], [y, rate], &data.phase),
        Table::curve(TABLES[3], [y, rate], &data.cycle),
        Table::curve(TABLES[4], ["real part", "imaginary part"], &data.nyquist)
            .with("frequency [rad/s]", data.nyquist_frequency.iter().copied()),
    ]
}
