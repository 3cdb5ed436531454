//! How the app carries out what is asked of it.

use super::HysteronApp;
use crate::address;
use crate::command::Command;
use crate::files::MEASUREMENT;
use crate::notice::Notice;
use crate::theme::Look;
use crate::{lessons, link};
use hysteron_core::message::Message;
use hysteron_core::msg;

impl HysteronApp {
    pub(super) fn carry_out(&mut self, ui: &egui::Ui, command: Command) {
        let ctx = ui.ctx();
        match command {
            Command::Undo | Command::Redo => self.travel(ctx, command == Command::Undo),
            Command::AskForFile => {
                if let Some((_, door)) = self.go_to_files(None) {
                    door.entrance.open_dialog(ctx, MEASUREMENT);
                }
            }
            Command::Reset => self.reset_page(ctx),
            Command::Lesson(Some(id)) => self.open_lesson(ctx, &id),
            Command::Lesson(None) => self.desk.study.lesson = None,
            Command::Check => {
                let state = self.hook_state();
                self.desk.study.check(&state);
            }
            Command::Play => {
                self.desk.play = true;
                ctx.request_repaint();
            }
            Command::SaveSvg => self.save_svg(ui, &self.document().page, ctx.content_rect()),
            Command::SavePng => self.save_png(ctx, &self.document().page, ctx.content_rect()),
            Command::SaveTable(name) => {
                if let Some(table) = self.tables().into_iter().find(|t| t.name == name) {
                    self.save_table(ctx, &name.replace(' ', "-"), &table);
                }
            }
            Command::NextLook => self.choose_look(ctx, self.look().next()),
            Command::SetLook(look) => self.choose_look(ctx, look),
            Command::Calm(calm) => {
                self.chosen.calm = true;
                self.set_calm(ctx, calm);
            }
            Command::Speak(language) => {
                self.chosen.language = true;
                self.speak(language);
            }
            Command::Sheet => self.sheet = !self.sheet,
            Command::Close => {
                self.sheet = false;
                self.notice = None;
            }
            Command::CopyLink => self.copy_link(ctx),
            Command::CopyOther { link, saying } => {
                ctx.copy_text(address::whole(&link));
                self.notice = Some(Notice::done(ctx, saying));
            }
            Command::Save(document) => self.save_text(ctx, *document),
            Command::OpenFile(page, name, bytes) => {
                self.go(page);
                self.open(ctx, &name, &bytes);
            }
            Command::OpenLink(text) => {
                // A refusal is on the screen.
                let _ = self.open_link(ctx, &text);
            }
            Command::Go(id) => self.go(id),
            Command::SetLoop(input) => {
                self.desk.relay_loop = *input;
                self.desk.purpose = None;
            }
            Command::SetPurpose(purpose) => self.desk.purpose = purpose,
            Command::Set(page, field, value) => self.set_field(ctx, page, field, value),
        }
    }

    /// Puts the page in front back to what it is when nothing was touched.
    fn reset_page(&mut self, ctx: &egui::Context) {
        // The link of an untouched page is its name.
        let before = self.document();
        let untouched = format!("{};{}", link::VERSION, before.page);
        // A key does it, which may be hit by mistake.
        if self.open_link(ctx, &untouched).is_ok() && self.document() != before {
            let saying = "This page is reset. Undo brings your settings back.";
            self.notice = Some(Notice::done(ctx, saying));
        }
    }

    /// Opens a lesson: it begins with what its first button shows.
    fn open_lesson(&mut self, ctx: &egui::Context, id: &str) {
        let lesson = lessons::find(id);
        if let Some(link) = lesson.and_then(|l| l.links().next()) {
            let _ = self.open_link(ctx, &format!("{link};lesson={id}"));
        }
    }

    /// Copies the link to what is on the screen, and says which files it cannot carry.
    fn copy_link(&mut self, ctx: &egui::Context) {
        let link = self.link();
        ctx.copy_text(address::of(&link));
        let saying = match self.document().files().as_slice() {
            [] => "The link to this page, as it is now, is copied.".into(),
            [name] => {
                msg!(
                    "The link is copied. The file {} is not part of it: send it along.",
                    Message::name(*name)
                )
            }
            names => msg!(
                "The link is copied. The files {} are not part of it: send them along.",
                Message::name(names.join(", "))
            ),
        };
        self.notice = Some(Notice::done(ctx, saying));
    }

    /// Sets one field of what is set on a page.
    fn set_field(
        &mut self,
        ctx: &egui::Context,
        page: &str,
        field: &str,
        value: serde_json::Value,
    ) {
        self.desk.purpose.take_if(|purpose| purpose.page == page);
        let page = self.pages.iter_mut().find(|p| p.id == page);
        let refused = page.and_then(|page| {
            let mut settings = page.view.settings();
            settings[field] = value;
            page.view.set(ctx, &settings, &self.desk).err()
        });
        if let Some(sentence) = refused {
            self.notice = Some(Notice::refused(&sentence));
        }
    }

    /// Goes back to what was set before the last change, or forth again.
    fn travel(&mut self, ctx: &egui::Context, back: bool) {
        let present = self.document();
        let there = if back {
            self.history.undo(&present)
        } else {
            self.history.redo(&present)
        };
        if let Some(document) = there.cloned()
            && let Err(sentence) = self.apply(ctx, &document)
        {
            self.notice = Some(Notice::refused(sentence));
        }
        // What opened the experiment is taken back.
        let page = self.document().page;
        self.desk.purpose.take_if(|purpose| purpose.page != page);
    }

    fn choose_look(&mut self, ctx: &egui::Context, look: Look) {
        self.chosen.look = true;
        self.set_look(ctx, look);
    }
}
