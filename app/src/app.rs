//! The shell around the pages.

use crate::hook::Targets;
use crate::pages::{Command, Compare, Explore, Maps, Page};
use crate::theme;

/// The app: the pages and what is shown of them.
#[derive(Default)]
pub struct HysteronApp {
    /// The page in front.
    pub page: Page,
    explore: Explore,
    maps: Maps,
    /// The page that criticises a model.
    pub compare: Compare,
    targets: Targets,
    frame: u64,
}

impl HysteronApp {
    /// One frame: takes what came in, draws the page, publishes the state.
    pub fn frame_ui(&mut self, ui: &mut egui::Ui) {
        if self.frame == 0 {
            theme::apply(ui.ctx());
        }
        self.frame += 1;
        self.targets.clear();
        self.take_dropped_files(ui.ctx());
        self.compare.update(ui.ctx());
        egui::Panel::top("bar").show(ui, |ui| self.bar_ui(ui));
        let mut commands = Vec::new();
        match self.page {
            Page::Explore => self.explore.ui(ui),
            Page::Maps => self.maps.ui(ui, self.explore.input(), &mut commands),
            Page::Compare => self.compare.ui(ui, &mut self.targets),
        }
        for command in commands {
            self.carry_out(command);
        }
        drop_hint_ui(ui.ctx());
        #[cfg(target_arch = "wasm32")]
        crate::hook::publish(&self.hook_state());
    }

    fn carry_out(&mut self, command: Command) {
        match command {
            Command::Go(page) => self.page = page,
            Command::SetLoop(input) => self.explore.set(*input),
        }
    }

    /// What is on the screen, for tests.
    pub fn hook_state(&self) -> serde_json::Value {
        let mut state = self.compare.hook_state();
        state["ready"] = true.into();
        state["maps"] = self.maps.hook_state();
        let mapping = state["maps"]["busy"] == true;
        state["busy"] = (state["busy"] == true || mapping).into();
        state["page"] = self.page.id().into();
        state["frame"] = self.frame.into();
        state["targets"] = self.targets.to_json();
        state
    }

    fn bar_ui(&mut self, ui: &mut egui::Ui) {
        ui.horizontal_wrapped(|ui| {
            ui.heading("Hysteron");
            for page in Page::ALL {
                let tab = ui.selectable_label(self.page == page, page.title());
                self.targets.note(format!("page:{}", page.id()), ui, &tab);
                if tab.clicked() {
                    self.page = page;
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
        if let Some(file) = ctx.input(|i| i.raw.dropped_files.first().cloned()) {
            self.page = Page::Compare;
            self.compare.open_dropped(ctx, &file);
        }
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
