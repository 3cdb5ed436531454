//! How wide is the hidden gap? A drive under a relay that makes it drift, live.

mod controls;
mod picture;
mod plots;
mod scene;

use hysteron_core::drive::{Command, DriveInput, DriveJob, VelocityRelay, drifting_test};

use super::{Desk, View};
use crate::theme;
use scene::Scene;

/// Time that a frame gives to the simulation, s.
const BUDGET: f64 = 1.5e-3;

/// Events between two looks at the clock.
const BATCH: usize = 200;

/// Width below which everything stands in one column, points.
const NARROW: f32 = 700.0;

/// The page: what is set, and what follows from it.
pub struct Backlash {
    input: DriveInput,
    /// Number of the figure whose claim is checked.
    figure: Option<u32>,
    playing: bool,
    /// The simulated time that is shown, s, and simulated seconds in a second.
    clock: f64,
    speed: f64,
    /// The simulation that is under way, and for what.
    job: Option<(DriveInput, DriveJob)>,
    /// The last one that was finished.
    scene: Option<Scene>,
    message: Option<String>,
}

impl Default for Backlash {
    fn default() -> Self {
        Self {
            input: drifting_test(),
            figure: None,
            playing: true,
            clock: 0.0,
            speed: 0.1,
            job: None,
            scene: None,
            message: None,
        }
    }
}

impl Backlash {
    /// Simulates for a part of a frame; the last result stays until the next is finished.
    fn compute(&mut self, ctx: &egui::Context) {
        let known = self.scene.as_ref().is_some_and(|s| s.input == self.input);
        if self.job.is_none() && !known && self.message.is_none() {
            match DriveJob::new(&self.input) {
                Ok(job) => self.job = Some((self.input, job)),
                Err(error) => self.message = Some(error.to_string()),
            }
        }
        let Some((_, job)) = &mut self.job else {
            return;
        };
        let begin = web_time::Instant::now();
        let mut done = false;
        while !done && begin.elapsed().as_secs_f64() < BUDGET {
            done = job.advance(BATCH);
        }
        if done && let Some((input, job)) = self.job.take() {
            self.scene = Some(Scene::new(input, job.finish()));
        }
        ctx.request_repaint();
    }

    /// Moves the playback on; at its end it begins again.
    fn play(&mut self, ui: &egui::Ui) {
        let Some(scene) = &self.scene else {
            return;
        };
        let end = scene.input.duration;
        if self.playing {
            let seconds = f64::from(ui.input(|i| i.stable_dt).min(0.1));
            self.clock += seconds * self.speed;
            ui.ctx().request_repaint();
        }
        if self.clock > end {
            self.clock = 0.0;
        }
    }

    fn relay(&self) -> Option<VelocityRelay> {
        match self.input.command {
            Command::Relay(relay) => Some(relay),
            Command::Torque(_) => None,
        }
    }

    fn answer_ui(&self, ui: &mut egui::Ui) {
        if let Some(message) = &self.message {
            ui.colored_label(ui.visuals().warn_fg_color, message);
        }
        let Some(scene) = &self.scene else {
            theme::answer_ui(ui, "Simulating ...");
            return;
        };
        theme::answer_ui(ui, &scene.answer);
        ui.label(&scene.lesson);
    }

    fn wide_ui(&mut self, ui: &mut egui::Ui) {
        egui::Panel::left("drive")
            .default_size(350.0)
            .resizable(false)
            .show(ui, |ui| {
                egui::ScrollArea::vertical().show(ui, |ui| self.controls_ui(ui));
            });
        egui::CentralPanel::default().show(ui, |ui| {
            self.answer_ui(ui);
            self.playback_ui(ui);
            let Some(scene) = &self.scene else {
                return;
            };
            picture::ui(ui, scene, self.clock, 120.0);
            let height = (0.5 * ui.available_height() - 34.0).max(120.0);
            plots::time_ui(ui, scene, self.clock, height);
            ui.columns(2, |columns| {
                plots::phase_ui(&mut columns[0], scene, self.clock, height);
                plots::map_ui(&mut columns[1], scene, self.clock, height);
            });
        });
    }

    fn narrow_ui(&mut self, ui: &mut egui::Ui) {
        egui::CentralPanel::default().show(ui, |ui| {
            egui::ScrollArea::vertical().show(ui, |ui| {
                self.answer_ui(ui);
                self.playback_ui(ui);
                if let Some(scene) = &self.scene {
                    picture::ui(ui, scene, self.clock, 120.0);
                    plots::time_ui(ui, scene, self.clock, 220.0);
                    plots::phase_ui(ui, scene, self.clock, 240.0);
                    plots::map_ui(ui, scene, self.clock, 240.0);
                }
                self.controls_ui(ui);
            });
        });
    }
}

impl View for Backlash {
    fn id(&self) -> &'static str {
        "backlash"
    }

    fn title(&self) -> &'static str {
        "Backlash"
    }

    fn ui(&mut self, ui: &mut egui::Ui, _desk: &mut Desk) {
        self.compute(ui.ctx());
        self.play(ui);
        if ui.available_width() < NARROW {
            self.narrow_ui(ui);
        } else {
            self.wide_ui(ui);
        }
    }

    fn hook_state(&self) -> serde_json::Value {
        let scene = self.scene.as_ref();
        serde_json::json!({
            "busy": self.job.is_some(),
            "message": self.message,
            "figure": self.figure,
            "answer": scene.map(|s| s.answer.clone()),
            "lesson": scene.map(|s| s.lesson.clone()),
            "gap": 2.0 * self.input.drive.half_gap,
            "gap_by_map": scene.and_then(|s| s.summary.gap()),
            "direction": scene.zip(self.relay()).and_then(|(s, r)| s.summary.direction(&r)),
            "clock": self.clock,
            "playing": self.playing,
        })
    }
}
