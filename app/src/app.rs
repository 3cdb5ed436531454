//! The shell around the pages.

use crate::pages::{Command, Desk, View, registry};
use crate::theme;

/// The app: the pages and what they share.
pub struct HysteronApp {
    pages: Vec<Box<dyn View>>,
    front: usize,
    desk: Desk,
    frame: u64,
}

impl Default for HysteronApp {
    fn default() -> Self {
        Self {
            pages: registry(),
            front: 0,
            desk: Desk::default(),
            frame: 0,
        }
    }
}

impl HysteronApp {
    /// The app with the page of this id in front; an unknown id changes nothing.
    pub fn at(id: &str) -> Self {
        let mut app = Self::default();
        app.go(id);
        app
    }

    /// Ids of all pages, in the order of their tabs.
    pub fn page_ids(&self) -> Vec<&'static str> {
        self.pages.iter().map(|p| p.id()).collect()
    }

    /// Opens the bytes of a file on the page in front, or on the first one that takes files.
    pub fn open(&mut self, ctx: &egui::Context, name: &str, bytes: &[u8]) {
        if let Some(page) = self.go_to_files() {
            page.open(ctx, name, bytes);
        }
    }

    /// One frame: takes what came in, draws the page, publishes the state.
    pub fn frame_ui(&mut self, ui: &mut egui::Ui) {
        if self.frame == 0 {
            theme::apply(ui.ctx());
        }
        self.frame += 1;
        self.desk.targets.clear();
        self.take_dropped_files(ui.ctx());
        for page in &mut self.pages {
            page.update(ui.ctx());
        }
        egui::Panel::top("bar").show(ui, |ui| self.bar_ui(ui));
        if let Some(page) = self.pages.get_mut(self.front) {
            page.ui(ui, &mut self.desk);
        }
        for command in std::mem::take(&mut self.desk.commands) {
            self.carry_out(command);
        }
        drop_hint_ui(ui.ctx());
        #[cfg(target_arch = "wasm32")]
        crate::hook::publish(&self.hook_state());
    }

    fn carry_out(&mut self, command: Command) {
        match command {
            Command::Go(id) => self.go(id),
            Command::SetLoop(input) => self.desk.relay_loop = *input,
        }
    }

    fn go(&mut self, id: &str) {
        if let Some(index) = self.pages.iter().position(|p| p.id() == id) {
            self.front = index;
        }
    }

    /// What is on the screen, for tests: the state of the page in front, that of every page by its id,
    /// and what concerns all.
    pub fn hook_state(&self) -> serde_json::Value {
        let front = self.pages.get(self.front);
        let mut state = front.map_or_else(|| serde_json::json!({}), |p| p.hook_state());
        let mut busy = false;
        for page in &self.pages {
            let own = page.hook_state();
            busy |= own["busy"] == true;
            state[page.id()] = own;
        }
        state["ready"] = true.into();
        state["busy"] = busy.into();
        state["page"] = front.map(|p| p.id()).into();
        state["frame"] = self.frame.into();
        state["targets"] = self.desk.targets.to_json();
        state
    }

    fn bar_ui(&mut self, ui: &mut egui::Ui) {
        ui.horizontal_wrapped(|ui| {
            ui.heading("Hysteron");
            for (index, page) in self.pages.iter().enumerate() {
                let tab = ui.selectable_label(self.front == index, page.title());
                let name = format!("page:{}", page.id());
                self.desk.targets.note(name, ui, &tab);
                if tab.clicked() {
                    self.front = index;
                }
            }
            let dark = ui.visuals().dark_mode;
            let (label, other) = if dark {
                ("Light", egui::Theme::Light)
            } else {
                ("Dark", egui::Theme::Dark)
            };
            if ui.button(label).clicked() {
                ui.ctx().set_theme(other);
            }
        });
    }

    fn take_dropped_files(&mut self, ctx: &egui::Context) {
        if let Some(file) = ctx.input(|i| i.raw.dropped_files.first().cloned())
            && let Some(page) = self.go_to_files()
        {
            page.open_dropped(ctx, &file);
        }
    }

    /// Brings a page that takes files to the front, unless one is there.
    fn go_to_files(&mut self) -> Option<&mut Box<dyn View>> {
        let here = self.pages.get(self.front).is_some_and(|p| p.takes_files());
        if !here {
            self.front = self.pages.iter().position(|p| p.takes_files())?;
        }
        self.pages.get_mut(self.front)
    }
}

fn drop_hint_ui(ctx: &egui::Context) {
    if ctx.input(|i| !i.raw.hovered_files.is_empty()) {
        egui::Area::new(egui::Id::unique("drop"))
            .anchor(egui::Align2::CENTER_CENTER, egui::Vec2::ZERO)
            .show(ctx, |ui| {
                egui::Frame::popup(ui.style())
                    .show(ui, |ui| ui.heading("Drop the measurement to compare it"));
            });
    }
}

impl eframe::App for HysteronApp {
    fn ui(&mut self, ui: &mut egui::Ui, _frame: &mut eframe::Frame) {
        self.frame_ui(ui);
    }
}
