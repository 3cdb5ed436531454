//! What the plots of several pages share.

use std::rc::Rc;

use egui::{Id, IdSalt, WidgetInfo};
use egui_plot::{
    AxisHints, HoverPosition, Plot, PlotMemory, PlotPoints, PlotResponse, Points,
    uniform_grid_spacer,
};

use super::chart_axes::{
    LABELS, beside, grid, grid_x, label, named, plain, power_label, powers, scale, shown_from,
    title,
};
pub use super::chart_axes::{round_step, span_decades};
pub use super::chart_caption::{Key, Shape, caption_ui};
use super::chart_cursor::{self, cursor_ui, linked_ui};
use super::chart_keys::Worked;
use super::chart_menu;
pub use super::chart_pen::Pen;
use super::chart_reading::{Reader, reading};
use super::chart_zoom::Zoomed;
use crate::export::Table;
use crate::language::tr;
use crate::theme;
pub use hysteron_core::curve::{envelope, extremes, sparse};
use hysteron_core::message::Message;
use hysteron_core::msg;
use hysteron_core::uncertain::Scale;
pub use hysteron_core::uncertain::significant;

/// How much fainter the lines of the grid are the closer they stand: fainter than any curve.
const GRID_FADE: f32 = 1.0;

pub fn curve(points: &[[f64; 2]]) -> PlotPoints<'static> {
    points.iter().copied().collect()
}

/// A plot whose axes have names, whose labels have as many decimals as they need, and that has a menu.
pub struct Chart<'a> {
    plot: Plot<'a>,
    salt: IdSalt,
    /// What its zoom is called in links, and which of its axes have one.
    zoom: (String, [bool; 2]),
    /// Names of the axes with their units.
    axes: [Message; 2],
    /// The x, and the y, of what is drawn are logarithms to base 10.
    decades: [bool; 2],
    /// It can be dragged only while it is zoomed: else a finger on it moves the page.
    drag_zoomed: bool,
    /// Least width of the labels of y, and height, points.
    width: f32,
    height: f32,
    /// What is read in it where not the values of its axes are, and plots that show each other where they are read:
    /// their x is the same.
    read: Option<Reader<'a>>,
    linked: Option<Id>,
    /// Enter is for the page, not for the menu.
    pressed: bool,
}

impl<'a> Chart<'a> {
    /// A plot of this height; the labels of y are at least `width` wide, so that plots above each other line up.
    /// No other of its page has its name.
    pub fn new(
        name: impl Into<String>,
        [x, y]: [impl Into<Message>; 2],
        height: f32,
        width: f32,
    ) -> Self {
        let name = name.into();
        let salt = IdSalt::new(&name);
        let axes = [named(x.into()), named(y.into())];
        let plot = Plot::new(salt)
            .height(height)
            .allow_scroll(false)
            .grid_fade(GRID_FADE)
            .y_grid_spacer(uniform_grid_spacer(|input| grid(&input, LABELS[1])));
        Self {
            plot,
            salt,
            zoom: (name, [true; 2]),
            axes,
            decades: [false; 2],
            drag_zoomed: false,
            width,
            height,
            read: None,
            linked: None,
            pressed: false,
        }
    }

    /// With a logarithmic x: what is drawn has the logarithm to base 10 there, and what is read its power.
    #[must_use]
    pub fn decades(mut self) -> Self {
        self.decades[0] = true;
        self
    }

