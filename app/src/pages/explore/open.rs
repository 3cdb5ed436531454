//! Scenarios from files: they set the page.

use hysteron_core::message::Message;
use hysteron_core::msg;
use hysteron_work::tasks::{ScenarioReport, ScenarioTask};

use super::Explore;
use super::controller::Controller;
use super::{on_off, servo};
use crate::command::Command;
use crate::files::SCENARIO;
use crate::jobs::{Job, ended};
use crate::language::tr;

/// Longest file that is read, bytes.
const LONGEST: usize = 100_000;

impl Explore {
    /// Takes what files and their reading have brought.
    pub(super) fn take_files(&mut self, ctx: &egui::Context) {
        while let Some(arrival) = self.files.arrived() {
            let bytes = arrival.bytes.map_err(Message::name);
            let text = bytes.and_then(|bytes| {
                if bytes.len() > LONGEST {
                    return Err("it is too long for a scenario".into());
                }
                String::from_utf8(bytes).map_err(|_| "it is not text".into())
            });
            match text {
                Ok(text) => self.reading = Some(Job::run(ctx, ScenarioTask(text))),
                Err(error) => {
                    let name = Message::name(arrival.name);
                    self.message = Some(msg!("{}: cannot be read ({})", name, error));
                }
            }
        }
        match ended(&mut self.reading, |_, _| ()) {
            Some(Ok(report)) => {
                self.message = None;
                let keys = report.left_out.join(", ");
                self.left_out = (!keys.is_empty()).then(|| {
                    msg!("Explore shows as much as the cycle needs and leaves out these settings of the run in the \
                          file: {}. On the command line, hysteron simulate uses them.", Message::name(keys))
                });
                self.opened = Some(report.report);
            }
            Some(Err(error)) => self.message = Some(error),
            None => {}
        }
    }

    /// Sets the page as a scenario has it that was opened; a drive with a gap has a page of its own.
    pub(super) fn take_scenario(&mut self, commands: &mut Vec<Command>) {
        let Some(report) = self.opened.take() else {
            return;
        };
        if !matches!(report, ScenarioReport::Drive(_)) {
            self.figure = None;
        }
        match report {
            ScenarioReport::Loop(input) => {
                self.controller = Controller::TwoLevels;
                self.on_off.put(on_off::Settings::default());
                self.input = *input;
            }
            ScenarioReport::OnOff(input) => {
                let (controller, set, shared) = on_off::Settings::of(&input, &self.input);
                self.controller = controller;
                self.on_off.put(set);
                self.input = shared;
            }
            ScenarioReport::Servo(servo) => {
                self.controller = Controller::Servo;
                self.servo.put(servo::Settings::of(&servo));
            }
            ScenarioReport::Drive(run) => {
                let run = serde_json::to_value(run).unwrap_or_default();
                commands.push(Command::Set("backlash", "run", run));
                commands.push(Command::Go("backlash"));
            }
        }
    }

    /// Asks for a file.
    pub(super) fn open_ui(&mut self, ui: &mut egui::Ui) {
        if ui
            .button(tr("Open a scenario ..."))
            .on_hover_text(tr(
                "Or drop it on this window: plant, relay or servo as a TOML file, as the command line takes it",
            ))
            .clicked()
        {
            self.files.entrance.open_dialog(ui.ctx(), SCENARIO);
        }
    }

    /// What was wrong with a file, or is not shown of it.
    pub(super) fn message_ui(&mut self, ui: &mut egui::Ui) {
        if let Some(message) = self.files.refused() {
            self.message = Some(message);
        }
        if let Some(message) = &self.message {
            ui.colored_label(ui.visuals().warn_fg_color, tr(message));
        }
        if let Some(left_out) = &self.left_out {
            ui.weak(tr(left_out));
        }
    }
}
