//! The plots of a servo: position, torque, and where the cycle is in the plane of both.

use egui_plot::{HLine, Line, LineStyle};
use hysteron_core::hunting::{HuntingData, Servo};

use super::settings::DEGREES;
use super::words::cycle;
use crate::language::tr;
use crate::theme;
use crate::widgets::chart::{Shape, caption_ui, curve, still};
use crate::widgets::relay_loop::{phase_caption_ui, phase_lines};

/// Space for the caption, points.
const CAPTION: f32 = 34.0;

/// The plots that show the moment at which one of them is read.
fn moment() -> egui::Id {
    egui::Id::unique("moment_of_servo")
}

fn over_time(data: &HuntingData, values: &[f64], factor: f64) -> Vec<[f64; 2]> {
    let pairs = data.run.time.iter().zip(values);
    pairs.map(|(t, v)| [*t, factor * v]).collect()
}

pub fn position_ui(ui: &mut egui::Ui, servo: &Servo, data: &HuntingData, height: f32) {
    let play = servo.half_gap > 0.0;
    let mut keys = vec![
        ("measured position", theme::SIMULATED, Shape::Line),
        ("where it should be", theme::NOISE, Shape::Dashes),
    ];
    if play {
        keys.push(("motor, before the play", theme::RESIDUAL, Shape::Line));
    }
    caption_ui(ui, "Time", &keys);
    let measured = over_time(data, &data.run.measured, DEGREES);
    let motor = over_time(data, &data.run.position, DEGREES);
    let chart = still("position", "time [s]", "position [°]", height - CAPTION);
    chart.linked(moment()).show(ui, |plot| {
        if play {
            plot.line(
                Line::new(tr("motor"), curve(&motor))
                    .color(theme::RESIDUAL)
                    .width(1.5),
            );
        }
        plot.line(
            Line::new(tr("measured position"), curve(&measured))
                .color(theme::SIMULATED)
                .width(2.5),
        );
        plot.hline(
            HLine::new(tr("where it should be"), servo.reference * DEGREES)
                .color(theme::NOISE)
                .style(LineStyle::dashed_dense()),
        );
    });
}

pub fn torque_ui(ui: &mut egui::Ui, servo: &Servo, data: &HuntingData, height: f32) {
    let breakaway = servo.friction.breakaway();
    caption_ui(
        ui,
        "Torque",
        &[
            ("of the controller", theme::INPUT, Shape::Line),
            ("friction at rest", theme::NOISE, Shape::Dashes),
        ],
    );
    let torque = over_time(data, &data.run.input, 1.0);
    let chart = still("torque", "time [s]", "torque [N m]", height - CAPTION);
    chart.linked(moment()).show(ui, |plot| {
        plot.line(
            Line::new(tr("of the controller"), curve(&torque))
                .color(theme::INPUT)
                .width(2.0),
        );
        for level in [breakaway, -breakaway] {
            plot.hline(
                HLine::new(tr("friction at rest"), level)
                    .color(theme::NOISE)
                    .style(LineStyle::dashed_dense()),
            );
        }
    });
}

/// Velocity over position, with the last period.
pub fn phase_ui(ui: &mut egui::Ui, data: &HuntingData, height: f32) {
    phase_caption_ui(ui);
    let run = &data.run;
    let places: Vec<[f64; 2]> = (run.position.iter().zip(&run.velocity))
        .map(|(x, v)| [DEGREES * x, DEGREES * v])
        .collect();
    let end = run.time.last().copied().unwrap_or(0.0);
    let last = cycle(data).map(|c| run.time.partition_point(|t| *t < end - 1.01 * c.period));
    let chart = still(
        "servo_phase",
        "motor [°]",
        "velocity [°/s]",
        height - CAPTION,
    );
    chart.show(ui, |plot| {
        phase_lines(plot, &places, last.and_then(|from| places.get(from..)));
    });
}
