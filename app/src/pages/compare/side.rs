//! The side of the page: the file, what the data say, and what could be added.

use egui::RichText;
use hysteron_core::diagnosis::{Candidate, StepReport};
use hysteron_core::effect;
use hysteron_core::effect::{EffectId, name_of};
use hysteron_core::measurement::Kind;
use hysteron_core::message::Message;
use hysteron_core::msg;
use hysteron_core::uncertain::with_error;

use super::answer::times_noise;
use super::command::Command;
use super::look::Look;
use super::parts::Part;
use super::state::Compare;
use super::waterfall::{BAR_WIDTH, bar_ui};
use super::{experiment, missing, own, parameters, waterfall};
use crate::hook::Targets;
use crate::language::tr;
use crate::theme;
use crate::widgets::equation::equation_ui;

pub(super) fn ui(
    page: &Compare,
    ui: &mut egui::Ui,
    targets: &mut Targets,
    commands: &mut Vec<Command>,
) {
    file_ui(page, ui, targets, commands);
    progress_ui(page, ui, commands);
    findings_ui(page, ui, targets, commands);
}

/// What was found, and what could be added.
pub(super) fn findings_ui(
    page: &Compare,
    ui: &mut egui::Ui,
    targets: &mut Targets,
    commands: &mut Vec<Command>,
) {
    let Some(report) = page.report() else {
        return;
    };
    ui.separator();
    waterfall::ui(page, ui, targets, commands);
    ui.separator();
    if let Some(report) = page.report_in(Part::Parameters) {
        parameters::ui(page, report, ui, targets, commands);
    }
    if let Some(verdict) = &report.verdict {
        egui::Frame::group(ui.style()).show(ui, |ui| {
            ui.set_width(ui.available_width());
            ui.strong(tr("The data say"));
            ui.label(tr(&verdict.text));
            if verdict.experiments.is_empty()
                && let Some(next) = &verdict.next_experiment
            {
                ui.label(tr(next));
            }
        });
        for (index, proposal) in verdict.experiments.iter().enumerate() {
            experiment::ui(page, index, proposal, ui, targets, commands);
        }
    }
    let Some(report) = page.report_in(Part::List) else {
        return;
    };
    missing::ui(report, ui);
    candidates_ui(page, report, ui, targets, commands);
    own::ui(page, ui, targets, commands);
}

pub(super) fn file_ui(
    page: &Compare,
    ui: &mut egui::Ui,
    targets: &mut Targets,
    commands: &mut Vec<Command>,
) {
    ui.horizontal_wrapped(|ui| {
        if let Some(m) = &page.measurement {
            ui.strong(&m.name);
            ui.label(tr(msg!("{} samples", m.len())));
        }
        if ui.button(tr("Open another")).clicked() {
            commands.push(Command::Close);
        }
    });
    if let Some(sealed) = &page.sealed {
        let (state, name) = if sealed.is_revealed() {
            ("A mystery: its truth is revealed.", "Truth and points")
        } else {
            ("A mystery: its truth is sealed in it.", "Reveal ...")
        };
        ui.horizontal_wrapped(|ui| {
            ui.label(tr(state));
            let reveal = ui.button(tr(name));
            targets.note("reveal:go", ui, &reveal);
            if reveal.clicked() {
                commands.push(Command::Look(Look::Reveal));
            }
        });
    }
    ui.horizontal_wrapped(|ui| {
        let load = ui.button(tr("Load model ...")).on_hover_text(tr(
            "What is known beforehand: parameters, effects already in the model (TOML)",
        ));
        targets.note("model:load", ui, &load);
        if load.clicked() {
            commands.push(Command::OpenModel);
        }
        let save = ui.add_enabled(page.report().is_some(), egui::Button::new(tr("Save model")));
        targets.note("model:save", ui, &save);
        if save.clicked() {
            commands.push(Command::SaveModel);
        }
        let export = ui
            .add_enabled(
                page.report().is_some(),
                egui::Button::new(tr("Export report")),
            )
            .on_hover_text(tr(
                "One page with pictures, equations, parameters and the verdict",
            ));
        targets.note("export:report", ui, &export);
        if export.clicked() {
            commands.push(Command::ExportReport);
        }
        if let Some(name) = &page.model_file {
            ui.label(tr(msg!("Begins with {}", name)));
            if ui.small_button(tr("Discard it")).clicked() {
                commands.push(Command::DropModel);
            }
        }
    });
}

pub(super) fn progress_ui(page: &Compare, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    if page.job.is_some() {
        ui.horizontal(|ui| {
            // What it is doing is a sentence.
            let width = ui.available_width() - theme::button_width(ui, "Cancel");
            let bar = egui::ProgressBar::new(page.progress.0 as f32).desired_width(width);
            ui.add(bar.text(tr(page.progress.1.clone())));
            if ui.button(tr("Cancel")).clicked() {
                commands.push(Command::Cancel);
            }
        });
    }
}