    /// The same with y.
    #[must_use]
    pub fn decades_up(mut self) -> Self {
        self.decades[1] = true;
        self.with(|plot| plot.y_grid_spacer(|input| powers(&input)))
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

    /// Shows where others of this group are read, and they where it is.
    #[must_use]
    pub fn linked(mut self, group: Id) -> Self {
        self.linked = Some(group);
        self
    }

    /// Is a choice of places, of which these words are said; a press takes one.
    #[must_use]
    pub fn choice(mut self, read: impl Fn([f64; 2]) -> Option<String> + 'a) -> Self {
        self.pressed = true;
        self.read = Some(Rc::new(move |at| match at {
            HoverPosition::NearDataPoint { position, .. }
            | HoverPosition::Elsewhere { position } => read([position.x, position.y]),
        }));
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
        let ctx = ui.ctx().clone();
        let id = ui.scope_id().with(self.salt);
        let (axes, decades) = (self.axes, self.decades);
        // In the units that suit what it showed last.
        let scales = scales_of(&ctx, id, &axes, decades);
        let names = [0, 1].map(|i| tr(title(&axes[i], &scales[i])));
        let factors = scales.each_ref().map(|s| s.factor);
        let own = self.read;
        let read = own.unwrap_or_else(|| in_units(names.clone(), factors, decades));
        let size = [self.width, self.height];
        let plot = self.plot.id(id).grid_color(theme::grid(ui.visuals()));
        let plot = with_axes(ui, plot, names, factors, decades, size);
        let menu = egui::Popup::is_any_open(&ctx);
        let mut plot = with_pointer(&ctx, plot, menu, &read);
        let (name, zoomed) = self.zoom;
        let mut stays = zoomed == [true, false];
        if self.drag_zoomed {
            let memory = PlotMemory::load(&ctx, id);
            let zoomed = memory.is_some_and(|m| !m.auto_bounds.all());
            plot = plot.allow_drag(zoomed);
            stays |= !zoomed;
        }
        let zoom = Zoomed::new(id, &name, zoomed);
        let change = zoom.change(&ctx);
        if change.is_some() {
            // What is drawn may depend on what was in view before.
            ctx.request_repaint();
        }
        let start = ui.cursor().min;
        let table = chart_menu::wants_numbers(&ctx, id).then(|| Table::new("plot"));
        let titles = axes.each_ref().map(Message::to_string);
        let worked = Worked {
            plot: id,
            group: self.linked,
            axes: zoomed,
        };
        let shown = plot.show(ui, move |plot| {
            if let Some(change) = change {
                change.make(plot);
            }
            let mut pen = Pen::new(plot, id, titles, decades, table);
            let inner = draw(&mut pen);
            let curves = pen.curves.unwrap_or_default();
            let asked = worked.work(pen.plot, &curves);
            (inner, pen.table, asked)
        });
        zoom.note(&ctx);
        if scales_of(&ctx, id, &axes, decades) != scales {
            ctx.request_repaint();
        }
        let (inner, table, asked) = shown.inner;
        let shown = PlotResponse {
            inner,
            response: shown.response,
            transform: shown.transform,
            hovered_plot_item: shown.hovered_plot_item,
        };
        if stays {
            scroll_by_touch(ui, &shown.response);
        }
        read_ui(ui, &shown, (id, self.linked), &axes, &read, !menu);
        let asked = asked && !self.pressed;
        chart_menu::ui(ui, id, &axes, start, shown.response.rect, (table, asked));
        shown
    }
}

/// What is read by the values of the axes, in their units.
fn in_units<'a>(names: [String; 2], [across, up]: [f64; 2], decades: [bool; 2]) -> Reader<'a> {
    reading(names, move |p| {
        let [x, y] = plain(decades, [p.x, p.y]);
        [x / across, y / up]
    })
}

/// Says what is read at the pointer, where that would not cover an open menu or what the keys read.
fn with_pointer<'a>(
    ctx: &egui::Context,
    plot: Plot<'a>,
    menu: bool,
    read: &Reader<'a>,
) -> Plot<'a> {
    let keys = chart_cursor::live(ctx).is_some();
    if menu || keys {
        return plot.label_formatter(|_| None).show_crosshair(!keys);
    }
    let read = read.clone();
    plot.label_formatter(move |at| read(at))
}

