//! What draws in a plot, and notes the numbers of its curves.

use std::ops::{Deref, DerefMut};

use egui::Id;
use egui_plot::{Line, PlotGeometry, PlotItem, PlotPoint, PlotUi, Points};

use super::chart_axes::plain;
use super::chart_cursor::{self, Curve};
use crate::export::Table;

/// How near a point must be to be pointed at, points on the screen.
const REACH: f32 = 8.0;

/// Draws in a plot, and notes the numbers of its curves where they are asked for.
pub struct Pen<'p, 'd> {
    pub(super) plot: &'p mut PlotUi<'d>,
    id: Id,
    axes: [String; 2],
    decades: [bool; 2],
    pub(super) table: Option<Table>,
    /// What the keys can read, if they are here.
    pub(super) curves: Option<Vec<Curve>>,
}

impl<'p, 'd> Pen<'p, 'd> {
    /// With a `table` where the numbers of its curves are asked for; where the plot has the keyboard, its curves are
    /// noted too.
    pub(super) fn new(
        plot: &'p mut PlotUi<'d>,
        id: Id,
        axes: [String; 2],
        decades: [bool; 2],
        table: Option<Table>,
    ) -> Self {
        let curves = plot.response().has_focus().then(Vec::new);
        Self {
            plot,
            id,
            axes,
            decades,
            table,
            curves,
        }
    }

    /// Whether the numbers of whole curves are asked for, not only what is in view.
    pub fn notes(&self) -> bool {
        self.table.is_some()
    }

    pub fn line(&mut self, line: Line<'d>) {
        self.note(&line, true);
        // A band, as which `egui_plot` draws points that lie close to each other, has no width where it is steep.
        self.plot.line(line.allow_band(false));
    }

    pub fn points(&mut self, points: Points<'d>) {
        self.note(&points, false);
        self.plot.points(points);
    }

    /// The place that is read, with the keys or the pointer.
    pub fn pointed(&self) -> Option<[f64; 2]> {
        if let Some(reading) = chart_cursor::live(self.ctx()) {
            return (reading.plot == self.id).then_some(reading.cursor.at);
        }
        let place = self.pointer_coordinate()?;
        self.response().hovered().then_some([place.x, place.y])
    }

    /// The first of some points that is where the plot is pointed at.
    pub fn pointed_among(&self, points: &[[f64; 2]]) -> Option<usize> {
        let place = self.screen_from_plot(self.pointed()?.into());
        let near = |p: &[f64; 2]| self.screen_from_plot((*p).into()).distance(place) <= REACH;
        points.iter().position(near)
    }

    /// Notes a curve where it is asked for; two columns of a table: x and y.
    fn note(&mut self, item: &dyn PlotItem, joined: bool) {
        let PlotGeometry::Points(points) = item.geometry() else {
            return;
        };
        if let Some(curves) = &mut self.curves
            && item.allow_hover()
        {
            let name = item.name().to_owned();
            let points = points.iter().map(|p| [p.x, p.y]).collect();
            curves.push(Curve {
                name,
                points,
                joined,
            });
        }
        let Some(table) = self.table.as_mut().filter(|_| !points.is_empty()) else {
            return;
        };
        let name = item.name().replace('\u{a0}', " ");
        let titles = distinct(table, &name, &self.axes);
        let place = |p: &PlotPoint| plain(self.decades, [p.x, p.y]);
        let values = [0, 1].map(|i| points.iter().map(|p| place(p)[i]).collect());
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
