//! Describing function, exact and simulated cycle side by side.

use crate::language::{tr, tr_number};
use crate::theme;
use crate::widgets::chart::significant;
use hysteron_core::message::{Message, signed};

/// What one way says of the cycle: numbers in the order of the titles, and whether it is stable; nothing where it sees
/// none.
pub type Row<const N: usize> = Option<([f64; N], Option<bool>)>;

/// The three ways, in the order of [`ui`].
const WAYS: [(&str, egui::Color32); 3] = [
    ("Describing\nfunction", theme::DESCRIBING),
    ("Exact", theme::EXACT),
    ("Simulated", theme::SIMULATED),
];

/// Space between two columns of numbers, points.
pub const APART: f32 = 14.0;

/// Place of the exact cycle, from which the others differ.
const EXACT: usize = 1;

/// Draws the numbers, each with its difference from the exact one in per cent, in columns so far apart, points.
pub fn ui<const N: usize>(
    ui: &mut egui::Ui,
    titles: [&'static str; N],
    apart: f32,
    rows: &[Row<N>; 3],
) {
    egui::Grid::new("cycles")
        .num_columns(N + 2)
        .striped(true)
        .spacing([apart, 4.0])
        .show(ui, |ui| {
            ui.strong("");
            for title in titles {
                ui.strong(tr(title));
            }
            ui.strong(tr("stable"));
            ui.end_row();
            for (i, ((name, color), row)) in WAYS.iter().zip(rows).enumerate() {
                let name = egui::RichText::new(tr(*name)).color(theme::readable(ui, *color));
                ui.label(name.strong());
                let exact = rows[EXACT].filter(|_| i != EXACT);
                row_ui(ui, *row, exact.map(|(values, _)| values));
                ui.end_row();
            }
        });
}

fn row_ui<const N: usize>(ui: &mut egui::Ui, row: Row<N>, exact: Option<[f64; N]>) {
    let Some((values, stable)) = row else {
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
    let stable = stable.map_or("?", |s| if s { "yes" } else { "no" });
    ui.label(tr(stable));
}

/// A value with four decimals, or with four digits that count: a fast loop has a short period.
fn four_digits(value: f64) -> String {
    if value.abs() < 0.1 {
        significant(value, 4)
    } else {
        format!("{value:.4}")
    }
}

/// By how much a value differs from the exact one, in per cent.
pub fn difference(value: f64, exact: f64) -> Message {
    /// Below this many per cent two results are the same but for rounding.
    const ROUNDING: f64 = 1e-8;
    let percent = 100.0 * (value / exact - 1.0);
    if percent.abs() < ROUNDING {
        "same".into()
    } else if percent.abs() < 0.005 {
        let sign = if percent > 0.0 { "+" } else { "" };
        format!("{sign}{} %", significant(percent, 1)).into()
    } else {
        format!("{} %", signed(percent, 2)).into()
    }
}

#[cfg(test)]
mod tests {
    use super::four_digits;

    #[test]
    fn a_short_period_has_its_digits() {
        assert_eq!(four_digits(4.7881), "4.7881");
        assert_eq!(four_digits(0.001_234_5), "0.001234");
        assert_eq!(four_digits(3.2e-5), "3.2 × 10⁻⁵");
        assert_eq!(four_digits(0.0), "0");
    }
}
