//! The page's answer, where the model fails, and messages, in words.

use hysteron_core::diagnosis::StepReport;
use hysteron_core::effect::{self, EffectId, name_of};
use hysteron_core::uncertain::with_error;
use hysteron_core::user_model::UserModel;

use super::command::Command;
use super::state::Compare;
use crate::language::tr;
use crate::theme;

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

    /// Which file is being read.
    pub(super) fn reading_ui(&self, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
        if let Some(opening) = &self.opening {
            ui.horizontal_wrapped(|ui| {
                ui.label(tr(format!("Reading {} ...", opening.file)));
                if ui.small_button(tr("Cancel")).clicked() {
                    commands.push(Command::CancelReading);
                }
            });
        }
    }

    pub(super) fn answer_ui(&self, ui: &mut egui::Ui) {
        let text = match self.report() {
            None => "Comparing the measurement with a model ...".to_owned(),
            Some(report) => {
                let present = self.model.as_ref().map(UserModel::present);
                answer(report, &present.unwrap_or_default(), self.is_noise(report))
            }
        };
        theme::answer_ui(ui, &text);
        for noise in self.report().iter().flat_map(|report| &report.noise) {
            ui.weak(tr(noise.words()));
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

/// A share in per cent, two digits.
fn share(share: f64) -> String {
    let percent = 100.0 * share;
    match percent {
        10.0.. => format!("{percent:.0}"),
        1.0.. => format!("{percent:.1}"),
        _ => format!("{percent:.2}"),
    }
}

/// An error in noise units, three digits.
pub(super) fn times_noise(error: f64) -> String {
    if error >= 100.0 {
        format!("{error:.0}")
    } else if error >= 10.0 {
        format!("{error:.1}")
    } else {
        format!("{error:.2}")
    }
}

/// Whether a verdict, if there is one, counts an effect of the model among what is missing, and not to the record.
fn of_machine(report: &StepReport, effect: EffectId) -> bool {
    let verdict = report.verdict.as_ref();
    verdict.is_none_or(|v| v.missing.iter().flatten().any(|m| *m == effect))
}

/// The page's answer in one or two sentences; `present` are the effects of the user's model, `noise`: nothing is missing
/// without what is needless.
fn answer(report: &StepReport, present: &[EffectId], noise: bool) -> String {
    let step = &report.step;
    let added: Vec<String> = step
        .effects
        .iter()
        .filter(|e| **e != effect::VISCOUS_FRICTION && !present.contains(e))
        .filter(|e| !effect::is_of_record(**e))
        .filter(|e| of_machine(report, **e))
        .map(|id| {
            let main = step.parameters.iter().find(|p| p.effect == Some(*id));
            main.map_or_else(
                || name_of(*id).to_owned(),
                |p| {
                    format!(
                        "{}: {}",
                        name_of(*id),
                        with_error(p.value, p.std_error, &p.unit)
                    )
                },
            )
        })
        .collect();
    match (&report.verdict, added.is_empty()) {
        (Some(verdict), _) if !verdict.contradicted.is_empty() => {
            let names: Vec<&str> = verdict
                .contradicted
                .iter()
                .map(|c| c.name.as_str())
                .collect();
            format!("The data contradict the known {}.", names.join(" and "))
        }
        (Some(verdict), false) if verdict.complete => {
            if verdict.missing.iter().all(|class| class.len() < 2) {
                let were = if added.len() > 1 {
                    "effects were"
                } else {
                    "effect was"
                };
                let added = added.join(" and ");
                return format!("The missing {were} {added}. Nothing more is missing.");
            }
            let classes: Vec<String> = verdict
                .missing
                .iter()
                .map(|class| {
                    let names: Vec<&str> = class.iter().map(|id| name_of(*id)).collect();
                    names.join(" or ")
                })
                .collect();
            let are = if classes.len() > 1 {
                "effects are"
            } else {
                "effect is"
            };
            let classes = classes.join(", and ");
            format!("The missing {are} {classes}: this record cannot tell which.")
        }
        (Some(verdict), true) if verdict.complete => {
            "Nothing is missing: what the model leaves is measurement noise.".to_owned()
        }
        _ => {
            let error = times_noise(step.error);
            match report.needless.first() {
                Some(idle) if noise => format!(
                    "The model leaves only noise, with {} or without.",
                    name_of(*idle)
                ),
                Some(idle) if report.suggestion.is_none() => format!(
                    "The model misses by {error} times the noise, with {} or without.",
                    name_of(*idle)
                ),
                _ if step.left > 0.0 => {
                    let missed = share(step.left);
                    format!("The model misses {missed} % of the motion, {error} times the noise.")
                }
                _ => format!("The model misses by {error} times the noise."),
            }
        }
    }
}
