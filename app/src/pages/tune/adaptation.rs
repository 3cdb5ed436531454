//! Step 3: the gain for a phase margin, by the relay of equation (7) and the adaptation (8).

use egui_plot::{Line, MarkerShape, Points};
use hysteron_core::counted;
use hysteron_core::message::{Message, fixed};
use hysteron_core::msg;
use hysteron_core::tuning::{AdaptationStep, PhaseMarginReport};
use hysteron_core::uncertain::significant;

use super::draw::{CAPTION, beside, curve, number, plot, table};
use super::stage::{Seen, Stage};
use crate::language::{tr, tr_number};
use crate::theme;
use crate::widgets::chart::{Shape, caption_ui};
use crate::widgets::equation::equation_ui;

pub const STAGE: Stage = Stage {
    id: "adaptation",
    title: "Phase margin",
    question: "Which proportional gain gives the wanted phase margin?",
    answer,
    next: "One test with an asymmetric relay gives a whole model: step 4.",
    plot: errors_ui,
    ui,
};

fn answer(seen: Seen<'_>) -> Message {
    let wanted = seen.input.wish.phase_margin.to_degrees();
    match &seen.report.phase_margin {
        Ok(found) => {
            let gain = number(found.adaptation.gain);
            let wanted = fixed(wanted, 0);
            let changes = found.adaptation.steps.len() - 1;
            let changes = counted!(changes, "1 change of the gain", "{} changes of the gain");
            match found.true_phase_margin {
                Some(margin) => msg!(
                    "K = {} for {}°, after {}; the true margin is {}°.",
                    gain,
                    wanted,
                    changes,
                    fixed(margin.to_degrees(), 1)
                ),
                None => msg!("K = {} for {}°, after {}.", gain, wanted, changes),
            }
        }
        Err(error) => msg!("No gain was found for {}°: {}.", fixed(wanted, 0), error),
    }
}

fn ui(ui: &mut egui::Ui, seen: Seen<'_>, height: f32, _rule: &mut String) {
    let Ok(found) = &seen.report.phase_margin else {
        ui.label(tr("Try a smaller phase margin."));
        return;
    };
    let design = &found.adaptation.design;
    ui.label(tr(msg!(
        "A relay with k = π a/4 = {} and ε = a sin φ = {} is placed in series with the gain K, which is changed from \
         run to run until the amplitude is a = {}. Every step squares the error, at the price of a second run.",
        number(design.gain),
        number(design.hysteresis),
        number(design.amplitude)
    )));
    beside(
        ui,
        height,
        |ui, height| {
            if !seen.pinned {
                convergence_ui(ui, found, height);
            }
        },
        |ui, _| table_ui(ui, found),
    );
}

fn errors_ui(ui: &mut egui::Ui, seen: Seen<'_>, height: f32) {
    if let Ok(found) = &seen.report.phase_margin {
        convergence_ui(ui, found, height);
    }
}

fn convergence_ui(ui: &mut egui::Ui, found: &PhaseMarginReport, height: f32) {
    let errors = |steps: &[AdaptationStep]| -> Vec<[f64; 2]> {
        let sizes = steps.iter().map(|s| s.error.abs().max(f64::EPSILON));
        let sizes = sizes.enumerate().map(|(n, size)| [n as f64, size.log10()]);
        sizes.collect()
    };
    let shown = runs_shown(ui, found);
    let secant = found.secant.as_ref();
    let ways = [
        (
            STEFFENSEN,
            theme::SIMULATED,
            errors(&found.adaptation.steps),
        ),
        (
            SECANT,
            theme::DESCRIBING,
            secant.map_or_else(Vec::new, |s| errors(&s.steps[..shown])),
        ),
    ];
    let keys = ways.each_ref().map(|w| (w.0, w.1, Shape::Circle));
    caption_ui(ui, "", &keys);
    plot(
        "convergence",
        height - CAPTION,
        "step n",
        "error of the amplitude, log10",
    )
    .with(|plot| plot.include_y(0.0))
    .show(ui, |plot| {
        for (name, color, errors) in &ways {
            plot.line(Line::new(tr(*name), curve(errors)).color(*color).width(2.0));
            plot.points(
                Points::new(tr(*name), curve(errors))
                    .color(*color)
                    .radius(5.0)
                    .shape(MarkerShape::Circle),
            );
        }
    });
}

/// Decimals of a gain and of an amplitude on the way to what is looked for: its last steps are small.
const DECIMALS: usize = 5;

