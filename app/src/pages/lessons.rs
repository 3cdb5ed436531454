//! What can be learned here: the lessons, in the order of the course.

use super::{Command, Desk, View};
use crate::language::tr;
use crate::lessons;
use crate::theme;

/// The page.
#[derive(Default)]
pub struct Lessons;

impl View for Lessons {
    fn id(&self) -> &'static str {
        "lessons"
    }

    fn title(&self) -> &'static str {
        "Lessons"
    }

    fn ui(&mut self, ui: &mut egui::Ui, desk: &mut Desk) {
        egui::CentralPanel::default().show(ui, |ui| {
            egui::ScrollArea::vertical().show(ui, |ui| {
                ui.add_space(6.0);
                theme::answer_ui(ui, "What can a relay teach in ten minutes?");
                ui.label(tr("Each lesson stands beside the app: its buttons set the pages, and its question is checked."));
                ui.add_space(8.0);
                for (index, lesson) in lessons::all().enumerate() {
                    egui::Frame::group(ui.style()).show(ui, |ui| {
                        ui.set_width(ui.available_width().min(720.0));
                        ui.horizontal_wrapped(|ui| {
                            let text = format!("{}  {}", index + 1, lesson.title);
                            let button = ui.button(egui::RichText::new(text).size(17.0));
                            desk.targets.note(format!("lesson:{}", lesson.id), ui, &button);
                            if button.clicked() {
                                desk.commands.push(Command::Lesson(Some(lesson.id.to_owned())));
                            }
                            ui.label(tr(format!("{} minutes", lesson.minutes)));
                            if desk.study.solved.contains(lesson.id) {
                                ui.colored_label(theme::readable(ui, theme::NOISE), tr("solved"));
                            }
                        });
                    });
                }
            });
        });
    }

    fn settings(&self) -> serde_json::Value {
        serde_json::json!({})
    }

    fn set(
        &mut self,
        _ctx: &egui::Context,
        _settings: &serde_json::Value,
        _desk: &Desk,
    ) -> Result<(), String> {
        Ok(())
    }

    fn hook_state(&self) -> serde_json::Value {
        serde_json::json!({"busy": false})
    }
}
