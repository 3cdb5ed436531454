//! Positions over time, phase portrait and backlash map.

use egui::Ui;
use egui_plot::{Line, LineStyle, Points, Polygon, VLine};

use super::scene::{MILLI, Scene};
use crate::pages::chart::{caption_ui, curve, dot, still};
use crate::theme;

/// Periods of the relay that the phase portrait shows before the present one.
const PERIODS: f64 = 3.0;

/// Colour of the load.
const LOAD: egui::Color32 = theme::NOISE;

/// Positions of motor and load; shaded where they touch.
pub fn time_ui(ui: &mut Ui, scene: &Scene, clock: f64, height: f32) {
    caption_ui(
        ui,
        "Positions",
        &[
            ("motor x1", theme::MEASURED),
            ("load x2", LOAD),
            ("in contact", theme::MODEL),
        ],
    );
    let [low, high] = scene.range;
    still("positions", "time [s]", "position [mrad]", height).show(ui, |plot| {
        for e in &scene.summary.engagements {
            let corners = vec![[e.from, low], [e.to, low], [e.to, high], [e.from, high]];
            plot.polygon(
                Polygon::new("in contact", corners)
                    .fill_color(theme::MODEL.gamma_multiply(0.25))
                    .stroke((0.0, theme::MODEL)),
            );
        }
        plot.line(
            Line::new("load x2", curve(&scene.load))
                .color(LOAD)
                .width(2.5),
        );
        plot.line(
            Line::new("motor x1", curve(&scene.motor))
                .color(theme::MEASURED)
                .width(1.5),
        );
        plot.vline(VLine::new("now", clock).color(theme::INPUT).width(1.0));
    });
}

/// Velocity over position of the motor, of the last periods.
pub fn phase_ui(ui: &mut Ui, scene: &Scene, clock: f64, height: f32) {
    let span = match &scene.summary.cycle {
        Some(cycle) => PERIODS * cycle.period,
        None => 0.1 * scene.input.duration,
    };
    // Before a few periods have passed, those to come are shown.
    let to = clock.max(span);
    let points = scene.phase(to - span, to);
    caption_ui(
        ui,
        "Phase portrait of the motor",
        &[("last periods", theme::MEASURED)],
    );
    still(
        "phase of the motor",
        "position x1 [mrad]",
        "velocity v1 [rad/s]",
        height,
    )
    .show(ui, |plot| {
        plot.line(
            Line::new("last periods", curve(&points))
                .color(theme::MEASURED)
                .width(1.5),
        );
        if let Some([x1, _, v1, _]) = scene.now(clock) {
            plot.points(dot("now", [x1, v1]));
        }
    });
}

/// Load over motor position.
pub fn map_ui(ui: &mut Ui, scene: &Scene, clock: f64, height: f32) {
    caption_ui(
        ui,
        "Backlash map",
        &[("x2 over x1", LOAD), ("ends of the gap", theme::MODEL)],
    );
    let beta = MILLI * scene.input.drive.half_gap;
    let [low, high] = scene.range;
    let load = scene.load_range;
    still("map", "motor x1 [mrad]", "load x2 [mrad]", height).show(ui, |plot| {
        for side in [-1.0, 1.0] {
            // No longer than the branch that lies on it.
            let ends = [
                low.max(load[0] + side * beta),
                high.min(load[1] + side * beta),
            ];
            let edge = ends.map(|x| [x, x - side * beta]).to_vec();
            plot.line(
                Line::new("ends of the gap", edge)
                    .color(theme::MODEL)
                    .style(LineStyle::dashed_dense()),
            );
        }
        plot.points(
            Points::new("x2 over x1", curve(&scene.map))
                .color(LOAD)
                .radius(1.2),
        );
        if let Some([x1, x2, _, _]) = scene.now(clock) {
            plot.points(dot("now", [x1, x2]));
        }
    });
}