fn candidates_ui(
    page: &Compare,
    report: &StepReport,
    ui: &mut egui::Ui,
    targets: &mut Targets,
    commands: &mut Vec<Command>,
) {
    page.guess_toggle_ui(ui, targets, commands);
    if page.is_guessing() {
        page.guess_ui(report, ui, targets, commands);
        return;
    }
    let (helping, others): (Vec<&Candidate>, Vec<&Candidate>) =
        report.step.candidates.iter().partition(|c| c.significant);
    let (perhaps, others): (Vec<&Candidate>, Vec<&Candidate>) =
        others.into_iter().partition(|c| c.promising);
    if helping.is_empty() {
        ui.label(tr(
            "No effect in the library would lower the error by more than chance.",
        ));
    } else {
        ui.strong(tr("What could be missing"));
    }
    for candidate in helping {
        card_ui(page, report, candidate, ui, targets, commands);
    }
    if !perhaps.is_empty() {
        ui.strong(tr("Perhaps, but it may be chance"));
    }
    for candidate in perhaps {
        card_ui(page, report, candidate, ui, targets, commands);
    }
    if !others.is_empty() {
        ui.collapsing(tr("Effects that do not help"), |ui| {
            for candidate in others {
                card_ui(page, report, candidate, ui, targets, commands);
            }
        });
    }
}

/// What an effect is: a sentence, its equation, and where that is from.
fn described(page: &Compare, id: EffectId) -> Option<(&'static str, Message, &'static str)> {
    if let Some(e) = effect::find(id) {
        return Some((e.sentence(), e.equation().into(), e.source()));
    }
    let formula = page.model.as_ref()?.formula(id)?;
    let equation = match page.measurement.as_ref().map(|m| m.kind) {
        Some(Kind::Process) => msg!("Input = {}", Message::name(formula)),
        _ => Message::name(format!("F = {formula}")),
    };
    Some(("An effect of your own.", equation, "your own formula"))
}

fn card_ui(
    page: &Compare,
    report: &StepReport,
    candidate: &Candidate,
    ui: &mut egui::Ui,
    targets: &mut Targets,
    commands: &mut Vec<Command>,
) {
    let Some(id) = candidate.effects.first().copied() else {
        return;
    };
    let Some((sentence, equation, source)) = described(page, id) else {
        return;
    };
    egui::Frame::group(ui.style()).show(ui, |ui| {
        ui.set_width(ui.available_width());
        ui.horizontal_wrapped(|ui| {
            choice_ui(page, report, (id, candidate.error), ui, targets, commands);
        });
        bar_ui(
            ui,
            candidate.error,
            report.noise_floor,
            report.step.error.max(2.0),
            theme::MODEL,
            ui.available_width().min(BAR_WIDTH),
        );
        ui.label(tr(sentence));
        if !candidate.equivalent_to.is_empty() {
            let names = candidate.equivalent_to.iter().map(|e| name_of(*e));
            ui.colored_label(
                ui.visuals().warn_fg_color,
                tr(msg!(
                    "These data cannot tell it apart from {}.",
                    Message::list(" or ", names)
                )),
            );
        }
        egui::CollapsingHeader::new(tr("Equation"))
            .id_salt(id.as_str())
            .show(ui, |ui| {
                equation_ui(ui, &tr(equation), &|_| None);
                ui.small(tr(source));
                for p in &candidate.parameters {
                    ui.horizontal_wrapped(|ui| {
                        equation_ui(ui, &p.name, &|_| None);
                        let value = with_error(p.value, p.std_error, &p.unit);
                        ui.label(tr(msg!(
                            "({}) = {}",
                            Message::words(p.label.clone()),
                            value
                        )));
                    });
                }
            });
    });
}

/// Adds an effect that would leave this error, or shows its fingerprint.
fn choice_ui(
    page: &Compare,
    report: &StepReport,
    (id, error): (EffectId, f64),
    ui: &mut egui::Ui,
    targets: &mut Targets,
    commands: &mut Vec<Command>,
) {
    let add = ui.add_enabled(
        page.job.is_none(),
        egui::Button::new(tr(msg!("Add {}", name_of(id)))),
    );
    targets.note(format!("add:{id}"), ui, &add);
    if add.clicked() {
        commands.push(Command::Add(id));
    }
    ui.label(RichText::new(tr(msg!("leaves {} × noise", times_noise(error)))).strong());
    if report.fingerprints.iter().any(|f| f.effect == id) {
        let chosen = page.look == Look::Fingerprint && page.chosen() == Some(id);
        let show = ui
            .selectable_label(chosen, tr("Fingerprint"))
            .on_hover_text(tr(
                "The residual that it would leave if it were missing, beside the present one",
            ));
        targets.note(format!("fingerprint:{id}"), ui, &show);
        if show.clicked() {
            commands.push(Command::Fingerprint(id));
        }
    }
}
