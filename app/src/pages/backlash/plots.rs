//! Positions over time, phase portrait and backlash map.

use egui::{Align2, Color32, Id, Ui};
use egui_plot::{
    Line, LineStyle, MarkerShape, PlotPoint, PlotResponse, Points, Polygon, Text, VLine,
};

use super::scene::{Now, Scene};
use crate::language::tr;
use crate::theme;
use crate::widgets::chart::{Shape, caption_ui, curve, dot, extremes, still};
use crate::widgets::chart_cursor::{mark_ui, pointed};

/// Periods of the relay that the phase portrait shows before the present one.
const PERIODS: f64 = 3.0;

/// Colour of the load.
pub const LOAD: Color32 = theme::NOISE;

/// Colour of contact.
pub const CONTACT: Color32 = theme::MODEL;

/// Colour of what the estimate has found.
const ESTIMATED: Color32 = theme::RESIDUAL;

/// Positions of motor and load; shaded where the motor pushes the load.
pub fn time_ui(ui: &mut Ui, scene: &Scene, clock: f64, height: f32) {
    let signature = scene.signature();
    let mut curves = vec![("motor x1", theme::MEASURED, Shape::Line)];
    if !scene.load.is_empty() {
        curves.push(("load x2", LOAD, Shape::Line));
    }
    curves.push(("motor pushes load", CONTACT, Shape::Area));
    if !signature.is_empty() {
        curves.push(("gap found by the motor", ESTIMATED, Shape::Diamond));
    }
    caption_ui(ui, "Positions", &curves);
    let [low, high] = scene.range;
    let chart = still("positions", "time [s]", "position [mrad]", height).linked(moment());
    chart.show(ui, |plot| {
        for [from, to] in scene.engagements() {
            let corners = vec![[from, low], [to, low], [to, high], [from, high]];
            plot.polygon(
                Polygon::new(tr("motor pushes load"), corners)
                    .fill_color(CONTACT.gamma_multiply(0.22))
                    .stroke((0.0, CONTACT)),
            );
        }
        plot.line(
            Line::new(tr("load x2"), curve(&scene.load))
                .color(LOAD)
                .width(2.5),
        );
        plot.line(
            Line::new(tr("motor x1"), curve(&scene.motor))
                .color(theme::MEASURED)
                .width(1.5),
        );
        for ends in &signature {
            plot.line(
                Line::new(tr("gap found by the motor"), ends.to_vec())
                    .color(ESTIMATED)
                    .style(LineStyle::dashed_loose())
                    .width(2.0),
            );
            plot.points(
                Points::new(tr("gap found by the motor"), ends.to_vec())
                    .color(ESTIMATED)
                    .shape(MarkerShape::Diamond)
                    .radius(6.0),
            );
        }
        plot.vline(VLine::new(tr("now"), clock).color(theme::INPUT).width(1.0));
    });
}

/// The plots that show the moment that the positions are pointed at.
pub fn moment() -> Id {
    Id::unique("moment_of_drive")
}

/// Plots whose x is the motor's position.
fn motor() -> Id {
    Id::unique("motor position")
}

/// Marks where a plot has the moment that is pointed at.
fn moment_ui<R>(
    ui: &Ui,
    scene: &Scene,
    shown: &PlotResponse<R>,
    place: impl Fn(Now) -> Option<[f64; 2]>,
) {
    let pointed = pointed(ui.ctx(), moment());
    let now = pointed.and_then(|(_, time)| scene.now(time));
    if let Some(at) = now.and_then(place) {
        mark_ui(ui, &shown.transform, at);
    }
}

