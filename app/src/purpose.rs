//! What an experiment that a page was opened with is for: one line above the page, until it is dismissed.

use crate::language::tr;
use crate::pages::{Command, Desk};

/// An experiment on a page.
#[derive(Clone, Debug, PartialEq)]
pub struct Purpose {
    /// Id of the page that shows it.
    pub page: &'static str,
    /// What it is for.
    pub sentence: String,
    /// Id of the page that it comes from, and what goes there.
    pub from: (&'static str, &'static str),
}

/// Draws the line if the page in front shows the experiment.
pub fn ui(ui: &mut egui::Ui, front: &str, desk: &mut Desk) {
    let Some(purpose) = desk.purpose.as_ref().filter(|p| p.page == front) else {
        return;
    };
    egui::Panel::top("purpose").show(ui, |ui| {
        ui.horizontal_wrapped(|ui| {
            ui.label(tr(&purpose.sentence));
            let (from, name) = purpose.from;
            let back = ui.button(tr(name));
            desk.targets.note("purpose:back", ui, &back);
            if back.clicked() {
                desk.commands.push(Command::Go(from));
            }
            let dismiss = ui.button(tr("Dismiss"));
            desk.targets.note("purpose:dismiss", ui, &dismiss);
            if dismiss.clicked() {
                desk.commands.push(Command::SetPurpose(None));
            }
        });
    });
}