/// A finger that goes up or down over a plot that stays moves the page, which the plot would keep it from.
fn scroll_by_touch(ui: &egui::Ui, response: &egui::Response) {
    if response.dragged() && ui.input(egui::InputState::any_touches) {
        ui.scroll_with_delta(egui::vec2(0.0, response.drag_delta().y));
    }
}

/// What is read: where plots of its group are read, the words for who cannot see it, and, where it is `bare` of a menu,
/// the cursor of the keys.
fn read_ui<R>(
    ui: &egui::Ui,
    shown: &PlotResponse<R>,
    (id, group): (Id, Option<Id>),
    axes: &[Message; 2],
    read: &Reader<'_>,
    bare: bool,
) {
    let (response, transform) = (&shown.response, &shown.transform);
    let live = chart_cursor::live(ui.ctx());
    let cursor = live.as_ref().filter(|r| r.plot == id).map(|r| &r.cursor);
    if let Some(group) = group {
        let pointer = response.hover_pos().filter(|_| live.is_none());
        let x = cursor.map(|c| c.at[0]);
        let x = x.or(pointer.map(|p| transform.value_from_position(p).x));
        linked_ui(ui, transform, group, id, x);
    }
    let text = cursor.and_then(|c| c.text(read));
    response.widget_info(|| words(axes, text.as_deref()));
    if let Some(cursor) = cursor.filter(|_| bare && !chart_menu::wished(ui.ctx(), id)) {
        theme::tell(response);
        cursor_ui(ui, response, transform, cursor, text.as_deref());
    }
}

/// A plot in words: its axes, and what the keys read in it.
fn words(axes: &[Message; 2], text: Option<&str>) -> WidgetInfo {
    let name = tr(msg!("Plot: {} over {}", &axes[1], &axes[0]));
    WidgetInfo {
        current_text_value: text.map(|t| t.replace('\n', "; ")),
        ..WidgetInfo::labeled(egui::Role::Image, true, name)
    }
}

/// The units in which the axes of a plot are read, by what it showed last.
fn scales_of(ctx: &egui::Context, id: Id, axes: &[Message; 2], decades: [bool; 2]) -> [Scale; 2] {
    let memory = PlotMemory::load(ctx, id);
    [0, 1].map(|i| {
        let size = memory.as_ref().map_or(0.0, |memory| {
            let bounds = memory.bounds();
            bounds.min()[i].abs().max(bounds.max()[i].abs())
        });
        // A logarithmic axis shows powers of its unit.
        let size = if decades[i] { 0.0 } else { size };
        scale(&axes[i], size)
    })
}

/// The axes with their names and labels; `size` is the least width of the labels of y and the height of the plot.
fn with_axes<'a>(
    ui: &egui::Ui,
    plot: Plot<'a>,
    [x, y]: [String; 2],
    [across, up]: [f64; 2],
    decades: [bool; 2],
    [width, height]: [f32; 2],
) -> Plot<'a> {
    let font = egui::TextStyle::Body.resolve(ui.style());
    let wide = |text: &str| theme::text_width(ui, text.to_owned(), font.clone());
    let y = AxisHints::new_y()
        .label(beside(&y, height, wide))
        .min_thickness(width)
        .label_spacing(shown_from(LABELS[1][1]));
    let y = if decades[1] {
        y.formatter(|mark, _| power_label(mark.value))
    } else {
        y.formatter(move |mark, _| label(mark, up))
    };
    let x = AxisHints::new_x()
        .label(x)
        .label_spacing(shown_from(LABELS[0][1]));
    let (x, plot) = if decades[0] {
        let x = x.formatter(|mark, _| power_label(mark.value));
        (x, plot.x_grid_spacer(|input| powers(&input)))
    } else {
        let x = x.formatter(move |mark, _| label(mark, across));
        let lines = uniform_grid_spacer(move |input| grid_x(&input, across));
        (x, plot.x_grid_spacer(lines))
    };
    plot.custom_x_axes(vec![x]).custom_y_axes(vec![y])
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
