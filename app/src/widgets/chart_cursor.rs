//! The cursor that keys move in the plot that has the keyboard, and what plots that show the same show of each other:
//! where one of them is pointed at, by the pointer or by keys, the others have a mark.

use egui::{Context, Id, Rect, Stroke, Ui};
use egui_plot::{HoverPosition, PlotPoint, PlotTransform};

use super::chart_reading::Reader;

/// Radius of a mark, points.
const MARK: f32 = 5.0;

/// Distance of what is read from the cursor, points.
const ASIDE: f32 = 12.0;

/// A curve of a plot as it is read; one that is not joined is read at its points alone.
pub struct Curve {
    pub name: String,
    pub points: Vec<[f64; 2]>,
    pub joined: bool,
}

/// A place in a plot, and the curve that is read there, if there is one.
#[derive(Clone, Debug, PartialEq)]
pub struct Cursor {
    pub at: [f64; 2],
    pub curve: Option<String>,
}

impl Cursor {
    /// Between the curves.
    pub fn free(at: [f64; 2]) -> Self {
        Self { at, curve: None }
    }

    /// What stands there, in words.
    pub fn text(&self, read: &Reader<'_>) -> Option<String> {
        let position = PlotPoint::from(self.at);
        read(&match &self.curve {
            Some(name) => HoverPosition::NearDataPoint {
                plot_name: name,
                position,
                index: 0,
            },
            None => HoverPosition::Elsewhere { position },
        })
    }
}

/// All that curves have at an x, or within `half` of it where they are points.
pub fn values(curves: &[Curve], x: f64, half: f64) -> Vec<Cursor> {
    let mut found = Vec::new();
    for curve in curves {
        let mut add = |at: [f64; 2]| {
            let curve = Some(curve.name.clone());
            found.push(Cursor { at, curve });
        };
        if curve.joined {
            for pair in curve.points.windows(2) {
                let ([x0, y0], [x1, y1]) = (pair[0], pair[1]);
                if (x0.min(x1)..=x0.max(x1)).contains(&x) {
                    let share = if x1 == x0 { 1.0 } else { (x - x0) / (x1 - x0) };
                    add([x, y0 + share * (y1 - y0)]);
                }
            }
        } else {
            let near = |p: &&[f64; 2]| (p[0] - x).abs() <= half;
            curve
                .points
                .iter()
                .copied()
                .filter(|p| near(&p))
                .for_each(&mut add);
        }
    }
    found
}

/// What the keys read: the last plot that they were in, and where.
#[derive(Clone, Debug)]
pub struct Reading {
    pub plot: Id,
    /// The widget that has the keyboard meanwhile.
    pub widget: Id,
    pub group: Option<Id>,
    pub cursor: Cursor,
    /// Whether it is shown; what is left is where the next one begins.
    pub live: bool,
}

fn reading_key() -> Id {
    Id::unique("plot_reading")
}

/// What the keys read, or have read last.
pub fn last(ctx: &Context) -> Option<Reading> {
    ctx.data(|data| data.get_temp(reading_key()))
}

/// What the keys read now.
pub fn live(ctx: &Context) -> Option<Reading> {
    let focused = ctx.memory(egui::Memory::focused);
    last(ctx).filter(|r| r.live && focused == Some(r.widget))
}

pub fn set(ctx: &Context, reading: Reading) {
    ctx.data_mut(|data| data.insert_temp(reading_key(), reading));
}

/// Shows nothing more of what the keys read.
pub fn leave(ctx: &Context) {
    if let Some(reading) = last(ctx) {
        let live = false;
        set(ctx, Reading { live, ..reading });
    }
}

/// Where a plot of a group is pointed at.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Pointed {
    group: Id,
    plot: Id,
    x: f64,
}

/// It lies there with the number of the frame: a plot may be gone before it can say that it is left.
fn pointed_key() -> Id {
    Id::unique("plots_pointed")
}

fn pointed_now(ctx: &Context) -> Option<Pointed> {
    let (pointed, frame) = ctx.data(|data| data.get_temp::<(Pointed, u64)>(pointed_key()))?;
    (frame + 1 >= ctx.cumulative_frame_nr()).then_some(pointed)
}

