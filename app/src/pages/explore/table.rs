//! The numbers: three ways to the same cycle, side by side.

use hysteron_core::explore::{ExploreData, ExploreInput};
use hysteron_core::limit_cycle::Cycle;
use hysteron_core::tuning::relay_gain;

use super::cycle_table;
use crate::language::{tr, tr_number};
use crate::theme;
use crate::widgets::equation::equation_ui;

/// Describing function, exact and simulated values with their differences in per cent.
pub fn predictions_ui(ui: &mut egui::Ui, input: &ExploreInput, data: &ExploreData) {
    let gain = |c: &Cycle| relay_gain(&input.plant, &input.relay, c).by_relay.gain;
    let row = |cycle: Option<Cycle>| cycle.map(|c| ([c.period, c.amplitude, gain(&c)], c.stable));
    let predicted = data.describing().map(|i| i.cycle);
    let rows = [predicted, data.exact, data.simulated].map(row);
    cycle_table::ui(ui, ["period [s]", "amplitude", "Ku"], 7.0, &rows);
    ui.small(tr("Amplitude a: half of peak to peak. Ku = 4k/(πa), eq. (9). Below each: difference from the exact value."));
    if let Some(ultimate) = &data.ultimate {
        ui.label(tr(&ultimate.text));
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
            ui.add_sized([24.0, 14.0], egui::Label::new(harmonic.order.to_string()));
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
