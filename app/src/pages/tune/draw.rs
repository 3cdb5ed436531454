//! What the steps draw alike.

use egui_plot::{Line, LineStyle, PlotPoints};
use hysteron_core::message::{Message, signed};
use hysteron_core::tuning::{Pid, RelayTest};
use hysteron_core::uncertain::digits;

use crate::language::tr;
use crate::theme;
use crate::widgets::chart::{Chart, Shape, caption_ui};

/// Colour of what was before.
pub const BEFORE: egui::Color32 = theme::RESIDUAL;
/// Colour of what comes after.
pub const AFTER: egui::Color32 = theme::EXACT;

/// A value with four significant digits.
pub fn number(value: f64) -> String {
    digits(value, 4)
}

/// A value that may be missing.
pub fn maybe(value: Option<f64>, otherwise: &'static str) -> Message {
    value.map_or_else(|| otherwise.into(), |value| number(value).into())
}

/// A relative error in words.
pub fn error(value: Option<f64>) -> Message {
    let error = value.map(|e| format!("{} %", signed(100.0 * e, 1)));
    error.unwrap_or_default().into()
}

/// The controller's settings.
pub fn controller(pid: &Pid) -> String {
    let mut parts = vec![format!("K = {}", number(pid.gain))];
    if let Some(ti) = pid.integral_time {
        parts.push(format!("Ti = {} s", number(ti)));
    }
    if pid.derivative_time > 0.0 {
        parts.push(format!("Td = {} s", number(pid.derivative_time)));
    }
    parts.join(", ")
}

/// Height of the caption of a plot, points.
pub const CAPTION: f32 = 26.0;

/// An empty plot with named axes; the wheel scrolls the page.
pub fn plot<'a>(id: &str, height: f32, x: &'static str, y: impl Into<Message>) -> Chart<'a> {
    Chart::new(id, [x.into(), y.into()], height, 0.0)
}

/// Points as a curve.
pub fn curve(points: &[[f64; 2]]) -> PlotPoints<'static> {
    points.iter().copied().collect()
}

/// Values over time.
pub fn series(time: &[f64], values: &[f64]) -> PlotPoints<'static> {
    time.iter().zip(values).map(|(t, v)| [*t, *v]).collect()
}

/// What is held between changes, as a staircase up to `end`.
pub fn staircase(changes: &[[f64; 2]], end: f64) -> PlotPoints<'static> {
    let ends = changes.iter().skip(1).map(|c| c[0]).chain([end]);
    changes
        .iter()
        .zip(ends)
        .flat_map(|(c, next)| [*c, [next, c[1]]])
        .collect()
}

/// Output, input and thresholds of a relay run.
pub fn run_ui(ui: &mut egui::Ui, id: &str, test: &RelayTest, height: f32) {
    let end = test.run.time.last().copied().unwrap_or(0.0);
    let curves = [
        ("output y", theme::SIMULATED, Shape::Line),
        ("input u", theme::INPUT, Shape::Line),
        ("threshold ±ε", theme::NOISE, Shape::Dashes),
    ];
    caption_ui(ui, "", &curves);
    plot(id, height - CAPTION, "time [s]", "output y, input u").show(ui, |plot| {
        plot.line(
            Line::new(tr("input u"), staircase(&test.run.input, end))
                .color(theme::INPUT)
                .width(1.2),
        );
        for eps in [test.relay.hysteresis, -test.relay.hysteresis] {
            plot.line(
                Line::new(tr("threshold ±ε"), curve(&[[0.0, eps], [end, eps]]))
                    .color(theme::NOISE)
                    .style(LineStyle::dashed_dense()),
            );
        }
        plot.line(
            Line::new(tr("output y"), series(&test.run.time, &test.run.output))
                .color(theme::SIMULATED)
                .width(2.5),
        );
    });
}

/// Two views side by side, or below each other where there is no room.
pub fn beside(
    ui: &mut egui::Ui,
    height: f32,
    first: impl FnOnce(&mut egui::Ui, f32),
    second: impl FnOnce(&mut egui::Ui, f32),
) {
    if ui.available_width() < 600.0 {
        first(ui, height);
        second(ui, height);
    } else {
        ui.columns_const(|[left, right]| {
            first(left, height);
            second(right, height);
        });
    }
}

/// Width of the heads of a table that is set tight, points.
const HEAD: f32 = 102.0;

/// What stands in a table; at this width it goes on in the next line.
pub fn cell(ui: &mut egui::Ui, width: Option<f32>, content: impl egui::Widget) -> egui::Response {
    let Some(width) = width else {
        return ui.add(content);
    };
    ui.scope(|ui| {
        ui.set_max_width(width);
        ui.style_mut().wrap_mode = Some(egui::TextWrapMode::Wrap);
        ui.add(content)
    })
    .inner
}

/// A table with a heading; wider than the window, it can be scrolled.
pub fn table(
    ui: &mut egui::Ui,
    id: &str,
    heads: &[&'static str],
    rows: impl FnOnce(&mut egui::Ui),
) {
    set_table(ui, id, heads, false, rows);
}

/// The same; set tight, it saves room.
pub fn set_table(
    ui: &mut egui::Ui,
    id: &str,
    heads: &[&'static str],
    tight: bool,
    rows: impl FnOnce(&mut egui::Ui),
) {
    egui::ScrollArea::horizontal().id_salt(id).show(ui, |ui| {
        egui::Grid::new(id)
            .striped(true)
            .spacing([if tight { 6.0 } else { 14.0 }, 4.0])
            .show(ui, |ui| {
                for head in heads {
                    let head = egui::Label::new(egui::RichText::new(tr(*head)).strong());
                    cell(ui, tight.then_some(HEAD), head);
                }
                ui.end_row();
                rows(ui);
            });
    });
}
