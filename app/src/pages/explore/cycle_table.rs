//! Describing function, exact and simulated cycle side by side.

use crate::language::{tr, tr_number};
use crate::theme;

use super::table::{difference, four_digits};

/// What one way says of the cycle.
pub struct Row {
    /// Two numbers, in the order of the titles; nothing where it sees no cycle.
    pub values: Option<[f64; 2]>,
    pub stable: Option<bool>,
}

/// The three ways, in the order of [`ui`].
const WAYS: [(&str, egui::Color32); 3] = [
    ("Describing\nfunction", theme::DESCRIBING),
    ("Exact", theme::EXACT),
    ("Simulated", theme::SIMULATED),
];

/// Place of the exact cycle, from which the others differ.
const EXACT: usize = 1;

/// Draws the numbers, each with its difference from the exact one in per cent.
pub fn ui(ui: &mut egui::Ui, titles: [&str; 2], rows: &[Row; 3]) {
    egui::Grid::new("cycles")
        .num_columns(4)
        .striped(true)
        .spacing([14.0, 4.0])
        .show(ui, |ui| {
            for title in ["", titles[0], titles[1], "stable"] {
                ui.strong(tr(title));
            }
            ui.end_row();
            for (i, ((name, color), row)) in WAYS.iter().zip(rows).enumerate() {
                let name = egui::RichText::new(tr(*name)).color(theme::readable(ui, *color));
                ui.label(name.strong());
                let exact = rows[EXACT].values.filter(|_| i != EXACT);
                row_ui(ui, row, exact);
                ui.end_row();
            }
        });
}

fn row_ui(ui: &mut egui::Ui, row: &Row, exact: Option<[f64; 2]>) {
    let Some(values) = row.values else {
        ui.label(tr("none"));
        return;
    };
    for (i, value) in values.into_iter().enumerate() {
        ui.vertical(|ui| {
            ui.spacing_mut().item_spacing.y = 0.0;
            ui.style_mut().wrap_mode = Some(egui::TextWrapMode::Extend);
            ui.label(tr_number(four_digits(value)));
            if let Some(exact) = exact {
                ui.small(tr(difference(value, exact[i])));
            }
        });
    }
    let stable = row.stable.map_or("?", |s| if s { "yes" } else { "no" });
    ui.label(tr(stable));
}