/// Says where a plot of a group is pointed at, or that it is not.
pub fn point(ctx: &Context, group: Id, plot: Id, x: Option<f64>) {
    let before = pointed_now(ctx).filter(|p| p.group == group && p.plot == plot);
    let now = x.map(|x| Pointed { group, plot, x });
    let (key, frame) = (pointed_key(), ctx.cumulative_frame_nr());
    ctx.data_mut(|data| match now {
        Some(now) => {
            data.insert_temp(key, (now, frame));
        }
        None if before.is_some() => data.remove::<(Pointed, u64)>(key),
        None => {}
    });
    if before != now {
        // Others are drawn already.
        ctx.request_repaint();
    }
}

/// Where a plot of a group is pointed at: which one, and its x.
pub fn pointed(ctx: &Context, group: Id) -> Option<(Id, f64)> {
    let pointed = pointed_now(ctx).filter(|p| p.group == group)?;
    Some((pointed.plot, pointed.x))
}

/// In the colour of the ring around what has the keyboard, which no curve and no line of the grid has.
fn stroke(ui: &Ui, width: f32) -> Stroke {
    Stroke::new(width, ui.visuals().selection.stroke.color)
}

/// A line at an x.
fn line_ui(ui: &Ui, transform: &PlotTransform, x: f64) {
    let x = transform.position_from_point_x(x);
    ui.painter().with_clip_rect(seen(ui, transform)).vline(
        x,
        transform.frame().y_range(),
        stroke(ui, 1.0),
    );
}

/// Says at which x a plot of a group is pointed at, and shows in it where another of them is.
pub fn linked_ui(ui: &Ui, transform: &PlotTransform, group: Id, plot: Id, x: Option<f64>) {
    point(ui.ctx(), group, plot, x);
    if let Some((other, x)) = pointed(ui.ctx(), group)
        && other != plot
    {
        line_ui(ui, transform, x);
    }
}

/// A ring around a place.
pub fn mark_ui(ui: &Ui, transform: &PlotTransform, at: [f64; 2]) {
    let place = transform.position_from_point(&PlotPoint::from(at));
    ui.painter()
        .with_clip_rect(seen(ui, transform))
        .circle_stroke(place, MARK, stroke(ui, 2.0));
}

/// The cursor, and what is read there.
pub fn cursor_ui(
    ui: &Ui,
    plot: &egui::Response,
    transform: &PlotTransform,
    cursor: &Cursor,
    text: Option<&str>,
) {
    line_ui(ui, transform, cursor.at[0]);
    let place = transform.position_from_point(&PlotPoint::from(cursor.at));
    ui.painter().with_clip_rect(seen(ui, transform)).hline(
        transform.frame().x_range(),
        place.y,
        stroke(ui, 1.0),
    );
    if cursor.curve.is_some() {
        mark_ui(ui, transform, cursor.at);
    }
    let Some(text) = text else {
        return;
    };
    let anchor = transform.frame().clamp(place);
    let width = ui.spacing().tooltip_width;
    egui::Tooltip::always_open(ui.ctx().clone(), plot.layer_id, plot.id, anchor)
        .gap(ASIDE)
        .width(width)
        .show(|ui| {
            ui.set_max_width(width);
            ui.label(text);
        });
}

fn seen(ui: &Ui, transform: &PlotTransform) -> Rect {
    transform.frame().intersect(ui.clip_rect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_has_a_value_wherever_it_passes_and_points_where_they_are() {
        let curve = |name: &str, joined, points: &[[f64; 2]]| Curve {
            name: name.to_owned(),
            points: points.to_vec(),
            joined,
        };
        let curves = [
            curve(
                "there and back",
                true,
                &[[0.0, 0.0], [2.0, 4.0], [0.0, 8.0]],
            ),
            curve("points", false, &[[1.1, 3.0], [1.6, 5.0]]),
        ];
        let at =
            |x: f64| -> Vec<[f64; 2]> { values(&curves, x, 0.2).iter().map(|c| c.at).collect() };
        assert_eq!(at(1.0), [[1.0, 2.0], [1.0, 6.0], [1.1, 3.0]]);
        assert_eq!(at(0.5), [[0.5, 1.0], [0.5, 7.0]]);
        assert_eq!(at(3.0), [[0.0; 2]; 0]);
    }
}
