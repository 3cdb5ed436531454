//! Equation (3) in the paper's z-form, beside the exact solution.

use egui_plot::{HLine, Line, LineStyle, MarkerShape, Points};

use super::further::ZForm;
use crate::language::tr;
use crate::theme;
use crate::widgets::chart::{Shape, caption_ui, curve, still};

/// Draws it, or says why there is nothing to draw.
pub fn ui(ui: &mut egui::Ui, seen: Option<&ZForm>, height: f32) {
    let Some(seen) = seen else {
        ui.strong(tr("Equation (3), in z"));
        ui.label(tr(
            "It is about the symmetric cycle of a symmetric relay: there is none here.",
        ));
        return;
    };
    caption_ui(
        ui,
        "Equation (3), in z",
        &[
            ("-H(-1)", theme::SIMULATED, Shape::Line),
            ("ε/k", theme::NOISE, Shape::Dashes),
            ("exact cycle", theme::EXACT, Shape::Diamond),
        ],
    );
    still(
        "z-form",
        "half period h [s]",
        "-H(-1), plant sampled every h",
        height,
    )
    .show(ui, |plot| {
        plot.line(
            Line::new(tr("-H(-1)"), curve(&seen.curve))
                .color(theme::SIMULATED)
                .width(2.0),
        );
        plot.hline(
            HLine::new(tr("ε/k"), seen.level)
                .color(theme::NOISE)
                .style(LineStyle::dashed_dense()),
        );
        if let Some(at) = seen.exact {
            plot.points(
                Points::new(tr("exact cycle"), vec![at])
                    .color(theme::EXACT)
                    .shape(MarkerShape::Diamond)
                    .radius(6.0),
            );
        }
    });
    if let Some([h, value]) = seen.exact {
        ui.small(tr(format!(
            "At the exact half period {h:.6} s, -H(-1) = {value:.9} and ε/k = {:.9}: the same condition.",
            seen.level
        )));
    }
}
