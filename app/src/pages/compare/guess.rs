//! Guess first: the ranking and what to try next are hidden; the student picks by fingerprints, and hints cost points.

use hysteron_core::diagnosis::{Candidate, StepReport};
use hysteron_core::effect::{EffectId, name_of};
use hysteron_core::msg;

use super::command::Command;
use super::fingerprint::explained;
use super::hints::{LEFT, PRICE};
use super::look::Look;
use super::state::Compare;
use crate::hook::Targets;
use crate::language::tr;

impl Compare {
    /// Whether what helps is still to be guessed.
    pub(super) fn is_guessing(&self) -> bool {
        let open = self.report().is_some_and(|r| r.suggestion.is_some());
        let sealed = self.sealed.as_ref().is_none_or(|s| !s.is_revealed());
        self.guess_first && open && sealed
    }

    /// Buys a hint for the model on screen.
    pub(super) fn buy_hint(&mut self) {
        self.guess.buy(report_effects(self));
    }

    /// Who has the ranking of a mystery shown was given all hints for the model on screen: it says no less.
    pub(super) fn pay_for_ranking(&mut self) {
        let open = self.report().is_some_and(|r| r.suggestion.is_some());
        let sealed = self.sealed.as_ref().is_some_and(|s| !s.is_revealed());
        if open && sealed && !self.guess_first {
            for _ in LEFT {
                self.buy_hint();
            }
        }
    }

    /// What the revealed truth gives, less what hints have cost.
    pub(super) fn points(&self) -> Option<f64> {
        let (_, reveal) = self.sealed.as_ref()?.revealed.as_ref()?;
        Some((reveal.points() - f64::from(self.guess.cost())).max(0.0))
    }

    /// What may be missing, by name: all that was tried, or what hints have left.
    fn choices<'a>(&self, report: &'a StepReport) -> Vec<&'a Candidate> {
        let hints = self.guess.hints(report_effects(self));
        let left = hints.checked_sub(1).map_or(usize::MAX, |i| LEFT[i]);
        let mut choices: Vec<&Candidate> = report.step.candidates.iter().take(left).collect();
        choices.sort_by_key(|c| c.effects.first().map_or("", |id| name_of(*id)));
        choices
    }

    /// Effects with a fingerprint, by name.
    pub(super) fn prints(report: &StepReport) -> Vec<EffectId> {
        let mut prints: Vec<EffectId> = report.fingerprints.iter().map(|f| f.effect).collect();
        prints.sort_by_key(|id| name_of(*id));
        prints
    }

    /// The effects to choose from, without what they would leave.
    pub(super) fn guess_ui(
        &self,
        report: &StepReport,
        ui: &mut egui::Ui,
        targets: &mut Targets,
        commands: &mut Vec<Command>,
    ) {
        ui.strong(tr("Which effect is missing?"));
        ui.label(tr(
            "A fingerprint is the residual that an effect would leave if it were missing. Find the one that matches, \
             and add that effect."));
        for candidate in self.choices(report) {
            let Some(id) = candidate.effects.first().copied() else {
                continue;
            };
            ui.horizontal_wrapped(|ui| {
                let add = egui::Button::new(tr(msg!("Add {}", name_of(id))));
                let add = explained(ui.add_enabled(self.job.is_none(), add), id);
                targets.note(format!("add:{id}"), ui, &add);
                if add.clicked() {
                    commands.push(Command::Add(id));
                }
                if report.fingerprints.iter().any(|f| f.effect == id) {
                    let chosen = self.look == Look::Fingerprint && self.chosen() == Some(id);
                    let show = ui.selectable_label(chosen, tr("Fingerprint"));
                    targets.note(format!("fingerprint:{id}"), ui, &show);
                    if show.clicked() {
                        commands.push(Command::Fingerprint(id));
                    }
                }
            });
        }
        let hints = self.guess.hints(report_effects(self));
        let more = hints < LEFT.len();
        let buy = ui.add_enabled(
            more,
            egui::Button::new(tr(msg!("Give me a hint ({} points)", PRICE))),
        );
        targets.note("guess:hint", ui, &buy);
        if buy.clicked() {
            commands.push(Command::Hint);
        }
    }

    /// Turns guessing on and off.
    pub(super) fn guess_toggle_ui(
        &self,
        ui: &mut egui::Ui,
        targets: &mut Targets,
        commands: &mut Vec<Command>,
    ) {
        let mut first = self.guess_first;
        let hint = if self.sealed.is_some() {
            "Hides which effect helps most until you have found it; in a mystery, to see it costs as much as all hints"
        } else {
            "Hides which effect helps most until you have found it"
        };
        let toggle = ui
            .checkbox(&mut first, tr("Guess first"))
            .on_hover_text(tr(hint));
        targets.note("guess", ui, &toggle);
        if toggle.changed() {
            commands.push(Command::GuessFirst(first));
        }
        let cost = self.guess.cost();
        if cost > 0 {
            ui.label(tr(msg!("Hints have cost {} points so far.", cost)));
        }
    }
}

/// Number of effects of the model on screen.
fn report_effects(page: &Compare) -> usize {
    page.shown.as_ref().map_or(0, Vec::len)
}
