//! Steps of set point and load on the preferred model, with a controller and without.

use egui_plot::{Line, LineStyle};
use hysteron_core::msg;
use hysteron_core::tuning::Response;
use hysteron_core::tuning::measured::TunedGains;

use super::super::draw::{AFTER, BEFORE, CAPTION, beside, plot, series};
use crate::language::tr;
use crate::widgets::chart::{Shape, caption_ui};

/// Both steps.
pub fn ui(
    ui: &mut egui::Ui,
    gains: &TunedGains,
    [set_point, load]: &[Response; 2],
    alone: Option<&Response>,
    height: f32,
) {
    ui.add_space(6.0);
    let name = format!("{} {}", gains.name, gains.controller.to_uppercase());
    ui.strong(tr(msg!("The preferred model with {}, simulated", name)));
    // Without a controller the input is set once so that the output ends where the set point is.
    let gain = alone.and_then(|a| a.output.last().copied());
    let settles = gain.filter(|g| g.is_finite() && *g != 0.0);
    let stepped: Option<Vec<f64>> = alone
        .zip(settles)
        .map(|(a, g)| a.output.iter().map(|y| y / g).collect());
    let without: Option<&[f64]> = alone.map(|a| a.output.as_slice());
    beside(
        ui,
        height,
        |ui, height| {
            response_ui(
                ui,
                ["measured step", "output y, set point 1"],
                set_point,
                stepped.as_deref(),
                height,
            );
        },
        |ui, height| {
            response_ui(
                ui,
                ["measured load", "output y, load 1"],
                load,
                without,
                height,
            );
        },
    );
}

fn response_ui(
    ui: &mut egui::Ui,
    [id, axis]: [&'static str; 2],
    with: &Response,
    without: Option<&[f64]>,
    height: f32,
) {
    let mut curves = vec![("with the controller", AFTER, Shape::Line)];
    if without.is_some() {
        curves.push(("without", BEFORE, Shape::Dashes));
    }
    caption_ui(ui, "", &curves);
    plot(id, height - CAPTION, "time [s]", axis).show(ui, |plot| {
        if let Some(without) = without {
            plot.line(
                Line::new(tr("without"), series(&with.time, without))
                    .color(BEFORE)
                    .width(2.0)
                    .style(LineStyle::dashed_loose()),
            );
        }
        plot.line(
            Line::new(tr("with the controller"), series(&with.time, &with.output))
                .color(AFTER)
                .width(2.5),
        );
    });
}
