//! A plot worked by keys: a cursor that reads its curves, and what of it is in view.

use egui::{Context, Event, EventFilter, Id, Key, Modifiers};
use egui_plot::PlotUi;

use super::chart_cursor::{self, Cursor, Curve, Reading, values};
use crate::zoom;

/// Points that a press moves the cursor, and how many times as far with Shift.
const STEP: f64 = 2.0;
const FAR: f64 = 10.0;

/// How much nearer a press brings what is in view, and the share of it that a press moves it.
const NEARER: f64 = 1.5;
const SHARE: f64 = 0.1;

/// The plot that is worked.
pub struct Worked {
    pub plot: Id,
    /// Plots whose x is the same.
    pub group: Option<Id>,
    /// Axes that can be zoomed and moved.
    pub axes: [bool; 2],
}

/// What of a plot is in view.
struct View {
    ends: [[f64; 2]; 2],
    /// What a point on the screen is in the numbers of each axis.
    point: [f64; 2],
    axes: [bool; 2],
}

impl Worked {
    /// Does what the keys say if the plot has the keyboard; whether its menu is asked for.
    pub fn work(&self, plot: &mut PlotUi<'_>, curves: &[Curve]) -> bool {
        let (ctx, response) = (plot.ctx().clone(), plot.response().clone());
        if response.hovered() && ctx.input(|i| i.pointer.is_moving()) {
            // Whoever takes the pointer reads there.
            chart_cursor::leave(&ctx);
        }
        if !response.has_focus() {
            return false;
        }
        if response.gained_focus() {
            response.scroll_to_me(None);
        }
        let mut view = View::of(plot, self.axes);
        let reading = chart_cursor::live(&ctx).filter(|r| r.plot == self.plot);
        let mut cursor = reading.map(|r| r.cursor);
        let menu = self.press(plot, &mut view, &mut cursor, curves);
        view.show(plot);
        let filter = EventFilter {
            horizontal_arrows: true,
            vertical_arrows: true,
            // Without a cursor it leaves the plot.
            escape: cursor.is_some(),
            ..EventFilter::default()
        };
        ctx.memory_mut(|memory| memory.set_focus_lock_filter(response.id, filter));
        match cursor {
            Some(cursor) => {
                let cursor = settled(cursor, curves, &view);
                let (plot, widget, group) = (self.plot, response.id, self.group);
                let reading = Reading {
                    plot,
                    widget,
                    group,
                    cursor,
                    live: true,
                };
                chart_cursor::set(&ctx, reading);
            }
            None => chart_cursor::leave(&ctx),
        }
        menu
    }

    /// Does what the keys of this frame say; whether one asks for the menu.
    fn press(
        &self,
        plot: &mut PlotUi<'_>,
        view: &mut View,
        cursor: &mut Option<Cursor>,
        curves: &[Curve],
    ) -> bool {
        let mut menu = false;
        for (key, modifiers) in pressed(plot.ctx()) {
            let times = if modifiers.shift { FAR } else { 1.0 };
            let [x, y] = match key {
                Key::ArrowLeft => [-1.0, 0.0],
                Key::ArrowRight => [1.0, 0.0],
                Key::ArrowDown => [0.0, -1.0],
                Key::ArrowUp => [0.0, 1.0],
                _ => [0.0; 2],
            };
            match key {
                Key::ArrowLeft | Key::ArrowRight | Key::ArrowDown | Key::ArrowUp => {
                    if modifiers.command {
                        view.pan([x, y]);
                    } else if let Some(present) = cursor {
                        if y == 0.0 || !next(present, curves, y, view) {
                            let far = STEP * times;
                            view.go(present, [x * far, y * far], curves);
                        }
                    } else {
                        *cursor = Some(Cursor::free(view.begin(self.begin(plot.ctx()))));
                    }
                }
                Key::Plus | Key::Equals if !modifiers.command => view.zoom(NEARER, cursor.as_ref()),
                Key::Minus if !modifiers.command => view.zoom(1.0 / NEARER, cursor.as_ref()),
                Key::Home | Key::Num0 if !modifiers.command => {
                    let auto = plot.auto_bounds();
                    plot.set_auto_bounds([auto.x || self.axes[0], auto.y || self.axes[1]]);
                }
                Key::Escape => *cursor = None,
                Key::Enter => menu = true,
                _ => {}
            }
        }
        menu
    }

    /// The x where a cursor begins: where the last one was, in this plot or in one whose x is the same.
    fn begin(&self, ctx: &Context) -> Option<f64> {
        let same =
            |r: &Reading| r.plot == self.plot || (r.group.is_some() && r.group == self.group);
        chart_cursor::last(ctx).filter(same).map(|r| r.cursor.at[0])
    }
}

