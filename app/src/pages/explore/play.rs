//! Play between plant and relay: its describing function, and the cycles with it.

use egui_plot::{Line, Points};
use hysteron_core::drive::play_describing_function;

use super::further::WithPlay;
use crate::language::{tr, tr_number};
use crate::theme;
use crate::widgets::chart::{Shape, caption_ui, curve, still};
use crate::widgets::controls::slider;

/// Points of the curve, and the largest amplitude on it in half gaps.
const POINTS: usize = 120;
const FARTHEST: f64 = 60.0;

/// Half gap at which the slider begins, in the unit of the output.
pub const HALF_GAP: f64 = 0.05;

/// Draws both; the half gap can be changed.
pub fn ui(ui: &mut egui::Ui, half_gap: &mut f64, seen: Option<&WithPlay>, height: f32) {
    caption_ui(
        ui,
        "Play between plant and relay",
        &[
            ("N of the play", theme::MODEL, Shape::Line),
            ("in the cycle", theme::INPUT, Shape::Diamond),
        ],
    );
    slider(ui, half_gap, HALF_GAP, 1.0, 0.0..=0.5, "half gap β").on_hover_text(tr(
        "How far the output must turn back before the relay sees it",
    ));
    let first = seen.and_then(|s| s.balanced.first());
    // Amplitudes in half gaps: the curve is the same for every play.
    let of = |ratio: f64| play_describing_function(ratio, 1.0).map(|n| [n.re, n.im]);
    let all: Vec<[f64; 2]> = (1..=POINTS)
        .map(|i| FARTHEST.powf(i as f64 / POINTS as f64))
        .filter_map(of)
        .collect();
    let now = first
        .filter(|_| *half_gap > 0.0)
        .and_then(|c| of(c.before / *half_gap));
    still("play", "real part", "imaginary part", height).show(ui, |plot| {
        plot.line(
            Line::new(tr("N of the play"), curve(&all))
                .color(theme::MODEL)
                .width(2.0),
        );
        if let Some(at) = now {
            plot.points(
                Points::new(tr("in the cycle"), vec![at])
                    .color(theme::INPUT)
                    .radius(6.0),
            );
        }
    });
    table_ui(ui, seen);
}

/// The cycles: balanced and exact.
fn table_ui(ui: &mut egui::Ui, seen: Option<&WithPlay>) {
    let Some(seen) = seen else {
        ui.label(tr("For a symmetric relay only."));
        return;
    };
    if seen.balanced.is_empty() {
        ui.label(tr("With this play no cycle is predicted."));
        return;
    }
    egui::Grid::new("play_cycles")
        .num_columns(4)
        .striped(true)
        .show(ui, |ui| {
            for title in ["", "period [s]", "before the play", "at the relay"] {
                ui.strong(tr(title));
            }
            ui.end_row();
            for cycle in &seen.balanced {
                ui.label(tr("Describing functions"));
                for value in [cycle.period, cycle.before, cycle.at_relay] {
                    ui.label(tr_number(format!("{value:.4}")));
                }
                ui.end_row();
            }
            if let Some(exact) = seen.exact {
                ui.label(tr("Exact"));
                for value in [exact.period, exact.amplitude] {
                    ui.label(tr_number(format!("{value:.4}")));
                }
                ui.end_row();
            }
        });
    ui.small(tr(
        "Exactly, play before a relay adds its half gap to the hysteresis.",
    ));
}
