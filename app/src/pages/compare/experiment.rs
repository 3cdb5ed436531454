//! What these data cannot tell apart, and the experiment that can.

use hysteron_core::diagnosis::{FittedModel, Limits, NextExperiment, Program, Trial};
use hysteron_core::effect::name_of;
use hysteron_core::measurement::Kind;
use hysteron_core::message::Message;
use hysteron_core::msg;
use hysteron_core::opening::Opening;
use hysteron_core::uncertain::in_unit;

use super::command::Command;
use super::state::Compare;
use crate::command;
use crate::hook::Targets;
use crate::language::tr;
use crate::purpose::Purpose;
use crate::theme;
use crate::widgets::typed::Typed;

/// Width of the widest bar, points.
const BAR: f32 = 90.0;

/// The card of one class.
pub(super) fn ui(
    page: &Compare,
    index: usize,
    proposal: &NextExperiment,
    ui: &mut egui::Ui,
    targets: &mut Targets,
    commands: &mut Vec<Command>,
) {
    let names: Vec<&'static str> = proposal.class.iter().map(|id| name_of(*id)).collect();
    egui::Frame::group(ui.style()).show(ui, |ui| {
        ui.set_width(ui.available_width());
        let title = match names.len() {
            2 => "These two cannot be told apart with this record",
            _ => "These cannot be told apart with this record",
        };
        ui.strong(tr(title));
        ui.label(tr(Message::list(" or ", names)));
        if proposal.sufficient {
            ui.add_space(4.0);
            ui.strong(tr("Try this experiment"));
        }
        ui.label(tr(&proposal.text));
        opening_ui(page, index, proposal, ui, targets, commands);
        trials_ui(index, proposal, ui);
        limits_ui(page, index, proposal, ui, targets, commands);
    });
}

/// What shows the experiment with the first model at its largest gain.
pub(super) fn preview(page: &Compare, proposal: &NextExperiment) -> Option<Vec<command::Command>> {
    let Program::Relay { gains, .. } = &proposal.program else {
        return None;
    };
    let (model, gain) = (proposal.models.first()?, gains.last()?);
    let opening = proposal.opening(model, *gain);
    let opening = opening.filter(|_| proposal.sufficient)?;
    Some(opened(opening, purpose(page, proposal, model)).1)
}

/// What the experiment is for, with one of the models.
fn purpose(page: &Compare, proposal: &NextExperiment, model: &FittedModel) -> Message {
    let names: Vec<&'static str> = proposal.class.iter().map(|id| name_of(*id)).collect();
    let file = page.measurement.as_ref().map_or("", |m| m.name.as_str());
    msg!(
        "Experiment that tells {} apart, for {}. Shown here for the case {}.",
        Message::list(" and ", names),
        Message::name(file),
        name_of(model.effect)
    )
}

/// The page that shows a loop, and what opens it there and says its purpose.
fn opened(opening: Opening, sentence: Message) -> (&'static str, Vec<command::Command>) {
    let (page, title, set) = match opening {
        Opening::Loop(input) => ("explore", "Explore", command::Command::SetLoop(input)),
        Opening::Drive(run) => {
            let run = serde_json::to_value(*run).unwrap_or_default();
            let set = command::Command::Set("backlash", "run", run);
            ("backlash", "Backlash", set)
        }
    };
    let purpose = Purpose {
        page,
        sentence,
        from: ("compare", "Back to Compare"),
    };
    let say = command::Command::SetPurpose(Some(Box::new(purpose)));
    (title, vec![set, say, command::Command::Go(page)])
}

/// One row for each model: its loop under the relay at each gain.
fn opening_ui(
    page: &Compare,
    index: usize,
    proposal: &NextExperiment,
    ui: &mut egui::Ui,
    targets: &mut Targets,
    commands: &mut Vec<Command>,
) {
    if !proposal.sufficient {
        return;
    }
    let Program::Relay { gains, .. } = &proposal.program else {
        save_ui(index, ui, targets, commands);
        return;
    };
    for (k, model) in proposal.models.iter().enumerate() {
        ui.horizontal_wrapped(|ui| {
            ui.label(tr(msg!("If it is {}:", name_of(model.effect))));
            for (j, gain) in gains.iter().enumerate() {
                let Some(opening) = proposal.opening(model, *gain) else {
                    continue;
                };
                let (place, command) = opened(opening, purpose(page, proposal, model));
                let gain = in_unit(gain.to_string(), &proposal.input_unit);
                let open = ui.button(tr(match place {
                    "Explore" => msg!("Explore with gain {}", gain),
                    _ => msg!("Backlash with gain {}", gain),
                }));
                targets.note(format!("experiment:{index}:open:{k}:{j}"), ui, &open);
                if open.clicked() {
                    commands.push(Command::Desk(command));
                }
            }
        });
    }
}

