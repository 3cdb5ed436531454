//! The lesson that stands beside the pages.

use std::collections::BTreeSet;

use hysteron_core::msg;
use serde_json::Value;

use super::{Lesson, after, find, markdown};
use crate::command::Command;
use crate::hook::Targets;
use crate::language::tr;
use crate::layout;
use crate::theme;

/// Width of the panel, points.
const WIDTH: f32 = 340.0;

/// The lesson that is studied, and how far someone has come.
#[derive(Default)]
pub struct Study {
    /// Id of the lesson that is open.
    pub lesson: Option<String>,
    /// Ids of the lessons whose question is solved.
    pub solved: BTreeSet<String>,
    /// What is typed for the lesson of this id.
    typed: (String, String),
    /// Whether the last try was wrong.
    missed: bool,
    /// Whether what was found is still to be brought into view.
    found: bool,
    /// Whether it is folded where there is little room.
    folded: bool,
}

impl Study {
    /// Draws the lesson that is open beside what comes after.
    pub fn ui(&mut self, ui: &mut egui::Ui, targets: &mut Targets, commands: &mut Vec<Command>) {
        let Some(lesson) = self.lesson.as_deref().and_then(find) else {
            return;
        };
        if self.typed.0 != lesson.id {
            self.typed = (lesson.id.to_owned(), String::new());
            (self.missed, self.folded) = (false, false);
        }
        let narrow = ui.available_width() < layout::NARROW;
        if narrow && self.folded {
            egui::Panel::bottom("lesson_folded")
                .resizable(false)
                .show(ui, |ui| self.folded_ui(ui, &lesson, targets));
            return;
        }
        let panel = if narrow {
            egui::Panel::bottom("lesson below").exact_size(0.42 * ui.available_height())
        } else {
            egui::Panel::right("lesson").exact_size(WIDTH)
        };
        panel.resizable(false).show(ui, |ui| {
            self.lesson_ui(ui, &lesson, narrow, targets, commands);
        });
    }

    /// Its title, and how it is unfolded: the page has the rest of a small window.
    fn folded_ui(&mut self, ui: &mut egui::Ui, lesson: &Lesson, targets: &mut Targets) {
        ui.add_space(4.0);
        ui.strong(lesson.title);
        let unfold = ui.button(tr("Expand the lesson"));
        targets.note("lesson:fold", ui, &unfold);
        if unfold.clicked() {
            self.folded = false;
        }
        ui.add_space(4.0);
    }

    /// Whether the question of the open lesson is solved by what was typed and what the app shows.
    pub fn check(&mut self, state: &Value) {
        let Some(lesson) = self.lesson.as_deref().and_then(find) else {
            return;
        };
        self.missed = !lesson.question.solved(&self.typed.1, state);
        self.found = true;
        if !self.missed {
            self.solved.insert(lesson.id.to_owned());
        }
    }

    fn lesson_ui(
        &mut self,
        ui: &mut egui::Ui,
        lesson: &Lesson,
        narrow: bool,
        targets: &mut Targets,
        commands: &mut Vec<Command>,
    ) {
        ui.add_space(4.0);
        egui::ScrollArea::vertical()
            .id_salt(lesson.id)
            .show(ui, |ui| {
                ui.horizontal_wrapped(|ui| {
                    ui.label(tr(msg!("Lesson, {} minutes", lesson.minutes)));
                    let close = ui.button(tr("Close lesson"));
                    targets.note("lesson:close", ui, &close);
                    if close.clicked() {
                        commands.push(Command::Lesson(None));
                    }
                    if narrow {
                        let fold = ui.button(tr("Collapse the lesson"));
                        targets.note("lesson:fold", ui, &fold);
                        self.folded = fold.clicked();
                    }
                });
                ui.add(
                    egui::Label::new(egui::RichText::new(lesson.title).size(20.0).strong()).wrap(),
                );
                if let Some(link) = markdown::ui(ui, &lesson.text) {
                    commands.push(Command::OpenLink(format!("{link};lesson={}", lesson.id)));
                }
                ui.add_space(4.0);
                self.question_ui(ui, lesson, commands);
                ui.add_space(12.0);
            });
    }

    fn question_ui(&mut self, ui: &mut egui::Ui, lesson: &Lesson, commands: &mut Vec<Command>) {
        let question = &lesson.question;
        let mut asked = false;
        ui.horizontal_wrapped(|ui| {
            if let Some(answer) = question.answer {
                let label = ui.label(tr("Your answer"));
                let field = theme::line(&mut self.typed.1).desired_width(80.0);
                let field = ui.add(field).labelled_by(label.id);
                asked |= field.lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Enter));
                if !answer.unit.is_empty() {
                    ui.label(answer.unit);
                }
            }
            asked |= ui.button(tr("Check")).clicked();
        });
        if asked {
            commands.push(Command::Check);
        }
        let said = ui.scope(|ui| self.found_ui(ui, lesson, commands)).response;
        if std::mem::take(&mut self.found) {
            said.scroll_to_me(None);
        }
    }

    /// Whether the answer was right, and what follows.
    fn found_ui(&self, ui: &mut egui::Ui, lesson: &Lesson, commands: &mut Vec<Command>) {
        let question = &lesson.question;
        if self.missed {
            ui.colored_label(ui.visuals().warn_fg_color, tr("Not yet."));
            ui.label(question.hint);
        } else if self.solved.contains(lesson.id) {
            ui.colored_label(theme::readable(ui, theme::NOISE), tr("Right."));
            ui.label(question.right);
            if let Some(next) = after(lesson.id)
                && ui.button(tr(msg!("Next lesson: {}", next.title))).clicked()
            {
                commands.push(Command::Lesson(Some(next.id.to_owned())));
            }
        }
    }
}
