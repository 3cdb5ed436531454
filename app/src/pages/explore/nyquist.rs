//! The Nyquist plot: plant, -1/N(a), where they meet; the line and the point S can be dragged.

use hysteron_core::message::Message;
use std::f64::consts::PI;
use std::ops::RangeInclusive;

use egui_plot::{Line, LineStyle, MarkerShape, PlotPoint, PlotPoints, PlotTransform, Points, Text};
use hysteron_core::explore::ExploreData;
use hysteron_core::message::fixed;
use hysteron_core::msg;
use hysteron_core::relay::Relay;

use crate::language::tr;
use crate::theme;
use crate::widgets::chart::{Shape, caption_ui, curve, dot, still};

/// How near the pointer must come to take hold, points.
const REACH: f32 = 9.0;

/// From a mark to its label, points.
const NEAR: f64 = 9.0;

/// Largest phase margin that S can be dragged to, rad.
const LARGEST_MARGIN: f64 = 1.4;

/// What is held by the pointer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Held {
    #[default]
    Nothing,
    Line,
    Margin,
}

/// The plot's own state.
#[derive(Default)]
pub struct Nyquist {
    /// Whether the point S on the unit circle is shown.
    pub margin: bool,
    held: Held,
    /// Half width of the view; stays while something is held, so that the ground does not move.
    view: f64,
}

impl Nyquist {
    /// Draws the plot; dragging sets the relay's hysteresis. Returns a place on the line.
    pub fn ui(
        &mut self,
        ui: &mut egui::Ui,
        relay: &mut Relay,
        data: &ExploreData,
        amplitude: Option<f64>,
        height: f32,
    ) -> egui::Pos2 {
        caption_ui(
            ui,
            "Nyquist plot",
            &[
                ("P(jω)", theme::MEASURED, Shape::Line),
                ("-1/N(a), drag it", theme::DESCRIBING, Shape::Dashes),
            ],
        );
        if self.held == Held::Nothing || self.view == 0.0 {
            self.view = rounded(reach(data, self.margin));
        }
        let view = self.view;
        let shown_margin = self.margin.then(|| margin(relay)).flatten();
        let plot = still("nyquist", "real part", "imaginary part", height)
            .fixed()
            .with(|plot| plot.data_aspect(1.0));
        let level = -PI * relay.hysteresis / (4.0 * relay.gain);
        let marker = amplitude.map(|a| {
            let a = a.max(relay.hysteresis);
            (a, relay.inverse_describing_function(a))
        });
        let shown = plot.show(ui, |plot| {
            let [x, y] = bounds(view, plot.transform().frame().aspect_ratio());
            plot.set_plot_bounds_y(y);
            plot.set_plot_bounds_x(x);
            let point = plot.transform().dvalue_dpos()[1].abs();
            plot.line(
                Line::new(tr("plant P(jω)"), curve(&data.nyquist))
                    .color(theme::MEASURED)
                    .width(2.5),
            );
            plot.line(
                Line::new(tr("-1/N(a)"), vec![[0.0, level], [-4.0 * view, level]])
                    .color(theme::DESCRIBING)
                    .width(2.5)
                    .style(LineStyle::dashed_loose()),
            );
            let marks: Vec<[f64; 2]> = data.intersections.iter().map(|i| i.point).collect();
            plot.points(
                Points::new(tr("predicted oscillation"), curve(&marks))
                    .color(theme::EXACT)
                    .radius(7.0)
                    .shape(MarkerShape::Diamond),
            );
            if self.margin {
                plot.line(
                    Line::new(tr("unit circle"), unit_circle())
                        .color(theme::RESIDUAL)
                        .width(1.5),
                );
            }
            if let Some(phi) = shown_margin {
                let at = [-phi.cos(), -phi.sin()];
                plot.points(
                    Points::new(tr("S"), vec![at])
                        .color(theme::RESIDUAL)
                        .radius(8.0)
                        .shape(MarkerShape::Square),
                );
                let text = msg!("S: margin φ = {}°", fixed(phi.to_degrees(), 1));
                // Above it: below the line stands the amplitude.
                let above = [at[0] - 0.08 * view, at[1] + NEAR * point];
                plot.text(label("S", text, above).anchor(egui::Align2::LEFT_BOTTOM));
            }
            if let Some((a, at)) = marker {
                plot.points(dot("a", at));
                let text = format!("a = {a:.3}").into();
                let below = label("a", text, [at[0], at[1] - NEAR * point]);
                plot.text(below.anchor(egui::Align2::CENTER_TOP));
            }
        });
        self.drag(&shown.response, &shown.transform, relay, shown_margin);
        let on_line = PlotPoint::new(-1.2 * view, level);
        shown.transform.position_from_point(&on_line)
    }

