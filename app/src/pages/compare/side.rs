//! The side of the page: how the error fell, and what could be added.

use egui::{Color32, RichText};
use hysteron_core::criticism::{Candidate, StepReport, with_error};
use hysteron_core::effect;

use super::{Command, Compare, missing, name_of, own, times_noise};
use crate::hook::Targets;
use crate::theme;

/// Width of the widest bar, in points.
const BAR_WIDTH: f32 = 150.0;

/// Width of a narrow one, of the names beside the bars, and of these with the numbers and gaps.
const LEAST_BAR: f32 = 50.0;
const WATERFALL_LABEL: f32 = 140.0;
const WATERFALL_TEXT: f32 = 230.0;

pub(super) fn ui(
    page: &Compare,
    ui: &mut egui::Ui,
    targets: &mut Targets,
    commands: &mut Vec<Command>,
) {
    file_ui(page, ui, targets, commands);
    progress_ui(page, ui, commands);
    let Some(report) = page.report() else {
        return;
    };
    ui.separator();
    waterfall_ui(page, ui, targets, commands);
    ui.separator();
    if let Some(verdict) = &report.verdict {
        egui::Frame::group(ui.style()).show(ui, |ui| {
            ui.strong("The data say");
            ui.label(&verdict.text);
            if let Some(next) = &verdict.next_experiment {
                ui.label(next);
            }
        });
    }
    missing::ui(report, ui);
    candidates_ui(page, report, ui, targets, commands);
    own::ui(page, ui, targets, commands);
    ui.collapsing("Parameters of the model", |ui| parameters_ui(report, ui));
}

fn file_ui(page: &Compare, ui: &mut egui::Ui, targets: &mut Targets, commands: &mut Vec<Command>) {
    ui.horizontal_wrapped(|ui| {
        if let Some(m) = &page.measurement {
            ui.strong(&m.name);
            ui.label(format!("{} samples", m.len()));
        }
        if ui.button("Open another").clicked() {
            commands.push(Command::Close);
        }
        let export = ui
            .add_enabled(page.report().is_some(), egui::Button::new("Export report"))
            .on_hover_text("One page with pictures, equations, parameters and the verdict");
        targets.note("export:report", ui, &export);
        if export.clicked() {
            commands.push(Command::ExportReport);
        }
    });
    ui.horizontal_wrapped(|ui| {
        let load = ui.button("Load model ...").on_hover_text(
            "What is known beforehand: parameters, effects already in the model (TOML)",
        );
        targets.note("model:load", ui, &load);
        if load.clicked() {
            commands.push(Command::OpenModel);
        }
        let save = ui.add_enabled(page.report().is_some(), egui::Button::new("Save model"));
        targets.note("model:save", ui, &save);
        if save.clicked() {
            commands.push(Command::SaveModel);
        }
        if let Some(name) = &page.model_file {
            ui.label(format!("Begins with {name}"));
            if ui.small_button("Forget it").clicked() {
                commands.push(Command::DropModel);
            }
        }
    });
}

fn progress_ui(page: &Compare, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    if page.job.is_some() {
        ui.horizontal(|ui| {
            let bar = egui::ProgressBar::new(page.progress.0 as f32).desired_width(230.0);
            ui.add(bar.text(page.progress.1.clone()));
            if ui.button("Cancel").clicked() {
                commands.push(Command::Cancel);
            }
        });
    }
}

/// The error from the baseline to the noise floor.
fn waterfall_ui(
    page: &Compare,
    ui: &mut egui::Ui,
    targets: &mut Targets,
    commands: &mut Vec<Command>,
) {
    ui.strong("Error, in units of the noise");
    let shown = page.shown.as_deref().unwrap_or_default();
    let steps: Vec<(String, &StepReport)> = (0..=shown.len())
        .filter_map(|n| {
            let report = page.reports.get(&shown[..n])?;
            let first = if page.model_file.is_some() {
                "Your model"
            } else {
                "Baseline"
            };
            let label = n
                .checked_sub(1)
                .map_or(first.to_owned(), |i| format!("+ {}", name_of(shown[i])));
            Some((label, report))
        })
        .collect();
    let largest = steps.iter().map(|(_, r)| r.step.error).fold(2.0, f64::max);
    let floor = steps.first().map_or(1.0, |(_, r)| r.noise_floor);
    let width = (ui.available_width() - WATERFALL_TEXT).clamp(LEAST_BAR, BAR_WIDTH);
    egui::Grid::new("waterfall").num_columns(3).show(ui, |ui| {
        let mut row = |label: &str, error: f64, color: Color32| {
            ui.allocate_ui(egui::vec2(WATERFALL_LABEL, 18.0), |ui| {
                ui.set_width(WATERFALL_LABEL);
                ui.add(egui::Label::new(label).truncate());
            });
            ui.label(times_noise(error));
            bar_ui(ui, error, floor, largest, color, width);
            ui.end_row();
        };
        for (label, report) in &steps {
            row(label, report.step.error, theme::MODEL);
        }
        row("Noise floor", floor, theme::NOISE);
    });
    ui.small("Bars on a logarithmic scale.");
    if !page.effects.is_empty() && page.job.is_none() {
        let undo = ui.button(format!(
            "Take back {}",
            page.effects.last().map_or("", |e| name_of(*e))
        ));
        targets.note("undo", ui, &undo);
        if undo.clicked() {
            commands.push(Command::Undo);
        }
    }
}

