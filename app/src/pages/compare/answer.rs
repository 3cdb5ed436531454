//! The page's answer, where the model fails, and messages, in words.

use hysteron_core::diagnosis::{DiscoveryEnd, StepReport};
use hysteron_core::effect::EffectId;
use hysteron_core::measurement::Kind;
use hysteron_core::message::Message;
use hysteron_core::msg;
use hysteron_core::uncertain::brief;
use hysteron_core::user_model::UserModel;

use super::command::Command;
use super::state::Compare;
use crate::hook::Targets;
use crate::language::tr;
use crate::theme;
use crate::widgets::equation::sized_equation_ui;

/// What is said before a formula that explains what no effect does.
const A_FORMULA_DOES: &str = "No effect in the library explains the rest, but a formula does:";

impl Compare {
    pub(super) fn message_ui(&self, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
        self.reading_ui(ui, commands);
        if let Some(message) = &self.message {
            ui.horizontal_wrapped(|ui| {
                theme::tell(&ui.colored_label(ui.visuals().warn_fg_color, tr(message)));
                if ui.small_button(tr("Dismiss")).clicked() {
                    commands.push(Command::Dismiss);
                }
            });
        }
    }

    /// The form for the columns of a file, in place of what is open.
    pub(super) fn form_ui(
        &self,
        ui: &mut egui::Ui,
        targets: &mut Targets,
        commands: &mut Vec<Command>,
    ) {
        if let Some(form) = &self.form {
            theme::scroll("compare_mapping").show(ui, |ui| {
                commands.extend(form.ui(ui, targets).into_iter().map(Command::Map));
                self.reading_ui(ui, commands);
            });
        }
    }

    /// Which file is being read.
    pub(super) fn reading_ui(&self, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
        if let Some(opening) = &self.opening {
            ui.horizontal_wrapped(|ui| {
                ui.label(tr(msg!("Reading {} ...", Message::name(&opening.file))));
                if ui.small_button(tr("Cancel")).clicked() {
                    commands.push(Command::CancelReading);
                }
            });
        }
    }

    pub(super) fn answer_ui(&self, ui: &mut egui::Ui) {
        let text = match self.report() {
            None => "Comparing the measurement with a model ...".into(),
            // What is on the screen is not the fit.
            Some(report) if self.hand_error().is_some() => {
                let (error, exact) = self.hand_error().unwrap_or_default();
                let [error, fitted] = [error, report.step.error].map(times_noise);
                if exact {
                    msg!(
                        "By hand the error is {} × the noise; the fit leaves {}.",
                        error,
                        fitted
                    )
                } else {
                    msg!(
                        "By hand the error is about {} × the noise; the fit leaves {}.",
                        error,
                        fitted
                    )
                }
            }
            Some(report) => self.explained().unwrap_or_else(|| {
                let present = self.model.as_ref().map(UserModel::present);
                let verdict = report.verdict.as_ref();
                report.answer(verdict, &present.unwrap_or_default(), self.is_noise(report))
            }),
        };
        // A formula that is found stands as it does in a book.
        let formula = self.explaining_formula();
        let formula = formula.filter(|_| text == A_FORMULA_DOES);
        let before = self.report().is_some() && self.job.is_some();
        if before && self.shown.as_ref() != Some(&self.effects) {
            theme::answer_of_before_ui(ui, &text);
        } else {
            theme::answer_ui(ui, &text);
        }
        if let Some(formula) = formula {
            sized_equation_ui(ui, &formula, theme::answer_size(ui.ctx()), &|_| None);
        }
    }

    /// What is noise in the record.
    pub(super) fn noise_ui(&self, ui: &mut egui::Ui) {
        for noise in self.report().iter().flat_map(|report| &report.noise) {
            ui.weak(tr(noise.words()));
        }
    }

    /// What explains the rest where no effect does.
    fn explained(&self) -> Option<Message> {
        self.explaining_formula().map(|_| A_FORMULA_DOES.into())
    }

    /// The formula that does.
    fn explaining_formula(&self) -> Option<String> {
        let discovery = self.discovery().filter(|_| self.is_unknown())?;
        let whole = discovery.end == DiscoveryEnd::Explained;
        let formula = &discovery.found().filter(|_| whole)?.formula;
        Some(format!("{} = {formula}", self.force_symbol()))
    }

    /// What a formula gives.
    pub(super) fn force_symbol(&self) -> &'static str {
        match self.measurement.as_ref().map(|m| m.kind) {
            Some(Kind::Process) => "Input",
            _ => "F",
        }
    }

    /// Whether nothing was missing before something needless was added.
    fn is_noise(&self, report: &StepReport) -> bool {
        let Some((idle, shown)) = report.needless.first().zip(self.shown.as_deref()) else {
            return false;
        };
        let without: Vec<EffectId> = shown.iter().filter(|e| *e != idle).copied().collect();
        let before = self.reports.get(&without).and_then(|r| r.verdict.as_ref());
        report.suggestion.is_none() && before.is_some_and(|v| v.complete)
    }

    pub(super) fn findings_ui(&self, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
        let Some(report) = self.report() else {
            return;
        };
        for (index, finding) in report.step.findings.iter().enumerate().take(3) {
            let row = ui.selectable_label(self.finding == index, tr(&finding.text));
            if row
                .on_hover_text(tr("Click to shade it in the plots"))
                .clicked()
            {
                commands.push(Command::Shade(index));
            }
        }
    }
}

/// An error in noise units, three digits.
pub(super) fn times_noise(error: f64) -> String {
    brief(error)
}
