//! What can be learned here: the lessons, in the order of the course.

use crate::command::Command;
use crate::desk::Desk;
use crate::language::tr;
use crate::layout;
use crate::lessons::{self, Lesson};
use crate::page::{Page, Settable, View};
use crate::theme;
use hysteron_core::message::Message;
use hysteron_core::msg;

/// The page.
#[derive(Default)]
pub struct Lessons;

/// The page as the registry has it.
pub fn page() -> Page {
    Page::new("lessons", "Lessons", Lessons)
}

impl View for Lessons {
    fn ui(&mut self, ui: &mut egui::Ui, desk: &mut Desk) {
        egui::CentralPanel::default().show(ui, |ui| {
            theme::scroll("lessons").show(ui, |ui| {
                ui.add_space(6.0);
                theme::answer_ui(ui, "What can a relay teach in ten minutes?");
                ui.label(tr(
                    "Each lesson opens beside the app: its buttons set up the pages, and your answer is checked."));
                ui.add_space(8.0);
                let all: Vec<_> = lessons::all().enumerate().collect();
                if ui.available_width() < layout::NARROW {
                    for (index, lesson) in &all {
                        let card = layout::card(ui, 0.0, |ui, _| lesson_ui(ui, desk, *index, lesson));
                        desk.commands.extend(card.pressed.then(|| begin(lesson)));
                    }
                    return;
                }
                for (number, row) in all.chunks(2).enumerate() {
                    let pressed = layout::row(ui, ("lessons", number), row.len(), |ui, place, _| {
                        if let Some((index, lesson)) = row.get(place) {
                            lesson_ui(ui, desk, *index, lesson);
                        }
                    });
                    let pressed = pressed.and_then(|place| row.get(place));
                    desk.commands.extend(pressed.map(|(_, lesson)| begin(lesson)));
                }
            });
        });
    }

    fn hook_state(&self) -> serde_json::Value {
        serde_json::json!({"busy": false})
    }
}

impl Settable for Lessons {
    type Settings = serde_json::Value;

    /// Nothing.
    fn set_to(&self) -> serde_json::Value {
        serde_json::json!({})
    }

    fn take(
        &mut self,
        _ctx: &egui::Context,
        _settings: serde_json::Value,
        _desk: &Desk,
    ) -> Result<(), Message> {
        Ok(())
    }
}

/// Opens a lesson.
fn begin(lesson: &Lesson) -> Command {
    Command::Lesson(Some(lesson.id.to_owned()))
}

/// A lesson: its title, how long it takes, and how it begins.
fn lesson_ui(ui: &mut egui::Ui, desk: &mut Desk, index: usize, lesson: &Lesson) {
    let title = format!("{}  {}", index + 1, lesson.title);
    let button = ui.button(egui::RichText::new(title).size(17.0));
    desk.targets
        .note(format!("lesson:{}", lesson.id), ui, &button);
    if button.clicked() {
        desk.commands.push(begin(lesson));
    }
    lesson.beginning_ui(ui);
    ui.horizontal(|ui| {
        ui.small(tr(msg!("{} minutes", lesson.minutes)));
        if desk.study.solved.contains(lesson.id) {
            ui.colored_label(theme::readable(ui, theme::NOISE), tr("solved"));
        }
    });
}