    fn drag(
        &mut self,
        response: &egui::Response,
        transform: &PlotTransform,
        relay: &mut Relay,
        shown: Option<f64>,
    ) {
        let level = -PI * relay.hysteresis / (4.0 * relay.gain);
        let under = |at: egui::Pos2| {
            let point = |x, y| transform.position_from_point(&PlotPoint::new(x, y));
            let on_margin = shown
                .is_some_and(|phi: f64| point(-phi.cos(), -phi.sin()).distance(at) < 1.5 * REACH);
            if on_margin {
                Held::Margin
            } else if (point(0.0, level).y - at.y).abs() < REACH {
                Held::Line
            } else {
                Held::Nothing
            }
        };
        if response.drag_started() {
            let origin = response.ctx.input(|i| i.pointer.press_origin());
            self.held = origin.map_or(Held::Nothing, under);
        }
        if response.drag_stopped() || !response.dragged() {
            self.held = Held::Nothing;
        }
        let hovered = response.hover_pos().map_or(Held::Nothing, under);
        let icon = match (self.held, hovered) {
            (Held::Line, _) | (Held::Nothing, Held::Line) => Some(egui::CursorIcon::ResizeVertical),
            (Held::Margin, _) | (Held::Nothing, Held::Margin) => Some(egui::CursorIcon::Grab),
            (Held::Nothing, Held::Nothing) => None,
        };
        if let Some(icon) = icon {
            response.ctx.set_cursor_icon(icon);
        }
        let Some(pointer) = response.interact_pointer_pos() else {
            return;
        };
        let at = transform.value_from_position(pointer);
        let scale = 4.0 * relay.gain / PI;
        match self.held {
            Held::Line => relay.hysteresis = tidy((-at.y * scale).max(0.0)),
            Held::Margin => {
                let phi = (-at.y).atan2(-at.x).clamp(0.0, LARGEST_MARGIN);
                relay.hysteresis = tidy(scale * phi.sin());
            }
            Held::Nothing => {}
        }
    }
}

/// The phase margin that the relay probes: its line meets the unit circle at `-180 degrees + phi`, equation (7);
/// `None` where it lies beyond.
fn margin(relay: &Relay) -> Option<f64> {
    let sine = PI * relay.hysteresis / (4.0 * relay.gain);
    (sine <= 1.0).then(|| sine.asin())
}

/// The third quadrant of the unit circle, where phase margins are.
fn unit_circle() -> PlotPoints<'static> {
    (0..=60)
        .map(|i| {
            let angle = PI + 0.5 * PI * f64::from(i) / 60.0;
            [angle.cos(), angle.sin()]
        })
        .collect()
}

fn label(name: &'static str, text: Message, at: [f64; 2]) -> Text {
    let text = egui::RichText::new(tr(text)).size(15.0).strong();
    Text::new(name, PlotPoint::new(at[0], at[1]), text)
}

/// What is seen of the plane in a plot of this ratio of width to height: all that matters, and as much more on both
/// sides as there is room for.
fn bounds(view: f64, aspect: f32) -> [RangeInclusive<f64>; 2] {
    let aspect = f64::from(aspect).clamp(0.1, 10.0);
    let ([left, right], [low, high]) = ([-1.6 * view, view], [-1.1 * view, 0.5 * view]);
    let (width, height) = (right - left, high - low);
    let beside = (0.5 * (height * aspect - width)).max(0.0);
    let above = (0.5 * (width / aspect - height)).max(0.0);
    [left - beside..=right + beside, low - above..=high + above]
}

/// As fine as the slider shows it.
fn tidy(hysteresis: f64) -> f64 {
    (hysteresis * 1000.0).round() / 1000.0
}

/// How far from the origin the things are that matter.
fn reach(data: &ExploreData, margin: bool) -> f64 {
    let least = if margin { 1.0 } else { 0.01 };
    let met = data.intersections.iter().flat_map(|i| i.point);
    let size = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0_f64, |m, v| m.max(v.abs()));
    let size = match size(&mut met.map(|v| 2.0 * v)) {
        // The line of the relay has no end: where the plant does not meet it, the plant is what is seen.
        0.0 => {
            let line = size(&mut data.inverse_df.iter().flatten().copied());
            let plant = size(&mut data.nyquist.iter().flatten().copied());
            line.min(plant)
        }
        size => size,
    };
    size.max(least)
}

/// The next larger step of a coarse scale, so that the view does not tremble with the sliders.
fn rounded(value: f64) -> f64 {
    let decade = 10_f64.powf(value.log10().floor());
    let steps = [1.0, 1.5, 2.0, 3.0, 5.0, 7.0, 10.0];
    let fits = steps.iter().find(|s| **s * decade >= value);
    fits.map_or(value, |s| s * decade)
}
