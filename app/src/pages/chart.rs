//! What the plots of several pages share.

use std::ops::{Deref, DerefMut, RangeInclusive};

use egui::{IdSalt, WidgetInfo};
use egui_plot::{
    AxisHints, GridInput, GridMark, HoverPosition, Line, Plot, PlotGeometry, PlotItem, PlotMemory,
    PlotPoint, PlotPoints, PlotResponse, PlotUi, Points, uniform_grid_spacer,
};

pub use super::chart_caption::{Key, Shape, caption_ui};
use super::chart_menu;
use super::chart_zoom::Zoomed;
use crate::export::Table;
use crate::language::{tr, tr_number};
use crate::theme;

/// Points between labels of x and of y: what they shall have, and what those of a low plot must have, which would
/// have one label or none else.
const LABELS: [[f32; 2]; 2] = [[40.0, 40.0], [24.0, 16.0]];

/// Labels that an axis has at least where there is room: one alone shows no scale.
const FEWEST_LABELS: f64 = 2.0;

/// Significant digits of what is read at the pointer; a time needs more, since it grows.
const READ_X: i32 = 6;
const READ_Y: i32 = 5;

/// The labels of an axis that ends below this have a smaller unit, or an exponent, so that they need no more room.
const LEAST_PLAIN: f64 = 1e-3;

/// Units that take a prefix, and the prefixes by their powers of ten.
const PREFIXED: [&str; 10] = [
    "rad", "rad/s", "rad/s²", "m", "m/s", "m/s²", "s", "N", "N m", "V",
];
const PREFIXES: [(i32, &str); 3] = [(-6, "µ"), (-9, "n"), (-12, "p")];

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

/// Labels that far apart are drawn, and in full.
fn shown_from(points: f32) -> egui::Rangef {
    egui::Rangef::new(points - 0.1, points)
}

/// A label with as many decimals as its step has: 0.05 apart are 0.05, 0.10 and not 0.1, 0.1.
fn label(mark: GridMark, range: &RangeInclusive<f64>, unit: &str) -> String {
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
    let value = mark.value;
    if value.abs() < 1e-9 * step {
        return "0".to_owned();
    }
    // Of the range: all labels of an axis have the same.
    let largest = range.start().abs().max(range.end().abs());
    if largest < LEAST_PLAIN {
        let exponent = 3 * (largest.max(step).log10() / 3.0).floor() as i32;
        let decimals = (more - first + f64::from(exponent)).max(0.0) as usize;
        let value = value / 10_f64.powi(exponent);
        let prefix = PREFIXES.iter().find(|(power, _)| *power == exponent);
        return match prefix.filter(|_| PREFIXED.contains(&unit)) {
            Some((_, prefix)) => {
                let number = tr_number(format!("{value:.decimals$}"));
                format!("{number} {prefix}{unit}")
            }
            None => tr_number(format!("{value:.decimals$}e{exponent}")),
        };
    }
    tr_number(format!("{value:.decimals$}"))
}

/// The unit in the name of an axis, if it has one.
fn unit_of(axis: &str) -> &str {
    let inner = axis.strip_suffix(']').and_then(|a| a.rsplit_once('['));
    inner.map_or("", |(_, unit)| unit)
}

/// Grid lines at 1, 2 or 5 times a power of ten, some seven across or as many as have room for a label, with
/// a finer and a coarser set.
fn grid(input: &GridInput, [apart, least_apart]: [f32; 2]) -> [f64; 3] {
    let (low, high) = input.bounds;
    // The smallest step that egui_plot wants is 8 points wide; a label needs more.
    let point = input.base_step_size / 8.0;
    let wanted = ((high - low) / 7.0).max(f64::from(apart) * point);
    let step = round_step(wanted.max(f64::MIN_POSITIVE));
    let labels = |step: f64| (high / step).ceil() - (low / step).ceil();
    let closer = [0.5, 0.4, 0.2].map(|share| round_step(0.99 * share * step));
    let step = [step]
        .into_iter()
        .chain(closer)
        .find(|s| labels(*s) >= FEWEST_LABELS && *s >= f64::from(least_apart) * point)
        .unwrap_or(step);
    // A finer line that is far enough from the next would have a label too.
    let half = 0.5 * step / point;
    if half >= f64::from(least_apart) && half < f64::from(apart) {
        return [step, 10.0 * step, 100.0 * step];
    }
    [0.5 * step, step, 10.0 * step]
}