/// Saves the input of a proposal.
pub(super) fn save_ui(
    index: usize,
    ui: &mut egui::Ui,
    targets: &mut Targets,
    commands: &mut Vec<Command>,
) {
    let save = ui.button(tr("Save the input as CSV")).on_hover_text(tr(
        "Time and input, sample by sample, to play back on the rig",
    ));
    targets.note(format!("experiment:{index}:save"), ui, &save);
    if save.clicked() {
        commands.push(Command::SaveInput(index));
    }
}

/// How well each kind of experiment would do, as bars.
pub(super) fn trials_ui(index: usize, proposal: &NextExperiment, ui: &mut egui::Ui) {
    let trials: Vec<Trial> = std::iter::once(proposal.trial())
        .chain(proposal.others.iter().cloned())
        .collect();
    let most = trials.iter().map(|t| t.separation).fold(1.0, f64::max);
    egui::CollapsingHeader::new(tr("What other experiments would show"))
        .id_salt(("trials", index))
        .show(ui, |ui| {
            ui.small(tr(
                "How much the models would differ, in units of the noise.",
            ));
            for trial in &trials {
                ui.horizontal(|ui| {
                    // Below the noise nothing is seen, far above it all is: a logarithmic bar from 0.01.
                    let floor = 0.01_f64;
                    let share = (trial.separation / floor).max(1.0).ln() / (most / floor).ln();
                    let (rect, _) =
                        ui.allocate_exact_size(egui::vec2(BAR, 12.0), egui::Sense::hover());
                    let mut bar = rect;
                    bar.set_width(2.0 + share as f32 * (BAR - 2.0));
                    ui.painter().rect_filled(bar, 2.0, theme::RESIDUAL);
                    ui.label(tr(trial.times_noise()));
                });
                ui.label(tr(&trial.text));
            }
        });
}

fn limits_ui(
    page: &Compare,
    index: usize,
    proposal: &NextExperiment,
    ui: &mut egui::Ui,
    targets: &mut Targets,
    commands: &mut Vec<Command>,
) {
    let drive = page
        .measurement
        .as_ref()
        .is_none_or(|m| m.kind == Kind::Drive);
    egui::CollapsingHeader::new(tr("Limits of the experiment"))
        .id_salt(("limits", index))
        .show(ui, |ui| {
            let mut limits = page.limits.unwrap_or(proposal.limits);
            egui::Grid::new(("limits", index))
                .num_columns(2)
                .show(ui, |ui| rows_ui(&mut limits, proposal, drive, ui));
            if Some(limits) != page.limits && limits != proposal.limits {
                commands.push(Command::Limit(limits));
            }
            if page.search.is_some() {
                ui.label(tr("Looking for the experiment ..."));
                return;
            }
            let again = ui.add_enabled(
                limits != proposal.limits,
                egui::Button::new(tr("Search within these limits")),
            );
            targets.note(format!("experiment:{index}:again"), ui, &again);
            if again.clicked() {
                commands.push(Command::Search(index, limits));
            }
        });
}

fn rows_ui(limits: &mut Limits, proposal: &NextExperiment, drive: bool, ui: &mut egui::Ui) {
    let mut row = |name: &'static str, value: &mut f64, unit: &str| {
        let label = ui.label(tr(name));
        let speed = 0.01 * value.abs().max(1e-9);
        let drag = Typed::new(*value, unit, 1e-9..=1e9, 6)
            .field(ui.ctx(), value)
            .speed(speed)
            .suffix(in_unit("", unit));
        ui.add(drag).labelled_by(label.id);
        ui.end_row();
    };
    row("Largest input", &mut limits.input, &proposal.input_unit);
    row("Longest record", &mut limits.duration, "s");
    row("Sampling time", &mut limits.step, "s");
    let name = if drive {
        "Largest speed"
    } else {
        "Largest output"
    };
    if let Some(speed) = &mut limits.speed {
        row(name, speed, &proposal.output_unit);
    }
    if let Some(travel) = &mut limits.travel {
        row(
            "Longest travel",
            travel,
            proposal.output_unit.trim_end_matches("/s"),
        );
    }
    if drive && limits.travel.is_none() {
        ui.label(tr("Longest travel"));
        if ui.small_button(tr("Set a limit")).clicked() {
            limits.travel = Some(proposal.travel.max(1e-6));
        }
        ui.end_row();
    }
}
