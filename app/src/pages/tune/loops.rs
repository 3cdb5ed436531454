//! Step 6: the loop before and after.

use egui_plot::{Line, LineStyle, MarkerShape, Points};
use hysteron_core::counted;
use hysteron_core::message::{Message, fixed};
use hysteron_core::msg;
use hysteron_core::tuning::{LoopReport, Response, TuningReport};
use hysteron_core::uncertain::significant;

use super::draw::{
    AFTER, BEFORE, CAPTION, beside, controller, curve, maybe, number, plot, series, table,
};
use super::stage::{Seen, Stage};
use crate::export::Table;
use crate::language::tr;
use crate::theme;
use crate::widgets::chart::{Key, Shape, caption_ui, sparse};

pub const STAGE: Stage = Stage {
    id: "loops",
    title: "Before and after",
    question: "Is the loop better now?",
    answer,
    next: "Could the machine have backlash? Find the gap from the motor alone.",
    plot: step_ui,
    ui,
};

fn answer(seen: Seen<'_>) -> Message {
    let report = seen.report;
    let before = &report.before;
    let after = match &report.after {
        Ok(after) => after,
        Err(error) => return msg!("There is no tuned loop: {}.", error),
    };
    match (before.margins, after.margins) {
        (_, None) => "No: the tuned loop is unstable. Take another rule.".into(),
        (None, Some(m)) => msg!(
            "It was unstable; now it is stable, with Ms = {}.",
            fixed(m.max_sensitivity, 2)
        ),
        (Some(old), Some(new)) => msg!(
            "In the {} s after a load step the error now adds up to {} s instead of {} s; Ms is {} instead of {}.",
            significant(report.horizon, 2),
            number(after.load.iae),
            number(before.load.iae),
            fixed(new.max_sensitivity, 2),
            fixed(old.max_sensitivity, 2)
        ),
    }
}

fn ui(ui: &mut egui::Ui, seen: Seen<'_>, height: f32, _rule: &mut String) {
    let report = seen.report;
    let after = report.after.as_ref().ok();
    ui.label(tr(msg!(
        "Before: {}. After: {}.",
        controller(&report.before.pid),
        after.map_or_else(|| "none".into(), |a| Message::from(controller(&a.pid)))
    )));
    let half = (0.5 * height - 16.0).max(200.0);
    beside(
        ui,
        half,
        |ui, height| {
            if !seen.pinned {
                step_ui(ui, seen, height);
            }
        },
        |ui, height| {
            let name = ["load response", "output y, load 1"];
            response_ui(ui, name, &report.before, after, |l| &l.load, height);
        },
    );
    beside(
        ui,
        half,
        |ui, height| nyquist_ui(ui, &report.before, after, height),
        |ui, _| table_ui(ui, &report.before, after, report.horizon),
    );
}

/// The response to a step of the set point, before and after.
pub fn step_ui(ui: &mut egui::Ui, seen: Seen<'_>, height: f32) {
    let name = ["step response", "output y, set point 1"];
    let after = seen.report.after.as_ref().ok();
    let before = &seen.report.before;
    response_ui(ui, name, before, after, |l| &l.set_point, height);
}

/// Names of [`tables`]; the last two where a tuned loop is there.
const TABLES: [&str; 4] = [
    "step response before",
    "load response before",
    "step response after",
    "load response after",
];

/// Names of the tables that this step gives.
pub fn table_names(report: &TuningReport) -> Vec<&'static str> {
    let loops = if report.after.is_ok() { 2 } else { 1 };
    TABLES.into_iter().take(2 * loops).collect()
}

/// The responses that this step shows.
pub fn tables(report: &TuningReport) -> Vec<Table> {
    let loops = [Some(&report.before), report.after.as_ref().ok()];
    let responses = loops.into_iter().flatten();
    let responses = responses.flat_map(|l| [&l.set_point, &l.load]);
    let table = |(name, response): (&'static str, &Response)| {
        Table::new(name)
            .with("time [s]", response.time.iter().copied())
            .with("output y", response.output.iter().copied())
    };
    TABLES.into_iter().zip(responses).map(table).collect()
}

