//! What the plots of several pages share.

use egui_plot::{AxisHints, Plot, PlotPoints, Points, uniform_grid_spacer};

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
    // Between lines at 5 the finer ones stand at 1: labels of halves would have to be rounded.
    let [step, fine] = [[1.0, 0.5], [2.0, 1.0], [5.0, 1.0], [10.0, 5.0]]
        .into_iter()
        .find(|s| s[0] * decade >= wanted)
        .unwrap_or([wanted / decade, 0.5 * wanted / decade]);
    [fine * decade, step * decade, 10.0 * step * decade]
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

/// The place that the playback has reached.
pub fn dot(name: &'static str, at: [f64; 2]) -> Points<'static> {
    Points::new(name, vec![at]).color(theme::MODEL).radius(6.0)
}