/// The next 1, 2 or 5 times a power of ten from here on.
pub fn round_step(wanted: f64) -> f64 {
    let decade = 10_f64.powf(wanted.log10().floor());
    [1.0, 2.0, 5.0, 10.0]
        .into_iter()
        .find(|s| s * decade >= wanted)
        .map_or(wanted, |s| s * decade)
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

/// What stands at the pointer: the curve, and the values by the names and units of their axes.
fn reading(
    names: [String; 2],
    place: impl Fn(&PlotPoint) -> [f64; 2],
) -> impl Fn(&HoverPosition<'_>) -> Option<String> {
    move |at| {
        let (curve, point) = match at {
            HoverPosition::NearDataPoint {
                plot_name,
                position,
                ..
            } => (*plot_name, position),
            HoverPosition::Elsewhere { position } => ("", position),
        };
        let [x, y] = place(point);
        let [x, y] = [(&names[0], x, READ_X), (&names[1], y, READ_Y)]
            .map(|(name, value, digits)| (name, read_out(value, digits)));
        let across = line_of(x.0, &x.1);
        Some(match curve {
            "" => format!("{across}\n{}", line_of(y.0, &y.1)),
            // An axis of several quantities: the curve says which one it is.
            curve if y.0.contains(", ") => format!("{across}\n{}", line_of(curve, &y.1)),
            curve => format!("{curve}\n{across}\n{}", line_of(y.0, &y.1)),
        })
    }
}

/// A value by the name of its axis, which ends with the unit.
fn line_of(name: &str, value: &str) -> String {
    match name.strip_suffix(']').and_then(|n| n.rsplit_once(" [")) {
        Some((name, unit)) => format!("{name}: {value} {unit}"),
        None => format!("{name}: {value}"),
    }
}

/// A number with so many significant digits, as it is read on the screen.
fn read_out(value: f64, digits: i32) -> String {
    tr_number(significant(value, digits))
}

/// A number with so many significant digits, and an exponent only where it needs one.
pub(super) fn significant(value: f64, digits: i32) -> String {
    let size = value.abs();
    if size == 0.0 {
        "0".to_owned()
    } else if (1e-4..1e6).contains(&size) {
        let decimals = (digits - 1 - size.log10().floor() as i32).max(0) as usize;
        let text = format!("{value:.decimals$}");
        if text.contains('.') {
            let text = text.trim_end_matches('0').trim_end_matches('.');
            text.to_owned()
        } else {
            text
        }
    } else {
        format!("{value:.3e}")
    }
}

/// The place that the playback has reached.
pub fn dot(name: &'static str, at: [f64; 2]) -> Points<'static> {
    Points::new(tr(name), vec![at])
        .color(theme::MODEL)
        .radius(6.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lines of an axis that is so many points high.
    fn lines(bounds: (f64, f64), points: f64) -> [f64; 3] {
        let base_step_size = 8.0 * (bounds.1 - bounds.0) / points;
        grid(
            &GridInput {
                bounds,
                base_step_size,
            },
            LABELS[1],
        )
    }

    #[test]
    fn a_low_plot_has_two_labels() {
        assert_eq!(lines((-1.1, 1.1), 220.0), [0.25, 0.5, 5.0]);
        assert_eq!(lines((-0.9, 0.9), 60.0), [0.25, 0.5, 5.0], "not 0 alone");
        assert_eq!(lines((-1.1, 1.1), 24.0)[1], 5.0, "no room for two");
    }

    fn labels(range: RangeInclusive<f64>, marks: &[(f64, f64)]) -> Vec<String> {
        let mark = |&(value, step_size)| GridMark { value, step_size };
        let marks = marks.iter().map(mark);
        marks.map(|mark| label(mark, &range, "")).collect()
    }

    #[test]
    fn the_labels_of_an_axis_are_written_alike() {
        let fine = [(0.0005, 0.0005), (0.00075, 0.00025), (0.0, 0.0005)];
        assert_eq!(labels(0.0..=0.0009, &fine), ["500e-6", "750e-6", "0"]);
        assert_eq!(labels(0.0..=0.002, &fine), ["0.0005", "0.00075", "0"]);
        assert_eq!(labels(-4e-6..=4e-6, &[(-2e-6, 2e-6)]), ["-2e-6"]);
        assert_eq!(
            labels(5.374..=5.375, &[(5.3742, 2e-4), (5.37425, 5e-5)]),
            ["5.3742", "5.37425"]
        );
        assert_eq!(labels(0.0..=3000.0, &[(2500.0, 500.0)]), ["2500"]);
    }

    #[test]
    fn a_small_value_has_a_smaller_unit_where_there_is_one() {
        let small = |unit: &str| {
            let mark = GridMark {
                value: 0.0005,
                step_size: 0.0005,
            };
            label(mark, &(0.0..=0.0009), unit)
        };
        assert_eq!(small(unit_of("x1 - model [rad]")), "500 µrad");
        assert_eq!(small(unit_of("inertia [kg m²]")), "500e-6");
        assert_eq!(small(unit_of("output")), "500e-6");
    }
}
