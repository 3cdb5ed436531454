//! What the plots of several pages share.

use std::ops::{Deref, DerefMut, RangeInclusive};

use egui::{AsIdSalt, IdSalt};
use egui_plot::{
    AxisHints, GridInput, GridMark, HoverPosition, Line, Plot, PlotGeometry, PlotItem, PlotPoint,
    PlotPoints, PlotResponse, PlotUi, Points, default_label_formatter, uniform_grid_spacer,
};

use super::chart_menu;
use crate::export::Table;

use crate::language::{tr, tr_number};
use crate::theme;

/// Points between labels of an axis, where they begin to show and where they are full.
const LABELS: egui::Rangef = egui::Rangef {
    min: 28.0,
    max: 40.0,
};

/// Decimals of a label; smaller numbers have an exponent, so that they need no more room.
const MOST_DECIMALS: usize = 4;

pub fn curve(points: &[[f64; 2]]) -> PlotPoints<'static> {
    points.iter().copied().collect()
}

/// The least and the largest of some values.
pub fn extremes(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let first = (f64::INFINITY, f64::NEG_INFINITY);
    values.fold(first, |(low, high), v| (low.min(v), high.max(v)))
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

/// A plot whose axes have names, whose labels have as many decimals as they need, and that has a menu.
pub struct Chart<'a> {
    plot: Plot<'a>,
    salt: IdSalt,
    /// Names of the axes with their units, in English.
    axes: [String; 2],
    /// The x of what is drawn are logarithms to base 10.
    decades: bool,
}

impl<'a> Chart<'a> {
    /// A plot of this height; the labels of y are at least `width` wide, so that plots above each other line up.
    pub fn new(
        salt: impl AsIdSalt,
        [x, y]: [impl Into<String>; 2],
        height: f32,
        width: f32,
    ) -> Self {
        let salt = IdSalt::new(salt);
        let axes = [x.into(), y.into()];
        let axis = |hints: AxisHints<'static>| hints.label_spacing(LABELS).formatter(label);
        let [x, y] = [0, 1].map(|i| tr(&axes[i]));
        let plot = Plot::new(salt)
            .height(height)
            .allow_scroll(false)
            .label_formatter(|place| default_label_formatter(place).map(tr_number))
            .custom_x_axes(vec![axis(AxisHints::new_x().label(x))])
            .custom_y_axes(vec![axis(AxisHints::new_y().label(y).min_thickness(width))])
            .x_grid_spacer(uniform_grid_spacer(|input| grid(&input)))
            .y_grid_spacer(uniform_grid_spacer(|input| grid(&input)));
        Self {
            plot,
            salt,
            axes,
            decades: false,
        }
    }

    /// With a logarithmic x: what is drawn has the logarithm to base 10 there, and what is read its power.
    #[must_use]
    pub fn decades(mut self) -> Self {
        self.decades = true;
        let x = AxisHints::new_x()
            .label(tr(&self.axes[0]))
            .label_spacing(LABELS)
            .formatter(|mark, _| power_label(mark.value));
        self.with(|plot| {
            plot.custom_x_axes(vec![x])
                .x_grid_spacer(|input| powers(&input))
                .label_formatter(|place| power_formatter(place).map(tr_number))
        })
    }

    /// With more of what a plot can do.
    #[must_use]
    pub fn with(mut self, more: impl FnOnce(Plot<'a>) -> Plot<'a>) -> Self {
        self.plot = more(self.plot);
        self
    }

    /// Shows its data and stays where it is.
    #[must_use]
    pub fn still(self) -> Self {
        self.with(|plot| {
            plot.allow_zoom(false)
                .allow_boxed_zoom(false)
                .allow_axis_zoom_drag(false)
                .allow_drag(false)
        })
    }

    /// Draws it.
    pub fn show<R>(
        self,
        ui: &mut egui::Ui,
        draw: impl FnOnce(&mut Pen<'_, 'a>) -> R + 'a,
    ) -> PlotResponse<R> {
        let Self {
            plot,
            salt,
            axes,
            decades,
        } = self;
        let id = ui.scope_id().with(salt);
        let start = ui.cursor().min;
        let table = chart_menu::wants_numbers(ui.ctx(), id).then(|| Table::new("plot"));
        let titles = axes.clone();
        let shown = plot.show(ui, move |plot| {
            let mut pen = Pen {
                plot,
                axes: titles,
                decades,
                table,
            };
            (draw(&mut pen), pen.table)
        });
        let (inner, table) = shown.inner;
        chart_menu::ui(ui, id, &axes, start, shown.response.rect, table);
        PlotResponse {
            inner,
            response: shown.response,
            transform: shown.transform,
            hovered_plot_item: shown.hovered_plot_item,
        }
    }
}

/// Draws in a plot, and notes the numbers of its curves where they are asked for.
pub struct Pen<'p, 'd> {
    plot: &'p mut PlotUi<'d>,
    axes: [String; 2],
    decades: bool,
    table: Option<Table>,
}

impl<'d> Pen<'_, 'd> {
    /// Whether the numbers of whole curves are asked for, not only what is in view.
    pub fn notes(&self) -> bool {
        self.table.is_some()
    }