const STEFFENSEN: &str = "Steffensen, two runs a step";
const SECANT: &str = "secant (8), one run a step";

/// How many runs of the secant were asked for; it begins with two.
fn runs_shown(ui: &egui::Ui, found: &PhaseMarginReport) -> usize {
    let all = found.secant.as_ref().map_or(0, |s| s.steps.len());
    let asked = ui.data(|d| d.get_temp(egui::Id::unique(SECANT)));
    asked.unwrap_or(2).min(all)
}

/// The plain law, a run at a time, with its numbers.
fn secant_ui(ui: &mut egui::Ui, found: &PhaseMarginReport) {
    ui.add_space(6.0);
    ui.strong(tr("The plain law (8), stepped by hand"));
    let Some(secant) = &found.secant else {
        ui.label(tr("The secant does not get there from this gain."));
        return;
    };
    equation_ui(ui, EQUATION_8, &|_| None);
    let mut shown = runs_shown(ui, found);
    ui.horizontal(|ui| {
        let more = shown < secant.steps.len();
        let next = ui.add_enabled(more, egui::Button::new(tr("Next run")));
        shown += usize::from(next.clicked());
        if ui.button(tr("From the start")).clicked() {
            shown = 2;
        }
        ui.data_mut(|d| d.insert_temp(egui::Id::unique(SECANT), shown));
    });
    let a = |step: &AdaptationStep| step.test.amplitude;
    table(
        ui,
        "secant_table",
        &["n", "K(n)", "a(n)", "error of a"],
        |ui| {
            for (n, step) in secant.steps.iter().take(shown).enumerate() {
                ui.label(n.to_string());
                ui.label(tr_number(format!("{:.DECIMALS$}", step.gain)));
                ui.label(tr_number(format!("{:.DECIMALS$}", a(step))));
                ui.label(tr_number(significant(step.error, 2)));
                ui.end_row();
            }
        },
    );
    if let [.., last, now] = secant.steps.get(..shown).unwrap_or_default()
        && let Some(next) = secant.steps.get(shown)
    {
        ui.label(tr(msg!(
            "Next: K = {} - ({} - {}) · ({} - {})/({} - {}) = {}.",
            fixed(now.gain, DECIMALS),
            fixed(a(now), DECIMALS),
            fixed(found.adaptation.design.amplitude, DECIMALS),
            fixed(now.gain, DECIMALS),
            fixed(last.gain, DECIMALS),
            fixed(a(now), DECIMALS),
            fixed(a(last), DECIMALS),
            fixed(next.gain, DECIMALS)
        )));
    } else {
        ui.label(tr(msg!(
            "It has the wanted amplitude after {}; Steffensen's steps took {}.",
            counted!(secant.steps.len(), "1 run", "{} runs"),
            found
                .adaptation
                .steps
                .iter()
                .map(|s| 1 + usize::from(s.trial.is_some()))
                .sum::<usize>()
        )));
    }
}

const EQUATION_8: &str = "K(n+1) = K(n) - (a(n) - a) (K(n) - K(n-1))/(a(n) - a(n-1))";

fn table_ui(ui: &mut egui::Ui, found: &PhaseMarginReport) {
    let adaptation = &found.adaptation;
    let heads = ["n", "K(n)", "error of a", "period [s]", "order"];
    table(ui, "adaptation table", &heads, |ui| {
        for (n, step) in adaptation.steps.iter().enumerate() {
            ui.label(n.to_string());
            ui.label(tr_number(format!("{:.DECIMALS$}", step.gain)));
            ui.label(tr_number(significant(step.error, 2)));
            ui.label(tr_number(number(step.test.period)));
            // The first order needs three errors.
            let order = n.checked_sub(2).and_then(|i| adaptation.orders.get(i));
            ui.label(tr_number(
                order.map_or_else(String::new, |o| format!("{o:.2}")),
            ));
            ui.end_row();
        }
    });
    ui.small(tr("Order 2: quadratic convergence (Steffensen's secant through a run and its proportional correction)."));
    if let Some(truth) = found.true_phase_margin {
        ui.label(tr(msg!(
            "With this K the true phase margin is {}°; the difference from the wanted {}° is the error of the \
             describing function.",
            fixed(truth.to_degrees(), 2),
            fixed(adaptation.design.phase_margin.to_degrees(), 0)
        )));
    }
    secant_ui(ui, found);
}
