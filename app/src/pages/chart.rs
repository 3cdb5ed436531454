//! What the plots of several pages share.

use std::ops::{Deref, DerefMut};

use egui::{IdSalt, WidgetInfo};
use egui_plot::{
    AxisHints, Line, Plot, PlotGeometry, PlotItem, PlotMemory, PlotPoint, PlotPoints, PlotResponse,
    PlotUi, Points, uniform_grid_spacer,
};

pub use super::chart_axes::round_step;
use super::chart_axes::{LABELS, grid, label, power_label, powers, shown_from, unit_of};
pub use super::chart_caption::{Key, Shape, caption_ui};
use super::chart_menu;
use super::chart_reading::reading;
pub use super::chart_reading::significant;
use super::chart_zoom::Zoomed;
use crate::export::Table;
use crate::language::tr;
use crate::theme;

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

/// A curve without the points that lie on the line between others: the dashes of one that is sampled finely would
/// fill its gaps.
pub fn sparse(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let (low, high) = extremes(points.iter().map(|p| p[1]));
    let near = 2e-3 * (high - low);
    let mut kept: Vec<[f64; 2]> = points.first().copied().into_iter().collect();
    let mut from = 0;
    for (i, end) in points.iter().enumerate().skip(2) {
        let start = points[from];
        let slope = (end[1] - start[1]) / (end[0] - start[0]);
        let off = |p: &[f64; 2]| (start[1] + slope * (p[0] - start[0]) - p[1]).abs();
        if points[from + 1..i].iter().any(|p| off(p) > near) {
            from = i - 1;
            kept.push(points[from]);
        }
    }
    kept.extend(points.last().copied().filter(|_| points.len() > 1));
    kept
}

/// A plot whose axes have names, whose labels have as many decimals as they need, and that has a menu.
pub struct Chart<'a> {
    plot: Plot<'a>,
    salt: IdSalt,
    /// What its zoom is called in links, and which of its axes have one.
    zoom: (String, [bool; 2]),
    /// Names of the axes with their units, in English.
    axes: [String; 2],
    /// The x of what is drawn are logarithms to base 10.
    decades: bool,
    /// It can be dragged only while it is zoomed: else a finger on it moves the page.
    drag_zoomed: bool,
}

