//! What is read in a plot: the curve, and the values by the names and units of their axes.

use std::rc::Rc;

use egui_plot::{HoverPosition, PlotPoint};

use hysteron_core::uncertain::significant;

use crate::language::tr_number;

/// Significant digits of what is read at the pointer; a time needs more, since it grows.
const READ_X: i32 = 6;
const READ_Y: i32 = 5;

/// Says what stands at a place in a plot.
pub type Reader<'a> = Rc<dyn Fn(&HoverPosition<'_>) -> Option<String> + 'a>;

/// What stands at a place: the curve, and the values by the names and units of their axes.
pub(super) fn reading(
    names: [String; 2],
    place: impl Fn(&PlotPoint) -> [f64; 2] + 'static,
) -> Reader<'static> {
    Rc::new(move |at| {
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
    })
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