/// Velocity over position of the motor, of the last periods before the moment that is pointed at, or else before now.
pub fn phase_ui(ui: &mut Ui, scene: &Scene, clock: f64, height: f32) {
    let span = PERIODS * scene.period();
    let pointed = pointed(ui.ctx(), moment()).map(|(_, time)| time.min(scene.duration()));
    // Before a few periods have passed, those to come are shown.
    let to = pointed.unwrap_or(clock).max(span);
    let points = scene.phase(to - span, to);
    let orbit = scene.orbit(to);
    let mut curves = vec![("last periods", theme::MEASURED, Shape::Line)];
    if orbit.is_some() {
        curves.push(("closed form in the gap", theme::INPUT, Shape::Dashes));
    }
    caption_ui(ui, "Phase portrait", &curves);
    let color = ui.visuals().text_color();
    let shown = still(
        "phase of the motor",
        "motor position x1 [mrad]",
        "velocity v1 [rad/s]",
        height,
    )
    .linked(motor())
    .show(ui, |plot| {
        plot.line(
            Line::new(tr("last periods"), curve(&points))
                .color(theme::MEASURED)
                .width(1.5),
        );
        if let Some(orbit) = &orbit {
            plot.line(
                Line::new(tr("closed form"), curve(&orbit.curve))
                    .color(theme::INPUT)
                    .style(LineStyle::dashed_dense())
                    .width(2.0),
            );
            plot.points(
                Points::new(tr("characteristic points"), orbit.corners.clone())
                    .color(theme::INPUT)
                    .radius(4.0),
            );
            for (place, label) in labels(&orbit.corners) {
                plot.text(
                    Text::new("characteristic points", place, label)
                        .anchor(Align2::CENTER_CENTER)
                        .color(color),
                );
            }
        }
        if let Some(now) = scene.now(clock).filter(|_| pointed.is_none()) {
            plot.points(dot("now", [now.x1, now.v1]));
        }
    });
    moment_ui(ui, scene, &shown, |now| Some([now.x1, now.v1]));
}

/// Distance of a number from its point, as a share of the orbit's size.
const LABEL_DISTANCE: f64 = 0.14;

/// Numbers of the characteristic points, outside of the orbit; one for points that coincide.
fn labels(corners: &[[f64; 2]]) -> Vec<(PlotPoint, String)> {
    let count = corners.len().max(1) as f64;
    let range = |k: usize| {
        let (low, high) = extremes(corners.iter().map(|c| c[k]));
        high - low
    };
    let size = [range(0), range(1)];
    let middle = [0, 1].map(|k| corners.iter().map(|c| c[k]).sum::<f64>() / count);
    let mut found: Vec<([f64; 2], String)> = Vec::new();
    for (i, corner) in corners.iter().enumerate() {
        let number = (i + 1).to_string();
        match found.last_mut() {
            Some((at, text)) if at == corner => {
                text.push_str(", ");
                text.push_str(&number);
            }
            _ => found.push((*corner, number)),
        }
    }
    found
        .into_iter()
        .map(|(at, text)| {
            let out = [0, 1].map(|k| (at[k] - middle[k]) / size[k].max(f64::MIN_POSITIVE));
            let length = out[0].hypot(out[1]).max(f64::MIN_POSITIVE);
            let place = [0, 1].map(|k| at[k] + LABEL_DISTANCE * size[k] * out[k] / length);
            (PlotPoint::new(place[0], place[1]), text)
        })
        .collect()
}

/// Load over motor position.
pub fn map_ui(ui: &mut Ui, scene: &Scene, clock: f64, height: f32) {
    if scene.map.is_empty() {
        ui.strong(tr("Backlash map"));
        ui.label(tr("The load was not measured: there is no map."));
        return;
    }
    let mut curves = vec![("x2 against x1", LOAD, Shape::Circle)];
    if scene.input().is_some() {
        curves.push(("ends of the gap", CONTACT, Shape::Dashes));
    }
    caption_ui(ui, "Backlash map", &curves);
    let [low, high] = scene.range;
    let load = scene.load_range;
    let chart = still("map", "motor x1 [mrad]", "load x2 [mrad]", height).linked(motor());
    let shown = chart.show(ui, |plot| {
        plot.points(
            Points::new(tr("x2 against x1"), curve(&scene.map))
                .color(LOAD)
                .radius(1.2),
        );
        // A measured load has no zero in common with the motor.
        if let (Some(beta), Some(_)) = (scene.half_gap(), scene.input()) {
            for side in [-1.0, 1.0] {
                // No longer than the branch that lies on it.
                let ends = [
                    low.max(load[0] + side * beta),
                    high.min(load[1] + side * beta),
                ];
                let edge = ends.map(|x| [x, x - side * beta]).to_vec();
                plot.line(
                    Line::new(tr("ends of the gap"), edge)
                        .color(CONTACT)
                        .style(LineStyle::dashed_dense()),
                );
            }
        }
        if let Some(now) = scene.now(clock)
            && let Some(x2) = now.x2
        {
            plot.points(dot("now", [now.x1, x2]));
        }
    });
    moment_ui(ui, scene, &shown, |now| Some([now.x1, now.x2?]));
}