/// The keys that went down in this frame.
fn pressed(ctx: &Context) -> Vec<(Key, Modifiers)> {
    let down = |event: &Event| match event {
        Event::Key {
            key,
            pressed: true,
            modifiers,
            ..
        } if !modifiers.alt => Some((*key, *modifiers)),
        _ => None,
    };
    ctx.input(|input| input.events.iter().filter_map(down).collect())
}

/// Whether curves are followed; else the cursor goes anywhere.
fn follows(curves: &[Curve]) -> bool {
    curves.iter().any(|c| c.joined)
}

/// Takes the cursor to the next value above or below; false where no curve has any.
fn next(cursor: &mut Cursor, curves: &[Curve], up: f64, view: &View) -> bool {
    if !follows(curves) {
        return false;
    }
    let all = values(curves, cursor.at[0], view.half());
    let above = |c: &Cursor| up * (c.at[1] - cursor.at[1]);
    let least = 0.5 * view.point[1];
    let further = all.iter().filter(|c| above(c) > least);
    let next = further
        .min_by(|a, b| above(a).total_cmp(&above(b)))
        .cloned();
    if let Some(next) = next {
        // It stays in its column: a point may be a little beside it.
        let at = [cursor.at[0], next.at[1]];
        *cursor = Cursor { at, ..next };
    }
    !all.is_empty()
}

/// The cursor on its curve, or else on the nearest there is.
fn settled(cursor: Cursor, curves: &[Curve], view: &View) -> Cursor {
    if !follows(curves) {
        return cursor;
    }
    let away = |c: &Cursor| (c.at[1] - cursor.at[1]).abs();
    let all = values(curves, cursor.at[0], view.half());
    let same = all.iter().filter(|c| c.curve == cursor.curve);
    let by = |a: &&Cursor, b: &&Cursor| away(a).total_cmp(&away(b));
    let found = same.min_by(by).or_else(|| all.iter().min_by(by)).cloned();
    found.unwrap_or(Cursor {
        curve: None,
        ..cursor
    })
}

impl View {
    fn of(plot: &PlotUi<'_>, axes: [bool; 2]) -> Self {
        let bounds = plot.plot_bounds();
        let point = plot.transform().dvalue_dpos().map(f64::abs);
        let ends = [0, 1].map(|i| [bounds.min()[i], bounds.max()[i]]);
        Self { ends, point, axes }
    }

    fn half(&self) -> f64 {
        0.5 * STEP * self.point[0]
    }

    /// Where a cursor begins: at this x if it is in view, else in the middle.
    fn begin(&self, x: Option<f64>) -> [f64; 2] {
        let [across, up] = self.ends.map(|[low, high]| f64::midpoint(low, high));
        let seen = |x: &f64| (self.ends[0][0]..=self.ends[0][1]).contains(x);
        [x.filter(seen).unwrap_or(across), up]
    }

    /// Moves the cursor by so many points, no further than the curves go; what is in view goes with it.
    fn go(&mut self, cursor: &mut Cursor, by: [f64; 2], curves: &[Curve]) {
        for i in [0, 1] {
            let [mut low, mut high] = self.ends[i];
            if self.axes[i] && follows(curves) {
                let all = curves.iter().flat_map(|c| c.points.iter().map(|p| p[i]));
                (low, high) = hysteron_core::curve::extremes(all);
            }
            if low <= high {
                cursor.at[i] = (cursor.at[i] + by[i] * self.point[i]).clamp(low, high);
            }
            let [low, high] = self.ends[i];
            let beyond = (cursor.at[i] - high).max(0.0) - (low - cursor.at[i]).max(0.0);
            self.shift(i, beyond);
        }
    }

    fn shift(&mut self, i: usize, by: f64) {
        self.set(i, self.ends[i].map(|end| end + by));
    }

    fn pan(&mut self, by: [f64; 2]) {
        for i in [0, 1] {
            self.shift(i, by[i] * SHARE * (self.ends[i][1] - self.ends[i][0]));
        }
    }

    /// Zooms about the cursor, or about the middle.
    fn zoom(&mut self, times: f64, cursor: Option<&Cursor>) {
        let about = cursor.map_or(self.begin(None), |c| c.at);
        for i in [0, 1] {
            let [low, high] = self.ends[i];
            let about = about[i].clamp(low, high);
            self.set(i, self.ends[i].map(|end| about + (end - about) / times));
        }
    }

    fn set(&mut self, i: usize, ends: [f64; 2]) {
        if self.axes[i] && zoom::can_be(&ends) {
            self.ends[i] = ends;
        }
    }

    /// Shows what has changed.
    fn show(&self, plot: &mut PlotUi<'_>) {
        let before = Self::of(plot, self.axes).ends;
        let [[left, right], [low, high]] = self.ends;
        if before[0] != self.ends[0] {
            plot.set_plot_bounds_x(left..=right);
        }
        if before[1] != self.ends[1] {
            plot.set_plot_bounds_y(low..=high);
        }
    }
}