impl<'a> Chart<'a> {
    /// A plot of this height; the labels of y are at least `width` wide, so that plots above each other line up.
    /// No other of its page has its name.
    pub fn new(
        name: impl Into<String>,
        [x, y]: [impl Into<String>; 2],
        height: f32,
        width: f32,
    ) -> Self {
        let name = name.into();
        let salt = IdSalt::new(&name);
        let axes = [x.into(), y.into()];
        let axis = |hints: AxisHints<'static>, i: usize| {
            let unit = unit_of(&axes[i]).to_owned();
            hints
                .label_spacing(shown_from(LABELS[i][1]))
                .formatter(move |mark, range| label(mark, range, &unit))
        };
        let [x, y] = [0, 1].map(|i| tr(&axes[i]));
        let plot = Plot::new(salt)
            .height(height)
            .allow_scroll(false)
            .label_formatter(reading([x.clone(), y.clone()], |p| [p.x, p.y]))
            .custom_x_axes(vec![axis(AxisHints::new_x().label(x), 0)])
            .custom_y_axes(vec![axis(
                AxisHints::new_y().label(y).min_thickness(width),
                1,
            )])
            .x_grid_spacer(uniform_grid_spacer(|input| grid(&input, LABELS[0])))
            .y_grid_spacer(uniform_grid_spacer(|input| grid(&input, LABELS[1])));
        Self {
            plot,
            salt,
            zoom: (name, [true; 2]),
            axes,
            decades: false,
            drag_zoomed: false,
        }
    }

    /// With a logarithmic x: what is drawn has the logarithm to base 10 there, and what is read its power.
    #[must_use]
    pub fn decades(mut self) -> Self {
        self.decades = true;
        let names = [0, 1].map(|i| tr(&self.axes[i]));
        let x = AxisHints::new_x()
            .label(names[0].clone())
            .label_spacing(shown_from(LABELS[0][1]))
            .formatter(|mark, _| power_label(mark.value));
        self.with(|plot| {
            plot.custom_x_axes(vec![x])
                .x_grid_spacer(|input| powers(&input))
                .label_formatter(reading(names, |p| [10_f64.powf(p.x), p.y]))
        })
    }

    /// With more of what a plot can do.
    #[must_use]
    pub fn with(mut self, more: impl FnOnce(Plot<'a>) -> Plot<'a>) -> Self {
        self.plot = more(self.plot);
        self
    }

    /// Shows its data until someone zooms; a double click shows all of it again.
    #[must_use]
    pub fn still(mut self) -> Self {
        self.drag_zoomed = true;
        self.with(|plot| plot.allow_axis_zoom_drag(false))
    }

    /// Is zoomed in x alone, together with those of the same group, which moves them.
    #[must_use]
    pub fn zoomed_as(mut self, group: &str) -> Self {
        self.zoom = (group.to_owned(), [true, false]);
        self
    }

    /// Stays where it is.
    #[must_use]
    pub fn fixed(mut self) -> Self {
        self.drag_zoomed = false;
        self.zoom.1 = [false; 2];
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
            mut plot,
            salt,
            zoom,
            axes,
            decades,
            drag_zoomed,
        } = self;
        let id = ui.scope_id().with(salt);
        plot = plot.id(id);
        if egui::Popup::is_any_open(ui.ctx()) {
            // What is read at the pointer would cover the menu.
            plot = plot.label_formatter(|_| None);
        }
        if drag_zoomed {
            let memory = PlotMemory::load(ui.ctx(), id);
            let zoomed = memory.is_some_and(|m| !m.auto_bounds.all());
            plot = plot.allow_drag(zoomed);
        }
        let zoom = Zoomed::new(id, &zoom.0, zoom.1);
        let change = zoom.change(ui.ctx());
        if change.is_some() {
            // What is drawn may depend on what was in view before.
            ui.ctx().request_repaint();
        }
        let start = ui.cursor().min;
        let table = chart_menu::wants_numbers(ui.ctx(), id).then(|| Table::new("plot"));
        let titles = axes.clone();
        let shown = plot.show(ui, move |plot| {
            if let Some(change) = change {
                change.make(plot);
            }
            let mut pen = Pen {
                plot,
                axes: titles,
                decades,
                table,
            };
            (draw(&mut pen), pen.table)
        });
        zoom.note(ui.ctx());
        let name = tr(format!("Plot: {} over {}", axes[1], axes[0]));
        let info = || WidgetInfo::labeled(egui::Role::Image, true, &name);
        shown.response.widget_info(info);
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
        let name = item.name().replace('\u{a0}', " ");
        let titles = distinct(table, &name, &self.axes);
        let place = |p: &PlotPoint| {
            if self.decades { 10_f64.powf(p.x) } else { p.x }
        };
        let values = [
            points.iter().map(place).collect(),
            points.iter().map(|p| p.y).collect(),
        ];
        table.columns.extend(titles.into_iter().zip(values));
    }
}

/// Titles of the columns of a curve that no other in the table has: curves of the same name are numbered.
fn distinct(table: &Table, name: &str, axes: &[String; 2]) -> [String; 2] {
    let taken = |title: &String| table.columns.iter().any(|(t, _)| t == title);
    let mut count = 1;
    loop {
        let number = if count == 1 {
            String::new()
        } else {
            format!(" {count}")
        };
        let titles = axes
            .each_ref()
            .map(|axis| format!("{name}{number}: {axis}"));
        if !titles.iter().any(taken) {
            return titles;
        }
        count += 1;
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

/// A plot that shows its data until someone zooms.
pub fn still(name: &'static str, x: &'static str, y: &'static str, height: f32) -> Chart<'static> {
    Chart::new(name, [x, y], height, 0.0).still()
}

/// The place that the playback has reached.
pub fn dot(name: &'static str, at: [f64; 2]) -> Points<'static> {
    Points::new(tr(name), vec![at])
        .color(theme::MODEL)
        .radius(6.0)
}
