//! The map as one textured image, with axes, colour bar, legend and reading.

use egui::{Color32, ColorImage, TextureHandle, TextureOptions};
use egui_plot::{MarkerShape, PlotImage, PlotPoint, PlotUi, Points};
use hysteron_core::maps::{Map, MapInput, Outcome, Quantity};
use hysteron_core::msg;

use super::words::{axis_title, number, stability, with_unit};
use crate::colors::viridis;
use crate::language::{tr, tr_number};
use crate::theme;
use crate::widgets::chart::Chart;

/// Pixels of the texture along a cell, so that hatching shows.
const PIXELS: usize = 4;

/// Share of the values at either end that the colours do not resolve: near the edge of oscillation the
/// period grows without bound, and one such cell would leave all others the same colour.
const CLIPPED: f64 = 0.01;

/// Width of the colour bar with its numbers, points.
const BAR_WIDTH: f32 = 92.0;

/// The drawn map.
#[derive(Default)]
pub struct Picture {
    texture: Option<TextureHandle>,
    scale: [f64; 2],
    outdated: bool,
}

impl Picture {
    /// The map or what is shown of it has changed.
    pub fn outdated(&mut self) {
        self.outdated = true;
    }

    /// Draws the map; returns the values of the parameters where it was clicked.
    pub fn ui(
        &mut self,
        ui: &mut egui::Ui,
        input: &MapInput,
        map: &Map,
        quantity: Quantity,
        point: [f64; 2],
        height: f32,
    ) -> Option<[f64; 2]> {
        if map.size() == 0 {
            return None;
        }
        self.paint(ui.ctx(), map, quantity);
        let mut chosen = None;
        ui.horizontal_top(|ui| {
            let width = (ui.available_width() - BAR_WIDTH - 12.0).max(120.0);
            ui.allocate_ui(egui::vec2(width, height), |ui| {
                chosen = self.plot_ui(ui, input, map, point, height);
            });
            ui.vertical(|ui| legend_ui(ui, quantity, self.scale, height));
        });
        chosen
    }

    fn plot_ui(
        &self,
        ui: &mut egui::Ui,
        input: &MapInput,
        map: &Map,
        point: [f64; 2],
        height: f32,
    ) -> Option<[f64; 2]> {
        let (x, y) = (input.x, input.y);
        let place = |at: [f64; 2]| Some([x.index(at[0], map.size())?, y.index(at[1], map.size())?]);
        let axes = [x, y].map(|a| axis_title(a.parameter.label(), a.parameter.unit()));
        let shown = Chart::new("map", axes, height, 0.0)
            .fixed()
            .with(|plot| {
                plot.show_grid(false)
                    .show_crosshair(true)
                    .allow_double_click_reset(false)
                    .set_margin_fraction(egui::Vec2::ZERO)
            })
            .choice(move |at| {
                let outcome = map.at(place(at)?)?;
                let names = [x, y].map(|a| (a.parameter.label(), a.parameter.unit()));
                Some(reading(names, at, outcome))
            })
            .show(ui, |plot| {
                plot.set_plot_bounds_x(x.from..=x.to);
                plot.set_plot_bounds_y(y.from..=y.to);
                if let Some(texture) = &self.texture {
                    let centre = PlotPoint::new(0.5 * (x.from + x.to), 0.5 * (y.from + y.to));
                    let size = [(x.to - x.from) as f32, (y.to - y.from) as f32];
                    plot.image(PlotImage::new("map", texture.id(), centre, size));
                }
                for (radius, color) in [(8.0, Color32::BLACK), (6.0, Color32::WHITE)] {
                    let mark = Points::new(tr("set in Explore"), vec![point])
                        .shape(MarkerShape::Cross)
                        .radius(radius)
                        .color(color);
                    // The numbers of the plot are the map's.
                    PlotUi::points(plot, mark);
                }
                plot.pointed()
            });
        let pointed = shown.inner.filter(|at| place(*at).is_some())?;
        shown.response.clicked().then_some(pointed)
    }

    fn paint(&mut self, ctx: &egui::Context, map: &Map, quantity: Quantity) {
        if self.texture.is_some() && !self.outdated {
            return;
        }
        self.outdated = false;
        self.scale = scale(&map.values(quantity), quantity);
        let side = map.size() * PIXELS;
        let mut image = ColorImage::filled([side, side], Color32::TRANSPARENT);
        for j in 0..map.size() {
            for i in 0..map.size() {
                let Some(outcome) = map.at([i, j]) else {
                    continue;
                };
                let plain = quantity
                    .value(outcome)
                    .map(|v| viridis((v - self.scale[0]) / (self.scale[1] - self.scale[0])));
                let (left, top) = (i * PIXELS, (map.size() - 1 - j) * PIXELS);
                for row in top..top + PIXELS {
                    for column in left..left + PIXELS {
                        image.pixels[row * side + column] =
                            plain.unwrap_or_else(|| hatched(row, column, outcome));
                    }
                }
            }
        }
        match &mut self.texture {
            Some(texture) => texture.set(image, TextureOptions::NEAREST),
            None => self.texture = Some(ctx.load_texture("map", image, TextureOptions::NEAREST)),
        }
    }
}

