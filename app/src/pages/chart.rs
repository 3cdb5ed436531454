//! What the plots of several pages share.

use std::ops::RangeInclusive;

use egui_plot::{AxisHints, GridInput, GridMark, Plot, PlotPoints, Points, uniform_grid_spacer};

use crate::language::tr;
use crate::theme;

/// Points between labels of an axis, where they begin to show and where they are full.
const LABELS: egui::Rangef = egui::Rangef {
    min: 28.0,
    max: 40.0,
};

pub fn curve(points: &[[f64; 2]]) -> PlotPoints<'static> {
    points.iter().copied().collect()
}

/// A curve of at most `most` points: a longer one keeps the least and the largest value of each stretch.
pub fn envelope(time: &[f64], values: &[f64], most: usize) -> Vec<[f64; 2]> {
    if time.len() <= most {
        return time.iter().zip(values).map(|(t, v)| [*t, *v]).collect();
    }
    let stretch = time.len().div_ceil((most / 2).max(1));
    time.chunks(stretch)
        .zip(values.chunks(stretch))
        .flat_map(|(t, v)| {
            let (mut low, mut high) = (0, 0);
            for (i, value) in v.iter().enumerate() {
                if *value < v[low] {
                    low = i;
                }
                if *value > v[high] {
                    high = i;
                }
            }
            let (first, second) = (low.min(high), low.max(high));
            [[t[first], v[first]], [t[second], v[second]]]
        })
        .collect()
}

/// Axes whose labels have as many decimals as they need; that of y at least this wide, so that plots above
/// each other line up.
pub fn axes(plot: Plot<'_>, x: impl AsRef<str>, y: impl AsRef<str>, width: f32) -> Plot<'_> {
    let axis = |hints: AxisHints<'static>| hints.label_spacing(LABELS).formatter(label);
    plot.custom_x_axes(vec![axis(AxisHints::new_x().label(tr(x)))])
        .custom_y_axes(vec![axis(
            AxisHints::new_y().label(tr(y)).min_thickness(width),
        )])
        .x_grid_spacer(uniform_grid_spacer(|input| grid(&input)))
        .y_grid_spacer(uniform_grid_spacer(|input| grid(&input)))
}

/// A plot that shows its data and stays where it is.
pub fn still(name: &'static str, x: &'static str, y: &'static str, height: f32) -> Plot<'static> {
    axes(Plot::new(name), x, y, 0.0)
        .height(height)
        .allow_scroll(false)
        .allow_zoom(false)
        .allow_boxed_zoom(false)
        .allow_axis_zoom_drag(false)
        .allow_drag(false)
}

/// A label with as many decimals as its step has: 0.05 apart are 0.05, 0.10 and not 0.1, 0.1.
fn label(mark: GridMark, _range: &RangeInclusive<f64>) -> String {
    let step = mark.step_size.abs();
    let first = step.log10().floor();
    let lead = step / 10_f64.powf(first);
    // 2.5 has a second digit; 1, 2 and 5 have none.
    let more = if (lead - lead.round()).abs() > 0.1 {
        1.0
    } else {
        0.0
    };
    let decimals = (more - first).clamp(0.0, 12.0) as usize;
    let value = if mark.value.abs() < 1e-9 * step {
        0.0
    } else {
        mark.value
    };
    format!("{value:.decimals$}")
}

/// Grid lines at 1, 2 or 5 times a power of ten, some seven across or as many as have room for a label, with
/// a finer and a coarser set.
fn grid(input: &GridInput) -> [f64; 3] {
    let (low, high) = input.bounds;
    // The smallest step that egui_plot wants is 8 points wide; a label needs more.
    let least = f64::from(LABELS.max) / 8.0 * input.base_step_size;
    let wanted = ((high - low) / 7.0).max(least).max(f64::MIN_POSITIVE);
    let decade = 10_f64.powf(wanted.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0]
        .into_iter()
        .find(|s| s * decade >= wanted)
        .map_or(wanted, |s| s * decade);
    [0.5 * step, step, 10.0 * step]
}

/// Names of the curves in their colours, above a plot: they hide nothing.
pub fn caption_ui(ui: &mut egui::Ui, title: &str, curves: &[(&str, egui::Color32)]) {
    ui.horizontal_wrapped(|ui| {
        ui.strong(tr(title));
        for (name, color) in curves {
            let (rect, _) = ui.allocate_exact_size(egui::vec2(14.0, 4.0), egui::Sense::hover());
            ui.painter().rect_filled(rect, 1.0, *color);
            ui.label(tr(*name));
        }
    });
}

/// The place that the playback has reached.
pub fn dot(name: &'static str, at: [f64; 2]) -> Points<'static> {
    Points::new(tr(name), vec![at])
        .color(theme::MODEL)
        .radius(6.0)
}
