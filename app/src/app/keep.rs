//! What the app keeps from one session to the next.

use super::{Chosen, HysteronApp};
#[cfg(target_arch = "wasm32")]
use crate::address;
use crate::document::Document;
use crate::fonts;
use crate::language::Language;
use crate::motion;
use crate::theme::Look;

/// Keys under which the last session is kept.
const KEPT: &str = "hysteron";
const KEPT_LOOK: &str = "hysteron look";
const KEPT_LANGUAGE: &str = "hysteron language";
const KEPT_MOTION: &str = "hysteron motion";
const KEPT_RECENT: &str = "hysteron files";
const KEPT_SOLVED: &str = "hysteron lessons";
const KEPT_SIDE: &str = "hysteron side";
#[cfg(target_arch = "wasm32")]
const KEPT_ADDRESS: &str = "hysteron address";

/// What is kept under the key of motion where nothing may move by itself.
const CALM: &str = "reduced";

impl HysteronApp {
    /// The app as it was left.
    pub fn restored(context: &eframe::CreationContext<'_>) -> Self {
        // They are there from the next frame on, which is the first.
        fonts::apply(&context.egui_ctx);
        let mut app = Self::default();
        let kept = |key: &str| context.storage.and_then(|s| s.get_string(key));
        app.prefer(kept);
        if let Some(recent) = kept(KEPT_RECENT) {
            app.desk.recent = serde_json::from_str(&recent).unwrap_or_default();
        }
        if let Some(solved) = kept(KEPT_SOLVED) {
            app.desk.study.solved = solved.split_whitespace().map(str::to_owned).collect();
        }
        let side = kept(KEPT_SIDE).and_then(|width| width.parse().ok());
        app.desk.side.chosen = side.filter(|width: &f32| width.is_finite());
        if let Some(text) = kept(KEPT) {
            app.restore(&context.egui_ctx, &text);
        }
        #[cfg(target_arch = "wasm32")]
        {
            app.address = address::Address::resumed(kept(KEPT_ADDRESS));
        }
        app
    }

    /// Takes up what someone has chosen before, and all else from the system.
    fn prefer(&mut self, kept: impl Fn(&str) -> Option<String>) {
        self.look = kept(KEPT_LOOK).as_deref().and_then(Look::named);
        let language = kept(KEPT_LANGUAGE).and_then(|code| Language::of_locale(&code));
        let calm = kept(KEPT_MOTION).map(|motion| motion == CALM);
        self.chosen = Chosen {
            look: self.look.is_some(),
            language: language.is_some(),
            calm: calm.is_some(),
        };
        self.language = language.unwrap_or_else(Language::of_system);
        self.calm = calm.unwrap_or_else(motion::of_system);
    }

    /// What someone has chosen, by the key under which it is kept.
    fn preferred(&self) -> impl Iterator<Item = (&'static str, &'static str)> {
        let motion = if self.calm { CALM } else { "usual" };
        let all = [
            (self.chosen.look, KEPT_LOOK, self.look().name()),
            (self.chosen.language, KEPT_LANGUAGE, self.language.code()),
            (self.chosen.calm, KEPT_MOTION, motion),
        ];
        let chosen = all.into_iter().filter(|(chosen, ..)| *chosen);
        chosen.map(|(_, key, value)| (key, value))
    }

    /// The whole state as a text, for [`Self::restore`].
    pub fn kept(&self) -> String {
        self.document().text(&self.untouched)
    }

    /// Takes up what [`Self::kept`] has left, page by page: what cannot be, such as a file that is not there
    /// any more, is left out.
    pub fn restore(&mut self, ctx: &egui::Context, text: &str) {
        if let Ok(document) = Document::read(text, &self.untouched) {
            let (pages, front, desk) = (&mut self.pages, &mut self.front, &mut self.desk);
            document.restore(ctx, pages, front, desk);
        }
    }
}

impl eframe::App for HysteronApp {
    fn save(&mut self, storage: &mut dyn eframe::Storage) {
        storage.set_string(KEPT, self.kept());
        let solved: Vec<&str> = self.desk.study.solved.iter().map(String::as_str).collect();
        storage.set_string(KEPT_SOLVED, solved.join(" "));
        for (key, value) in self.preferred() {
            storage.set_string(key, value.to_owned());
        }
        if let Some(width) = self.desk.side.chosen {
            storage.set_string(KEPT_SIDE, width.to_string());
        }
        if let Ok(recent) = serde_json::to_string(&self.desk.recent) {
            storage.set_string(KEPT_RECENT, recent);
        }
        #[cfg(target_arch = "wasm32")]
        storage.set_string(KEPT_ADDRESS, self.address.kept().to_owned());
    }

    /// What egui keeps by itself is where everything is scrolled to: a page that is opened again begins with its
    /// headline.
    fn persist_egui_memory(&self) -> bool {
        false
    }

    fn ui(&mut self, ui: &mut egui::Ui, _frame: &mut eframe::Frame) {
        #[cfg(target_arch = "wasm32")]
        if let Some(text) = self.address.changed() {
            let _ = self.open_link(ui.ctx(), &text);
        }
        self.frame_ui(ui);
    }
}