    pub fn line(&mut self, line: Line<'d>) {
        self.note(&line);
        self.plot.line(line);
    }

    pub fn points(&mut self, points: Points<'d>) {
        self.note(&points);
        self.plot.points(points);
    }

    /// Two columns for each curve: x and y.
    fn note(&mut self, item: &dyn PlotItem) {
        let (Some(table), PlotGeometry::Points(points)) = (&mut self.table, item.geometry()) else {
            return;
        };
        if points.is_empty() {
            return;
        }
        let title = |axis: &String| format!("{}: {axis}", item.name());
        let place = |p: &PlotPoint| {
            if self.decades { 10_f64.powf(p.x) } else { p.x }
        };
        let columns = [
            (title(&self.axes[0]), points.iter().map(place).collect()),
            (title(&self.axes[1]), points.iter().map(|p| p.y).collect()),
        ];
        table.columns.extend(columns);
    }
}

impl<'d> Deref for Pen<'_, 'd> {
    type Target = PlotUi<'d>;

    fn deref(&self) -> &PlotUi<'d> {
        self.plot
    }
}

impl DerefMut for Pen<'_, '_> {
    fn deref_mut(&mut self) -> &mut Self::Target {
        self.plot
    }
}

/// A plot that shows its data and stays where it is.
pub fn still(name: &'static str, x: &'static str, y: &'static str, height: f32) -> Chart<'static> {
    Chart::new(name, [x, y], height, 0.0).still()
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
    if decimals > MOST_DECIMALS {
        if value == 0.0 {
            return "0".to_owned();
        }
        let exponent = 3.0 * (first / 3.0).floor();
        let decimals = (more - first + exponent).max(0.0) as usize;
        let value = value / 10_f64.powf(exponent);
        return tr_number(format!("{value:.decimals$}e{exponent}"));
    }
    tr_number(format!("{value:.decimals$}"))
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

/// A line at every power of ten, and fine ones between at 2 to 9 times it.
fn powers(input: &GridInput) -> Vec<GridMark> {
    let (low, high) = (input.bounds.0.floor() as i32, input.bounds.1.ceil() as i32);
    let mark = |decade: i32, times: i32| GridMark {
        value: f64::from(decade) + f64::from(times).log10(),
        step_size: if times == 1 { 1.0 } else { 0.1 },
    };
    (low..high.min(low.saturating_add(MOST_DECADES)))
        .flat_map(|decade| (1..10).map(move |times| mark(decade, times)))
        // A mark beyond the ends would be drawn beside the plot.
        .filter(|mark| (input.bounds.0..=input.bounds.1).contains(&mark.value))
        .collect()
}

/// Decades that have grid lines, at most: what a plot spans before it has anything to show may be wild.
const MOST_DECADES: i32 = 40;

/// The power of ten at a line of [`powers`]; nothing at the fine ones.
fn power_label(exponent: f64) -> String {
    if exponent.fract() != 0.0 {
        return String::new();
    }
    let decimals = (-exponent).clamp(0.0, 12.0) as usize;
    tr_number(format!("{:.decimals$}", 10_f64.powf(exponent)))
}

/// What the pointer is at, where x is a logarithm.
fn power_formatter(place: &HoverPosition<'_>) -> Option<String> {
    let read = |p: &PlotPoint| PlotPoint::new(10_f64.powf(p.x), p.y);
    default_label_formatter(&match place {
        HoverPosition::NearDataPoint {
            plot_name,
            position,
            index,
        } => HoverPosition::NearDataPoint {
            plot_name,
            position: read(position),
            index: *index,
        },
        HoverPosition::Elsewhere { position } => HoverPosition::Elsewhere {
            position: read(position),
        },
    })
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
