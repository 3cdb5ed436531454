//! One line above a page that says what its experiment is for, until it is dismissed.

use crate::command::Command;
use crate::desk::Desk;
use crate::language::tr;

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
