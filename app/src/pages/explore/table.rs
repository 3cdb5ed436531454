//! The numbers: three ways to the same cycle, side by side.

use hysteron_core::explore::{ExploreData, ExploreInput};
use hysteron_core::limit_cycle::Cycle;
use hysteron_core::tuning::relay_gain;

use crate::language::{tr, tr_number};
use crate::theme;
use crate::widgets::chart::significant;
use crate::widgets::equation::equation_ui;

/// Describing function, exact and simulated values with their differences in per cent.
pub fn predictions_ui(ui: &mut egui::Ui, input: &ExploreInput, data: &ExploreData) {
    egui::Grid::new("predictions")
        .num_columns(5)
        .striped(true)
        .spacing([7.0, 4.0])
        .show(ui, |ui| {
            for title in ["", "period [s]", "amplitude", "Ku", "stable"] {
                ui.strong(tr(title));
            }
            ui.end_row();
            let rows = [
                (
                    "Describing\nfunction",
                    data.describing().map(|i| i.cycle),
                    theme::DESCRIBING,
                ),
                ("Exact", data.exact, theme::EXACT),
                ("Simulated", data.simulated, theme::SIMULATED),
            ];
            for (name, cycle, color) in rows {
                let reference = data.exact.filter(|_| name != "Exact");
                row_ui(ui, name, color, input, cycle, reference);
            }
        });
    ui.small(tr("Amplitude a: half of peak to peak. Ku = 4k/(πa), eq. (9). Below each: difference from the exact value."));
    if let Some(ultimate) = &data.ultimate {
        ui.label(tr(&ultimate.text));
    }
}

fn row_ui(
    ui: &mut egui::Ui,
    name: &str,
    color: egui::Color32,
    input: &ExploreInput,
    cycle: Option<Cycle>,
    reference: Option<Cycle>,
) {
    ui.label(
        egui::RichText::new(tr(name))
            .color(theme::readable(ui, color))
            .strong(),
    );
    let Some(cycle) = cycle else {
        ui.label(tr("none"));
        ui.end_row();
        return;
    };
    let gain = |c: Cycle| relay_gain(&input.plant, &input.relay, &c).by_relay.gain;
    let values: [(f64, Option<f64>); 3] = [
        (cycle.period, reference.map(|r| r.period)),
        (cycle.amplitude, reference.map(|r| r.amplitude)),
        (gain(cycle), reference.map(gain)),
    ];
    for (value, exact) in values {
        ui.vertical(|ui| {
            ui.spacing_mut().item_spacing.y = 0.0;
            ui.style_mut().wrap_mode = Some(egui::TextWrapMode::Extend);
            ui.label(tr_number(four_digits(value)));
            if let Some(exact) = exact {
                ui.small(tr(difference(value, exact)));
            }
        });
    }
    ui.label(tr(cycle
        .stable
        .map_or("?", |s| if s { "yes" } else { "no" })));
    ui.end_row();
}

/// A value with four decimals, or with four digits that count: a fast loop has a short period.
pub fn four_digits(value: f64) -> String {
    if value.abs() < 0.1 {
        significant(value, 4)
    } else {
        format!("{value:.4}")
    }
}

pub fn difference(value: f64, exact: f64) -> String {
    /// Below this many per cent two results are the same but for rounding.
    const ROUNDING: f64 = 1e-8;
    let percent = 100.0 * (value / exact - 1.0);
    if percent.abs() < ROUNDING {
        "same".to_owned()
    } else if percent.abs() < 0.005 {
        let sign = if percent > 0.0 { "+" } else { "" };
        format!("{sign}{} %", significant(percent, 1))
    } else {
        format!("{percent:+.2} %")
    }
}

/// Harmonics of the output as bars.
pub fn harmonics_ui(ui: &mut egui::Ui, data: &ExploreData) {
    /// Smaller shares of the first harmonic are not worth a bar.
    const LEAST: f64 = 1e-5;
    let Some(first) = data.harmonics.first() else {
        return;
    };
    ui.strong(tr("Harmonics of the output"));
    for harmonic in &data.harmonics {
        let share = harmonic.amplitude / first.amplitude;
        if share < LEAST {
            continue;
        }
        ui.horizontal(|ui| {
            ui.add_sized(
                [24.0, 14.0],
                egui::Label::new(tr(format!("{}", harmonic.order))),
            );
            let (rect, _) = ui.allocate_exact_size(egui::vec2(230.0, 10.0), egui::Sense::hover());
            let mut bar = rect;
            bar.set_width((rect.width() * share as f32).max(1.5));
            ui.painter()
                .rect_filled(rect, 2.0, ui.visuals().extreme_bg_color);
            ui.painter().rect_filled(bar, 2.0, theme::EXACT);
            ui.label(tr_number(format!("{:.3} %", 100.0 * share)));
        });
    }
    ui.small(tr("The describing function sees only the first."));
}

/// What they say, and the equations behind the page.
const EQUATIONS: [(&str, &str); 5] = [
    ("Relay", "u = -k h(y)"),
    ("Harmonic balance", "P(jω) = -1/N(a)"),
    ("Describing function", "-1/N(a) = -π/(4k) [√(a² - ε²) + jε]"),
    ("Phase margin at S", "sin φ = πε/(4k)"),
    (
        "Exact limit cycle",
        "(I + e^(Ah)) x0 = k [G(h - L) - e^(A(h - L)) G(L)],  C x0 = ε",
    ),
];

/// The equations behind the page.
pub fn equations_ui(ui: &mut egui::Ui) {
    ui.collapsing(tr("The equations"), |ui| {
        for (what, equation) in EQUATIONS {
            ui.small(tr(what));
            equation_ui(ui, equation, &|_| None);
        }
        ui.small(tr(
            "h: half period, L: all delays, G(t): step response of the state.",
        ));
    });
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
