//! Step 5: every rule's controller; a click chooses one.

use hysteron_core::message::Message;
use hysteron_core::msg;
use hysteron_core::tuning::{LoopReport, rule};

use super::draw::{cell, controller, maybe, number, set_table};
use super::loops;
use super::stage::{Seen, Stage};
use crate::language::{tr, tr_number};

/// Room below which the table is set tight, and the width of the names of rules then, points.
const ROOMY: f32 = 880.0;
const NAME: f32 = 145.0;

pub const STAGE: Stage = Stage {
    id: "rules",
    title: "Rule",
    question: "Which controller follows from the experiment?",
    answer,
    next: "Is the loop better with it? Step 6 compares.",
    plot: loops::step_ui,
    ui,
};

fn answer(seen: Seen<'_>) -> Message {
    let name = rule(&seen.input.rule).map_or("This rule", |r| r.name);
    match &seen.report.after {
        Ok(after) => msg!("{}: {}.", name, controller(&after.pid)),
        Err(error) => msg!("{} gives no controller: {}.", name, error),
    }
}

fn ui(ui: &mut egui::Ui, seen: Seen<'_>, _height: f32, chosen: &mut String) {
    ui.label(tr(
        "The same experiment, different wishes: compare robustness (Ms: 1.4 is calm, 2 is lively, beyond that is \
         risky) with how well a load is rejected. Click a rule to take it."));
    let heads = [
        "rule",
        "K",
        "Ti [s]",
        "Td [s]",
        "Ms",
        "phase margin [°]",
        "overshoot [%]",
        "load error [s]",
    ];
    let tight = ui.available_width() < ROOMY;
    let width = tight.then_some(NAME);
    set_table(ui, "rules", &heads, tight, |ui| {
        for report in &seen.report.rules {
            let Ok(rule) = rule(&report.rule) else {
                continue;
            };
            let name = egui::Button::selectable(*chosen == rule.id, tr(rule.name));
            let name =
                cell(ui, width, name).on_hover_text(tr(msg!("{}\n{}", rule.sentence, rule.source)));
            if name.clicked() {
                rule.id.clone_into(chosen);
            }
            match &report.outcome {
                Ok(found) => cells_ui(ui, found),
                Err(error) => {
                    ui.label(tr("none")).on_hover_text(tr(Message::from(error)));
                }
            }
            ui.end_row();
        }
    });
    ui.small(tr(msg!(
        "Ms: maximum sensitivity, 1/Ms is the least distance of the loop's Nyquist curve from -1. Load error: \
         integral of |y| over {} s after a step of 1 at the plant's input.", number(seen.report.horizon))));
    for report in &seen.report.rules {
        if let (Ok(rule), Err(error)) = (rule(&report.rule), &report.outcome) {
            ui.small(format!("{}: {}.", tr(rule.name), tr(Message::from(error))));
        }
    }
}

fn cells_ui(ui: &mut egui::Ui, found: &LoopReport) {
    let pid = &found.pid;
    ui.label(tr_number(number(pid.gain)));
    ui.label(tr(maybe(pid.integral_time, "-")));
    let derivative = (pid.derivative_time > 0.0).then_some(pid.derivative_time);
    ui.label(tr(maybe(derivative, "-")));
    let Some(margins) = found.margins else {
        ui.label(tr("unstable"));
        return;
    };
    ui.label(tr_number(format!("{:.2}", margins.max_sensitivity)));
    let phase = margins.phase_margin.map(f64::to_degrees);
    ui.label(tr_number(
        phase.map_or_else(|| "-".to_owned(), |p| format!("{p:.1}")),
    ));
    ui.label(format!("{:.0}", 100.0 * found.set_point.overshoot));
    ui.label(tr_number(number(found.load.iae)));
}