fn bar_ui(ui: &mut egui::Ui, error: f64, floor: f64, largest: f64, color: Color32, width: f32) {
    let share = ((error / floor).max(1.0).ln() / (largest / floor).ln()).clamp(0.0, 1.0) as f32;
    let (rect, _) = ui.allocate_exact_size(egui::vec2(width, 12.0), egui::Sense::hover());
    let mut bar = rect;
    bar.set_width(3.0 + share * (width - 3.0));
    ui.painter().rect_filled(bar, 2.0, color);
}

fn candidates_ui(
    page: &Compare,
    report: &StepReport,
    ui: &mut egui::Ui,
    targets: &mut Targets,
    commands: &mut Vec<Command>,
) {
    let (helping, others): (Vec<&Candidate>, Vec<&Candidate>) =
        report.step.candidates.iter().partition(|c| c.significant);
    if helping.is_empty() {
        ui.label("No effect in the library would lower the error beyond chance.");
    } else {
        ui.strong("What could be missing");
    }
    for candidate in helping {
        card_ui(page, report, candidate, ui, targets, commands);
    }
    if !others.is_empty() {
        ui.collapsing("Effects that do not help", |ui| {
            for candidate in others {
                card_ui(page, report, candidate, ui, targets, commands);
            }
        });
    }
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
    let formula = page.model.as_ref().and_then(|m| m.formula(id));
    let (sentence, equation, source) = match (effect::find(id), formula) {
        (Some(e), _) => (e.sentence(), e.equation().to_owned(), e.source()),
        (None, Some(f)) => (
            "An effect of your own.",
            format!("F = {f}"),
            "your own formula",
        ),
        (None, None) => return,
    };
    egui::Frame::group(ui.style()).show(ui, |ui| {
        ui.set_width(ui.available_width());
        ui.horizontal(|ui| {
            let add = ui.add_enabled(
                page.job.is_none(),
                egui::Button::new(format!("Add {}", name_of(id))),
            );
            targets.note(format!("add:{id}"), ui, &add);
            if add.clicked() {
                commands.push(Command::Add(id));
            }
            ui.label(RichText::new(format!("leaves {}", times_noise(candidate.error))).strong());
        });
        bar_ui(
            ui,
            candidate.error,
            report.noise_floor,
            report.step.error.max(2.0),
            theme::MODEL,
            ui.available_width().min(BAR_WIDTH),
        );
        ui.label(sentence);
        if !candidate.equivalent_to.is_empty() {
            let names: Vec<&str> = candidate
                .equivalent_to
                .iter()
                .map(|e| name_of(*e))
                .collect();
            ui.colored_label(
                ui.visuals().warn_fg_color,
                format!("These data cannot tell it from {}.", names.join(" or ")),
            );
        }
        egui::CollapsingHeader::new("Equation")
            .id_salt(id.as_str())
            .show(ui, |ui| {
                ui.monospace(&equation);
                ui.small(source);
                for p in &candidate.parameters {
                    ui.label(format!(
                        "{} ({}) = {}",
                        p.name,
                        p.label,
                        with_error(p.value, p.std_error, &p.unit)
                    ));
                }
            });
    });
}

fn parameters_ui(report: &StepReport, ui: &mut egui::Ui) {
    egui::Grid::new("parameters")
        .num_columns(3)
        .striped(true)
        .show(ui, |ui| {
            for p in &report.step.parameters {
                ui.label(&p.name).on_hover_text(&p.label);
                ui.label(with_error(p.value, p.std_error, &p.unit));
                ui.label(p.effect.map_or("baseline", name_of));
                ui.end_row();
            }
        });
}
