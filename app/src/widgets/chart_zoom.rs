//! The zoom of the plots of the page in front: each plot does what was wished, and says what it shows.

use egui::{Context, Id};
use egui_plot::{PlotMemory, PlotUi};

use crate::zoom::{Zoom, Zooms, name};

/// Key under which they lie while the page is drawn.
fn key() -> Id {
    Id::unique("zooms")
}

/// What is wished of the plots of the page that is drawn now.
pub fn begin(ctx: &Context, wished: Zooms) {
    ctx.data_mut(|data| data.insert_temp(key(), wished));
}

/// What they show.
pub fn end(ctx: &Context) -> Zooms {
    ctx.data_mut(|data| data.remove_temp(key()))
        .unwrap_or_default()
}

/// A plot and those of its axes that can be zoomed.
pub struct Zoomed {
    pub plot: Id,
    name: String,
    axes: [bool; 2],
}

impl Zoomed {
    pub fn new(plot: Id, title: &str, axes: [bool; 2]) -> Self {
        Self {
            plot,
            name: name(title),
            axes,
        }
    }

    /// What is to be set: the wish, where the plot shows something else.
    pub fn change(&self, ctx: &Context) -> Option<Change> {
        if self.axes == [false; 2] {
            return None;
        }
        let all: Zooms = ctx.data(|data| data.get_temp(key())).unwrap_or_default();
        let wished = all.of(&self.name);
        (self.shown(ctx, wished) != Some(wished)).then_some(Change(wished))
    }

    /// Says what is shown.
    pub fn note(&self, ctx: &Context) {
        if self.axes == [false; 2] {
            return;
        }
        let mut all: Zooms = ctx.data(|data| data.get_temp(key())).unwrap_or_default();
        let shown = self.shown(ctx, all.of(&self.name));
        all.note(&self.name, shown.unwrap_or_default());
        begin(ctx, all);
    }

    /// What is shown of a plot that has been shown before.
    fn shown(&self, ctx: &Context, wished: Zoom) -> Option<Zoom> {
        let memory = PlotMemory::load(ctx, self.plot)?;
        let bounds = memory.bounds();
        let chosen = [0, 1].map(|i| {
            let own = [memory.auto_bounds.x, memory.auto_bounds.y][i] || !self.axes[i];
            (!own).then(|| [bounds.min()[i], bounds.max()[i]])
        });
        let zoom = Zoom { axes: chosen };
        // What was wished stays as it was written.
        Some(if zoom == wished { zoom } else { zoom.tidied() })
    }
}

/// What a plot is to show.
pub struct Change(Zoom);

impl Change {
    /// Sets it.
    pub fn make(&self, plot: &mut PlotUi<'_>) {
        let [x, y] = self.0.axes;
        plot.set_auto_bounds([x.is_none(), y.is_none()]);
        if let Some([from, to]) = x {
            plot.set_plot_bounds_x(from..=to);
        }
        if let Some([from, to]) = y {
            plot.set_plot_bounds_y(from..=to);
        }
    }
}
