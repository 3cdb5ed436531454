//! Step 3: the gain for a phase margin, by the relay of equation (7) and the adaptation (8).

use egui_plot::{Line, MarkerShape, Points};
use hysteron_core::tuning::{Adaptation, AdaptationStep, PhaseMarginReport};

use super::draw::{CAPTION, beside, curve, number, plot, table};
use super::stage::{Seen, Stage};
use crate::language::{tr, tr_number};
use crate::theme;
use crate::widgets::chart::{Shape, caption_ui};

pub const STAGE: Stage = Stage {
    id: "adaptation",
    title: "Phase margin",
    question: "Which proportional gain gives the wanted phase margin?",
    answer,
    next: "One test with an uneven relay tells a whole model: step 4.",
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
                    "; in truth {:.1}°",
                    m.to_degrees()
                ))
        ),
        Err(error) => format!("None was found for {wanted:.0}°: {error}."),
    }
}

fn ui(ui: &mut egui::Ui, seen: Seen<'_>, height: f32, _rule: &mut String) {
    let Ok(found) = &seen.report.phase_margin else {
        ui.label(tr("Try a smaller phase margin."));
        return;
    };
    let design = &found.adaptation.design;
    ui.label(tr(format!(
        "A relay with k = π a/4 = {} and ε = a sin φ = {} stands in series with the gain K, which is changed from run to run until the amplitude is a = {}.",
        number(design.gain),
        number(design.hysteresis),
        number(design.amplitude)
    )));
    ui.label(tr("The plain secant law (8) takes one run a step; Steffensen's step takes two, and squares the error."));
    let shown = stepping_ui(ui, found);
    beside(
        ui,
        height,
        |ui, height| convergence_ui(ui, found, shown, height),
        |ui, _| table_ui(ui, found, shown),
    );
}

/// Steps of both laws; the plain one may not get there.
fn laws(found: &PhaseMarginReport) -> [&[AdaptationStep]; 2] {
    let secant = found.secant.as_ref().map_or(&[][..], |a| &a.steps);
    [secant, &found.adaptation.steps]
}

/// Goes through the steps by hand; gives how many are shown.
fn stepping_ui(ui: &mut egui::Ui, found: &PhaseMarginReport) -> usize {
    let all = laws(found).iter().map(|l| l.len()).max().unwrap_or(0);
    let id = egui::Id::unique("adaptation_steps");
    let mut shown = ui.data(|d| d.get_temp::<usize>(id)).unwrap_or(all).min(all);
    ui.horizontal_wrapped(|ui| {
        if ui.button(tr("First step")).clicked() {
            shown = 1;
        }
        let next = egui::Button::new(tr("One step on"));
        if ui.add_enabled(shown < all, next).clicked() {
            shown += 1;
        }
        if ui.button(tr("All steps")).clicked() {
            shown = all;
        }
    });
    // Another loop has another number of steps: all of them are then shown.
    ui.data_mut(|d| {
        if shown < all {
            d.insert_temp(id, shown);
        } else {
            d.remove_temp::<usize>(id);
        }
    });
    shown
}

/// Error over the relay runs that it took: the plain law takes one a step, Steffensen's two.
fn convergence_ui(ui: &mut egui::Ui, found: &PhaseMarginReport, shown: usize, height: f32) {
    let curves = [
        ("secant law (8)", theme::DESCRIBING, 1),
        ("Steffensen's step", theme::SIMULATED, 2),
    ];
    let legend = curves.map(|(name, color, _)| (name, color, Shape::Line));
    caption_ui(ui, "Convergence", &legend);
    plot(
        "convergence",
        height - CAPTION,
        "runs of the relay",
        "error of the amplitude, log10",
    )
    .with(|plot| plot.include_y(0.0))
    .show(ui, |plot| {
        for ((name, color, runs), steps) in curves.into_iter().zip(laws(found)) {
            let errors: Vec<[f64; 2]> = steps
                .iter()
                .take(shown)
                .enumerate()
                .map(|(n, step)| {
                    let error = step.error.abs().max(f64::EPSILON);
                    [(runs * n + 1) as f64, error.log10()]
                })
                .collect();
            plot.line(Line::new(tr(name), curve(&errors)).color(color).width(2.0));
            plot.points(
                Points::new(tr(name), curve(&errors))
                    .color(color)
                    .radius(5.0)
                    .shape(MarkerShape::Circle),
            );
        }
    });
}

fn table_ui(ui: &mut egui::Ui, found: &PhaseMarginReport, shown: usize) {
    let heads = [
        "n",
        "K by (8)",
        "error of a",
        "K by Steffensen",
        "error of a",
    ];
    let laws = laws(found);
    table(ui, "adaptation table", &heads, |ui| {
        for n in 0..shown {
            ui.label(tr(n.to_string()));
            for steps in laws {
                let [gain, error] = steps.get(n).map_or_else(Default::default, |step| {
                    [format!("{:.6}", step.gain), format!("{:+.1e}", step.error)]
                });
                ui.label(tr_number(gain));
                ui.label(tr_number(error));
            }
            ui.end_row();
        }
    });
    let order = |a: Option<&Adaptation>| {
        let last = a.and_then(|a| a.orders.last());
        last.map_or_else(|| "-".to_owned(), |o| format!("{o:.2}"))
    };
    ui.small(tr(format!(
        "Order of convergence in the end: {} by (8), 1.62 in theory; {} by Steffensen's step, 2 in theory.",
        order(found.secant.as_ref()),
        order(Some(&found.adaptation))
    )));
    if let Some(truth) = found.true_phase_margin {
        ui.label(tr(format!(
            "The true phase margin with this K is {:.2}°: what is missing to the wanted {:.0}° is the describing function's error.",
            truth.to_degrees(),
            found.adaptation.design.phase_margin.to_degrees()
        )));
    }
}
