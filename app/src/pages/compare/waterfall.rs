//! How the error fell, step by step: back to any of them, and forth again.

use egui::Color32;
use hysteron_core::diagnosis::StepReport;
use hysteron_core::effect::{EffectId, name_of};
use hysteron_core::msg;

use super::answer::times_noise;
use super::command::Command;
use super::state::Compare;
use crate::hook::Targets;
use crate::language::{tr, tr_number};
use crate::motion;
use crate::theme;

/// Width of the widest bar, in points.
pub(super) const BAR_WIDTH: f32 = 150.0;

/// Width of a narrow one, least width of the names beside the bars, and width of the numbers and gaps.
const LEAST_BAR: f32 = 50.0;
const LEAST_LABEL: f32 = 140.0;
const NUMBERS: f32 = 90.0;

/// What the word says, where it first stands.
pub(super) const BASELINE: &str = "The baseline is the plain model to which effects are added: inertia and viscous friction of a drive, gain and time constant of a process.";

/// The error from the baseline to the noise floor. A click on a step goes back to it.
pub(super) fn ui(
    page: &Compare,
    ui: &mut egui::Ui,
    targets: &mut Targets,
    commands: &mut Vec<Command>,
) {
    ui.strong(tr("Error, in units of the noise"));
    let way = page.way();
    let at = page.shown.as_ref().map_or(0, Vec::len);
    // A step that came in a link is known a while later.
    let steps: Vec<(String, Option<&StepReport>)> = (0..=way.len())
        .map(|n| {
            let first = if page.model_file.is_some() {
                "Your model"
            } else {
                "Baseline"
            };
            let label = n
                .checked_sub(1)
                .map_or(tr(first), |i| format!("+ {}", tr(name_of(way[i]))));
            (label, page.reports.get(&way[..n]))
        })
        .collect();
    let known = || steps.iter().filter_map(|(_, r)| *r);
    let largest = known().map(|r| r.step.error).fold(2.0, f64::max);
    let floor = known().next_back().map_or(1.0, |r| r.noise_floor);
    let room = ui.available_width() - NUMBERS;
    // Names are cut only where there is no room for them beside narrow bars.
    let names = steps
        .iter()
        .map(|(label, _)| theme::button_width_of(ui, label));
    let names = names.fold(LEAST_LABEL, f32::max);
    let names = names.min((room - LEAST_BAR).max(LEAST_LABEL));
    let width = (room - names).clamp(LEAST_BAR, BAR_WIDTH);
    egui::Grid::new("waterfall").num_columns(3).show(ui, |ui| {
        for (n, (label, report)) in steps.iter().enumerate() {
            let mut row = ui
                .allocate_ui_with_layout(
                    egui::vec2(names, 22.0),
                    egui::Layout::left_to_right(egui::Align::Center),
                    |ui| {
                        ui.set_width(names);
                        ui.add(egui::Button::selectable(n == at, label.as_str()).truncate())
                    },
                )
                .inner
                .on_hover_text(tr("Show this step"));
            if n == 0 && page.model_file.is_none() {
                row = row.on_hover_text(tr(BASELINE));
            }
            targets.note(format!("step:{n}"), ui, &row);
            if row.clicked() && page.job.is_none() && n != at {
                commands.push(Command::Step(n));
            }
            // What was taken back is still there, but fainter.
            let strength = if n > at { 0.4 } else { 1.0 };
            if let Some(report) = report {
                ui.label(tr_number(times_noise(report.step.error)));
                let color = theme::MODEL.gamma_multiply(strength);
                bar_ui(ui, report.step.error, floor, largest, color, width);
            } else if page.earlier.is_some() {
                motion::busy_ui(ui);
            }
            ui.end_row();
        }
        if let Some((error, exact)) = page.hand_error() {
            ui.label(format!("   {}", tr("By hand")));
            let times = times_noise(error);
            ui.label(tr(if exact {
                times.into()
            } else {
                msg!("≈ {}", times)
            }));
            bar_ui(ui, error, floor, largest, theme::BEFORE, width);
            ui.end_row();
        }
        ui.label(tr("   Noise floor"));
        ui.label(tr_number(times_noise(floor)));
        bar_ui(ui, floor, floor, largest, theme::NOISE, width);
        ui.end_row();
    });
    ui.small(tr("Bars on a logarithmic scale. Click a step to see it."));
    if page.job.is_none() {
        back_and_forth_ui(page, &way, ui, targets, commands);
    }
}

/// Takes the last effect back, or puts the next one back.
fn back_and_forth_ui(
    page: &Compare,
    way: &[EffectId],
    ui: &mut egui::Ui,
    targets: &mut Targets,
    commands: &mut Vec<Command>,
) {
    ui.horizontal_wrapped(|ui| {
        if let Some(last) = page.effects.last() {
            let undo = ui.button(tr(msg!("Take back {}", name_of(*last))));
            targets.note("undo", ui, &undo);
            if undo.clicked() {
                commands.push(Command::Undo);
            }
        }
        if let Some(next) = way.get(page.effects.len()) {
            let redo = ui.button(tr(msg!("Put {} back", name_of(*next))));
            targets.note("redo", ui, &redo);
            if redo.clicked() {
                commands.push(Command::Redo);
            }
        }
    });
}

pub(super) fn bar_ui(
    ui: &mut egui::Ui,
    error: f64,
    floor: f64,
    largest: f64,
    color: Color32,
    width: f32,
) {
    let share = ((error / floor).max(1.0).ln() / (largest / floor).ln()).clamp(0.0, 1.0) as f32;
    let (rect, _) = ui.allocate_exact_size(egui::vec2(width, 12.0), egui::Sense::hover());
    let mut bar = rect;
    bar.set_width(3.0 + share * (width - 3.0));
    ui.painter().rect_filled(bar, 2.0, color);
}