/// Lines where there is no cycle, dots where there is one but nothing to compare it with.
fn hatched(row: usize, column: usize, outcome: &Outcome) -> Color32 {
    let mark = if outcome.exact.is_none() {
        (row + column) % 8 < 2
    } else {
        row % 8 < 2 && column % 8 < 2
    };
    Color32::from_gray(if mark { 150 } else { 95 })
}

/// Values at the ends of the colour bar.
fn scale(values: &[f64], quantity: Quantity) -> [f64; 2] {
    if quantity == Quantity::Stability || values.is_empty() {
        return [0.0, 1.0];
    }
    let last = (values.len() - 1) as f64;
    let at = |share: f64| values[(share * last).round() as usize];
    let (low, high) = (at(CLIPPED), at(1.0 - CLIPPED));
    let least = 1e-9 * low.abs().max(1e-9);
    [low, high.max(low + least)]
}

/// All values of a loop, a line each.
fn reading(names: [(&'static str, &str); 2], values: [f64; 2], outcome: &Outcome) -> String {
    let line =
        |name: &'static str, value: f64, unit| tr(msg!("{} {}", name, with_unit(value, unit)));
    let mut lines: Vec<String> = names
        .iter()
        .zip(values)
        .map(|((label, unit), value)| line(label, value, unit))
        .collect();
    if outcome.exact.is_none() {
        lines.push(tr("no limit cycle"));
        return lines.join("\n");
    }
    for quantity in Quantity::ALL {
        match (quantity, quantity.value(outcome)) {
            (Quantity::Stability, Some(v)) => lines.push(tr(stability(v))),
            (_, Some(v)) => lines.push(line(quantity.label(), v, quantity.unit())),
            (_, None) => {}
        }
    }
    lines.join("\n")
}

/// Colour bar with its numbers, and what the hatching means.
fn legend_ui(ui: &mut egui::Ui, quantity: Quantity, scale: [f64; 2], height: f32) {
    ui.set_width(BAR_WIDTH);
    let bar = (0.55 * height).min(320.0);
    if quantity == Quantity::Stability {
        for (value, text) in [(1.0, "stable"), (0.0, "unstable")] {
            ui.horizontal(|ui| {
                let (rect, _) =
                    ui.allocate_exact_size(egui::vec2(18.0, 18.0), egui::Sense::hover());
                ui.painter().rect_filled(rect, 2.0, viridis(value));
                ui.label(tr(text));
            });
        }
    } else {
        ui.label(tr(axis_title(quantity.label(), quantity.unit())));
        let (rect, _) = ui.allocate_exact_size(egui::vec2(BAR_WIDTH, bar), egui::Sense::hover());
        bar_ui(ui, rect, scale);
    }
    ui.add_space(8.0);
    let (rect, _) = ui.allocate_exact_size(egui::vec2(18.0, 18.0), egui::Sense::hover());
    hatch_ui(ui, rect);
    ui.small(tr("no limit cycle"));
}

fn bar_ui(ui: &egui::Ui, rect: egui::Rect, scale: [f64; 2]) {
    const STRIPES: usize = 96;
    const TICKS: usize = 4;
    let painter = ui.painter();
    let height = rect.height() / STRIPES as f32;
    for i in 0..STRIPES {
        let share = (i as f64 + 0.5) / STRIPES as f64;
        let top = rect.bottom() - height * (i + 1) as f32;
        let stripe =
            egui::Rect::from_min_size(egui::pos2(rect.left(), top), egui::vec2(20.0, height + 0.5));
        painter.rect_filled(stripe, 0.0, viridis(share));
    }
    for i in 0..=TICKS {
        let share = i as f64 / TICKS as f64;
        let value = scale[0] + share * (scale[1] - scale[0]);
        let (anchor, mark) = match i {
            0 => (egui::Align2::LEFT_BOTTOM, "≤ "),
            TICKS => (egui::Align2::LEFT_TOP, "≥ "),
            _ => (egui::Align2::LEFT_CENTER, ""),
        };
        painter.text(
            egui::pos2(
                rect.left() + 26.0,
                rect.bottom() - share as f32 * rect.height(),
            ),
            anchor,
            tr_number(format!("{mark}{}", number(value))),
            theme::letters(ui, 13.0),
            ui.visuals().text_color(),
        );
    }
}

fn hatch_ui(ui: &egui::Ui, rect: egui::Rect) {
    let painter = ui.painter().with_clip_rect(rect);
    painter.rect_filled(rect, 0.0, Color32::from_gray(95));
    let mut x = rect.left() - rect.height();
    while x < rect.right() {
        painter.line_segment(
            [
                egui::pos2(x, rect.bottom()),
                egui::pos2(x + rect.height(), rect.top()),
            ],
            (1.5, Color32::from_gray(150)),
        );
        x += 6.0;
    }
}