fn response_ui(
    ui: &mut egui::Ui,
    [id, axis]: [&'static str; 2],
    before: &LoopReport,
    after: Option<&LoopReport>,
    part: fn(&LoopReport) -> &Response,
    height: f32,
) {
    // An unstable loop grows without bounds; the other one is what can be read.
    let stable = |l: &&LoopReport| l.margins.is_some();
    let top = [Some(before), after]
        .into_iter()
        .flatten()
        .filter(stable)
        .map(|l| part(l).peak)
        .fold(0.0, f64::max);
    let top = if top > 0.0 { 1.1 * top } else { 2.0 };
    let end = part(before).time.last().copied().unwrap_or(1.0);
    let bottom = if before.margins.is_some() { -0.1 } else { -0.5 } * top;
    let curves = curves(after.is_some());
    caption_ui(ui, "", &curves);
    plot(id, height - CAPTION, "time [s]", axis)
        .with(|plot| {
            plot.default_x_bounds(0.0, end)
                .default_y_bounds(bottom, top)
        })
        .linked(egui::Id::unique("responses"))
        .show(ui, |plot| {
            let response = part(before);
            let times = response.time.iter().zip(&response.output);
            let points: Vec<[f64; 2]> = times.map(|(t, y)| [*t, *y]).collect();
            plot.line(
                Line::new(tr("before"), sparse(&points))
                    .color(BEFORE)
                    .width(2.0)
                    .style(LineStyle::dashed_loose()),
            );
            if let Some(response) = after.map(part) {
                plot.line(
                    Line::new(tr("after"), series(&response.time, &response.output))
                        .color(AFTER)
                        .width(2.5),
                );
            }
        });
}

/// The curves of both loops.
fn curves(tuned: bool) -> Vec<Key> {
    let mut curves = vec![("before", BEFORE, Shape::Dashes)];
    if tuned {
        curves.push(("after", AFTER, Shape::Line));
    }
    curves
}

fn nyquist_ui(ui: &mut egui::Ui, before: &LoopReport, after: Option<&LoopReport>, height: f32) {
    let mut curves = curves(after.is_some());
    curves.push(("unit circle", theme::NOISE, Shape::Dashes));
    curves.push(("-1", theme::MODEL, Shape::Cross));
    caption_ui(ui, "", &curves);
    plot(
        "loop nyquist",
        height - CAPTION,
        "real part",
        "imaginary part",
    )
    .with(|plot| {
        plot.data_aspect(1.0)
            .default_x_bounds(-2.2, 0.8)
            .default_y_bounds(-1.6, 0.6)
    })
    .show(ui, |plot| {
        let circle: Vec<[f64; 2]> = (0..=120)
            .map(|i| std::f64::consts::TAU * f64::from(i) / 120.0)
            .map(|t| [t.cos(), t.sin()])
            .collect();
        plot.line(
            Line::new(tr("unit circle"), curve(&circle))
                .color(theme::NOISE.gamma_multiply(0.6))
                .width(1.0)
                .style(LineStyle::dashed_dense()),
        );
        plot.line(
            Line::new(tr("before"), curve(&before.nyquist))
                .color(BEFORE)
                .width(2.0)
                .style(LineStyle::dashed_loose()),
        );
        if let Some(after) = after {
            plot.line(
                Line::new(tr("after"), curve(&after.nyquist))
                    .color(AFTER)
                    .width(2.5),
            );
        }
        plot.points(
            Points::new(tr("-1"), curve(&[[-1.0, 0.0]]))
                .color(theme::MODEL)
                .radius(6.0)
                .shape(MarkerShape::Cross),
        );
    });
}

fn table_ui(ui: &mut egui::Ui, before: &LoopReport, after: Option<&LoopReport>, horizon: f64) {
    let [before_color, after_color] = [BEFORE, AFTER].map(|c| theme::readable(ui, c));
    table(ui, "loops", &["", "before", "after"], |ui| {
        let mut row = |name: &'static str, value: &dyn Fn(&LoopReport) -> Message| {
            ui.label(tr(name));
            ui.colored_label(before_color, tr(value(before)));
            ui.colored_label(after_color, tr(after.map_or_else(Message::default, value)));
            ui.end_row();
        };
        row("stable", &|l| match l.unstable_poles {
            0 => "yes".into(),
            n => msg!(
                "no: {} in the right half-plane",
                counted!(n, "1 pole", "{} poles")
            ),
        });
        row("gain margin", &|l| {
            l.margins
                .map_or_else(dash, |m| maybe(m.gain_margin, "infinite"))
        });
        row("phase margin [°]", &|l| {
            l.margins.map_or_else(dash, |m| {
                maybe(m.phase_margin.map(f64::to_degrees), "infinite")
            })
        });
        row("delay margin [s]", &|l| {
            l.margins
                .map_or_else(dash, |m| maybe(m.delay_margin, "infinite"))
        });
        row("sensitivity Ms", &|l| {
            l.margins
                .map_or_else(dash, |m| number(m.max_sensitivity).into())
        });
        row("overshoot [%]", &|l| {
            stable(l, format!("{:.0}", 100.0 * l.set_point.overshoot))
        });
        row("settled after [s]", &|l| {
            maybe(l.set_point.settling_time, "not yet")
        });
        row("load error [s]", &|l| stable(l, number(l.load.iae)));
        row("load peak", &|l| stable(l, number(l.load.peak)));
    });
    ui.small(tr(msg!(
        "Load error: integral of |y| over the {} s shown. Without integral action it grows with the time.",
        number(horizon)
    )));
}

fn dash() -> Message {
    "-".into()
}

fn stable(report: &LoopReport, text: impl Into<Message>) -> Message {
    report.margins.map_or_else(dash, |_| text.into())
}
