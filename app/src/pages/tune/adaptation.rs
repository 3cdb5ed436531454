//! Step 3: the gain for a phase margin, by the relay of equation (7) and the adaptation (8).

use egui_plot::{Line, MarkerShape, Points};
use hysteron_core::tuning::PhaseMarginReport;
use hysteron_core::uncertain::significant;

use super::draw::{beside, curve, number, plot, table};
use super::stage::{Seen, Stage};
use crate::language::{tr, tr_number};
use crate::theme;

pub const STAGE: Stage = Stage {
    id: "adaptation",
    title: "Phase margin",
    question: "Which proportional gain gives the wanted phase margin?",
    answer,
    next: "One test with an asymmetric relay gives a whole model: step 4.",
    ui,
};

fn answer(seen: Seen<'_>) -> String {
    let wanted = seen.input.wish.phase_margin.to_degrees();
    match &seen.report.phase_margin {
        Ok(found) => format!(
            "K = {} for {wanted:.0}°, after {} changes of the gain{}.",
            number(found.adaptation.gain),
            found.adaptation.steps.len() - 1,
            found
                .true_phase_margin
                .map_or_else(String::new, |m| format!(
                    "; the true margin is {:.1}°",
                    m.to_degrees()
                ))
        ),
        Err(error) => format!("No gain was found for {wanted:.0}°: {error}."),
    }
}

fn ui(ui: &mut egui::Ui, seen: Seen<'_>, height: f32, _rule: &mut String) {
    let Ok(found) = &seen.report.phase_margin else {
        ui.label(tr("Try a smaller phase margin."));
        return;
    };
    let design = &found.adaptation.design;
    ui.label(tr(format!(
        "A relay with k = π a/4 = {} and ε = a sin φ = {} stands in series with the gain K, which is changed from run to run until the amplitude is a = {}. Every step squares the error.",
        number(design.gain),
        number(design.hysteresis),
        number(design.amplitude)
    )));
    beside(
        ui,
        height,
        |ui, height| convergence_ui(ui, found, height),
        |ui, _| table_ui(ui, found),
    );
}

fn convergence_ui(ui: &mut egui::Ui, found: &PhaseMarginReport, height: f32) {
    let errors: Vec<[f64; 2]> = found
        .adaptation
        .steps
        .iter()
        .enumerate()
        .map(|(n, step)| [n as f64, step.error.abs().max(f64::EPSILON).log10()])
        .collect();
    plot(
        "convergence",
        height,
        "step n",
        "error of the amplitude, log10",
    )
    .with(|plot| plot.include_y(0.0))
    .show(ui, |plot| {
        plot.line(
            Line::new(tr("relative error"), curve(&errors))
                .color(theme::SIMULATED)
                .width(2.0),
        );
        plot.points(
            Points::new(tr("relative error"), curve(&errors))
                .color(theme::SIMULATED)
                .radius(5.0)
                .shape(MarkerShape::Circle),
        );
    });
}

fn table_ui(ui: &mut egui::Ui, found: &PhaseMarginReport) {
    let adaptation = &found.adaptation;
    let heads = ["n", "K(n)", "error of a", "period [s]", "order"];
    table(ui, "adaptation table", &heads, |ui| {
        for (n, step) in adaptation.steps.iter().enumerate() {
            ui.label(tr(n.to_string()));
            ui.label(tr_number(format!("{:.6}", step.gain)));
            ui.label(tr_number(significant(step.error, 2)));
            ui.label(tr(number(step.test.period)));
            // The first order needs three errors.
            let order = n.checked_sub(2).and_then(|i| adaptation.orders.get(i));
            ui.label(tr(order.map_or_else(String::new, |o| format!("{o:.2}"))));
            ui.end_row();
        }
    });
    ui.small(tr("Order 2: quadratic convergence (Steffensen's secant through a run and its proportional correction)."));
    if let Some(truth) = found.true_phase_margin {
        ui.label(tr(format!(
            "With this K the true phase margin is {:.2}°; the difference from the wanted {:.0}° is the error of the describing function.",
            truth.to_degrees(),
            adaptation.design.phase_margin.to_degrees()
        )));
    }
}
