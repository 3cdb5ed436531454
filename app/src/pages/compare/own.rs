//! The user's own effect as a formula.

use hysteron_core::measurement::Kind;
use hysteron_core::message::Message;
use hysteron_core::msg;

use super::command::Command;
use super::formula::Typed;
use super::state::Compare;
use crate::hook::Targets;
use crate::language::tr;
use crate::theme;

pub(super) fn ui(
    page: &Compare,
    ui: &mut egui::Ui,
    targets: &mut Targets,
    commands: &mut Vec<Command>,
) {
    let Some(measurement) = &page.measurement else {
        return;
    };
    let kind = measurement.kind;
    let before = page.typed.clone().filter(|t| t.kind == kind);
    let before = before.unwrap_or_else(|| Typed::example(kind));
    let mut typed = before.clone();
    egui::CollapsingHeader::new(tr("An effect of your own")).show(ui, |ui| {
        let (variables, symbol) = match kind {
            Kind::Drive => (
                "A force as a formula in position x, velocity v, input u and time t; every other name is fitted.",
                "F =",
            ),
            Kind::Process => (
                "An input as a formula in output y, input u and time t; every other name is fitted.",
                "Input =",
            ),
        };
        ui.label(tr(variables));
        egui::Grid::new("own effect").num_columns(2).show(ui, |ui| {
            let label = ui.label(tr("Name"));
            ui.add(theme::line(&mut typed.name).desired_width(120.0))
                .labelled_by(label.id);
            ui.end_row();
            let label = ui.label(tr(symbol));
            ui.add(
                theme::line(&mut typed.formula)
                    .desired_width(240.0)
                    .font(egui::TextStyle::Monospace),
            )
            .labelled_by(label.id);
            ui.end_row();
        });
        let checked = typed.check();
        let id = typed.id();
        if checked.is_ok() && id != typed.name {
            ui.label(tr(msg!("In the model it is called {}.", id)));
        }
        match &checked {
            Ok(names) => ui.label(tr(msg!("To be fitted: {}", Message::name(names.join(", "))))),
            Err(error) => ui.colored_label(ui.visuals().warn_fg_color, tr(error)),
        };
        let ready = checked.is_ok() && page.job.is_none() && page.report().is_some();
        let add = ui.add_enabled(ready, egui::Button::new(tr("Add your effect")));
        targets.note("own:add", ui, &add);
        if add.clicked() {
            commands.push(Command::AddOwn(typed.clone()));
        }
    });
    if typed != before {
        commands.push(Command::Type(typed));
    }
}
