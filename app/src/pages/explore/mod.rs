//! A relay loop, live: what is predicted beside what happens.

mod controller;
mod controls;
mod cycle_table;
mod hint;
mod live_answer;
mod nyquist;
mod on_off;
mod open;
mod plant_editor;
mod servo;
mod settings;
mod table;
mod theory;

use std::collections::VecDeque;

use hysteron_core::explore::{ExploreData, ExploreInput};
use hysteron_core::figures::{Check, figures};
use hysteron_core::message::Message;

use crate::desk::Desk;
use crate::export::Table;
use crate::files::Files;
use crate::jobs::{Job, ended};
use crate::language::tr;
use crate::layout;
use crate::page::{Hint, Offer, Page, View};
use crate::theme;
use crate::widgets::controls::claim_ui;
use crate::widgets::playback::Playback;
use crate::widgets::relay_loop::{self, TABLES, tables};
use controller::Controller;
use hysteron_work::tasks::{LoopTask, ScenarioReport, ScenarioTask};
use nyquist::Nyquist;
use on_off::OnOff;
use plant_editor::PlantEditor;
use servo::Hunting;
use theory::Theory;

/// Simulated periods that are played back in a second.
const PERIODS_PER_SECOND: f64 = 0.6;

/// Least height of a plot with its caption, points.
const LEAST: f32 = 110.0;

/// Computations whose time is remembered.
const REMEMBERED: usize = 31;

/// The page: what is set, and what follows from it.
#[derive(Default)]
pub struct Explore {
    input: ExploreInput,
    editor: PlantEditor,
    nyquist: Nyquist,
    /// Number of the figure whose claim is checked.
    figure: Option<u32>,
    playback: Playback,
    /// Where the line can be taken hold of, for tests.
    line_at: Option<egui::Pos2>,
    finished: Option<Finished>,
    /// A loop with noise, which takes longer than a frame has.
    computing: Option<Job<LoopTask>>,
    /// What that is of.
    asked: Option<LoopTask>,
    /// How long the last computations took, s.
    took: VecDeque<f64>,
    controller: Controller,
    /// What a relay has as it is built, and a drive with a controller, where the page is about them.
    on_off: OnOff,
    servo: Hunting,
    theory: Theory,
    files: Files,
    /// A scenario that is being read, what was read, and why nothing was.
    reading: Option<Job<ScenarioTask>>,
    opened: Option<ScenarioReport>,
    message: Option<Message>,
    /// What the page does not show of the scenario that was opened last.
    left_out: Option<Message>,
}

/// What the page is about.
#[derive(Clone, Copy, PartialEq, Eq)]
enum About {
    /// The relay of the textbook.
    Relay,
    /// One as it is built.
    OnOff,
    /// A drive with a controller.
    Servo,
}

/// What was computed, and for what.
struct Finished {
    asked: LoopTask,
    data: Result<(ExploreData, Vec<Check>), Message>,
}

/// The page as the registry has it.
pub fn page() -> Page {
    let mut view = Explore::default();
    let door = view
        .files
        .door("Drop a scenario to open it here, or a measurement to compare it with models")
        .only(".toml");
    Page::new("explore", "Explore", view).with_own_door(door)
}

impl View for Explore {
    fn update(&mut self, ctx: &egui::Context) {
        self.take_files(ctx);
        self.take_noisy();
        self.on_off.update();
        self.servo.update();
    }

    fn ui(&mut self, ui: &mut egui::Ui, desk: &mut Desk) {
        self.input.clone_from(&desk.relay_loop);
        self.take_scenario(&mut desk.commands);
        match self.about() {
            About::Relay => self.compute(ui.ctx()),
            About::OnOff => self.on_off.ask(ui.ctx(), self.controller, &self.input),
            About::Servo => self.servo.ask(ui.ctx()),
        }
        if std::mem::take(&mut desk.play) {
            self.playback.toggle(ui.ctx());
        }
        if self.about() == About::Relay {
            self.play(ui);
        }
        if ui.available_width() < layout::NARROW {
            self.narrow_ui(ui);
        } else {
            self.wide_ui(ui);
        }
        if let Some(at) = self.line_at.take() {
            desk.targets.note_place("nyquist:line", at);
        }
        if self.input != desk.relay_loop {
            desk.relay_loop.clone_from(&self.input);
            ui.ctx().request_repaint();
        }
    }

    fn hook_state(&self) -> serde_json::Value {
        let mut state = match self.about() {
            About::Relay => self.relay_state(),
            About::OnOff => self.on_off.state(),
            About::Servo => self.servo.state(),
        };
        state["controller"] = serde_json::json!(self.controller);
        state["loop"] = serde_json::json!(self.input);
        if self.reading.is_some() || self.opened.is_some() {
            state["busy"] = true.into();
        }
        if let Some(message) = &self.message {
            state["message"] = message.to_string().into();
        }
        if let Some(left_out) = &self.left_out {
            state["left_out"] = left_out.to_string().into();
        }
        state
    }

    fn offer(&self) -> Offer<'_> {
        match self.about() {
            About::Relay => Offer::new(self.hint(), self.table_names(), || self.tables()),
            About::OnOff => Offer::new(
                self.on_off.hint(self.controller),
                self.on_off.table_names(),
                || self.on_off.tables(),
            ),
            About::Servo => Offer::new(self.servo.hint(), self.servo.table_names(), || {
                self.servo.tables()
            }),
        }
    }
}

impl Explore {
    fn about(&self) -> About {
        if self.controller == Controller::Servo {
            About::Servo
        } else if self.on_off.set.is_more(self.controller) {
            About::OnOff
        } else {
            About::Relay
        }
    }

    fn relay_state(&self) -> serde_json::Value {
        let data = self.data();
        let cycle = |c: hysteron_core::limit_cycle::Cycle| serde_json::json!({"period": c.period, "amplitude": c.amplitude});
        serde_json::json!({
            "busy": self.computing.is_some(),
            "compute_ms": self.usual_time().map(|t| 1e3 * t),
            "answer": data.map(|(d, _)| d.text.clone()),
            "stability": data.map(|(d, _)| d.stability.clone()),
            "trust": data.map(|(d, _)| d.trust.text.clone()),
            "describing_function": data.and_then(|(d, _)| d.describing()).map(|i| cycle(i.cycle)),
            "exact": data.and_then(|(d, _)| d.exact).map(cycle),
            "simulated": data.and_then(|(d, _)| d.simulated).map(cycle),
            "figure": self.figure,
            "checks": data.map(|(_, all)| all.iter().map(|c| c.holds).collect::<Vec<_>>()),
            "plant_error": self.editor.error(),
        })
    }

    /// What to try next.
    fn hint(&self) -> Option<Hint> {
        self.data().map(|(data, _)| hint::hint(&self.input, data))
    }

    /// Names of the tables that can be given now.
    fn table_names(&self) -> Vec<&'static str> {
        self.data().map_or_else(Vec::new, |_| TABLES.to_vec())
    }

    /// The numbers behind what is shown.
    fn tables(&self) -> Vec<Table> {
        self.data().map_or_else(Vec::new, |(data, _)| tables(data))
    }
}

impl Explore {
    /// Computes anew if something was changed: at once, or with noise beside the frames, one after the other.
    fn compute(&mut self, ctx: &egui::Context) {
        if self.is_current() {
            return;
        }
        let asked = LoopTask {
            input: self.input.clone(),
            figure: self.figure,
        };
        if self.input.noise.is_some() {
            if self.computing.is_none() {
                self.asked = Some(asked.clone());
                self.computing = Some(Job::run(ctx, asked));
            }
            return;
        }
        self.computing = None;
        let begin = web_time::Instant::now();
        let data = asked.view();
        self.took.truncate(REMEMBERED - 1);
        self.took.push_front(begin.elapsed().as_secs_f64());
        self.finished = Some(Finished { asked, data });
    }

    /// Takes a loop with noise that was computed.
    fn take_noisy(&mut self) {
        if let Some(data) = ended(&mut self.computing, |_, _| ())
            && let Some(asked) = self.asked.take()
        {
            self.finished = Some(Finished { asked, data });
        }
    }

    /// Whether what was computed is of what is set now.
    fn is_current(&self) -> bool {
        let asked = self.finished.as_ref().map(|f| &f.asked);
        asked.is_some_and(|a| a.input == self.input && a.figure == self.figure)
    }

    /// Median time of the last computations, s.
    fn usual_time(&self) -> Option<f64> {
        let mut took: Vec<f64> = self.took.iter().copied().collect();
        took.sort_by(f64::total_cmp);
        took.get(took.len() / 2).copied()
    }

    fn data(&self) -> Option<&(ExploreData, Vec<Check>)> {
        self.finished.as_ref()?.data.as_ref().ok()
    }

    /// Moves the playback on; at its end it begins again.
    fn play(&mut self, ui: &egui::Ui) {
        let Some((data, _)) = self.data() else {
            return;
        };
        let end = data.time.last().copied().unwrap_or(0.0);
        let period = data
            .exact
            .or(data.simulated)
            .map_or(0.1 * end, |c| c.period);
        self.playback.advance(ui, PERIODS_PER_SECOND * period, end);
    }

    fn wide_ui(&mut self, ui: &mut egui::Ui) {
        egui::Panel::left("loop")
            .exact_size(layout::side(ui, 400.0))
            .resizable(false)
            .show(ui, |ui| {
                theme::scroll("explore_side").show(ui, |ui| {
                    self.controls_ui(ui);
                    self.numbers_ui(ui);
                });
            });
        egui::CentralPanel::default().show(ui, |ui| {
            // Large type leaves less room than the plots need.
            theme::scroll("explore").show(ui, |ui| {
                self.answer_ui(ui);
                self.reasons_ui(ui);
                match self.about() {
                    About::Relay => {}
                    About::OnOff => {
                        let height = (ui.available_height() - 10.0).max(340.0);
                        return self.on_off.plots_ui(ui, height);
                    }
                    About::Servo => {
                        let height = (ui.available_height() - 10.0).max(400.0);
                        return self.servo.plots_ui(ui, height);
                    }
                }
                let height = (0.5 * ui.available_height() - 34.0).max(LEAST);
                if layout::room_for_two(ui) {
                    ui.columns(2, |columns| {
                        self.nyquist_ui(&mut columns[0], height);
                        self.phase_ui(&mut columns[1], height);
                    });
                    self.time_ui(ui, height);
                } else {
                    self.nyquist_ui(ui, height);
                    self.time_ui(ui, height);
                    self.phase_ui(ui, height);
                }
            });
        });
    }

    fn narrow_ui(&mut self, ui: &mut egui::Ui) {
        // The answer and one plot stay in view while a slider below them is turned.
        let pinned = layout::pins(ui);
        egui::Panel::top("explore_answer").show(ui, |ui| {
            self.answer_ui(ui);
            if pinned {
                self.first_ui(ui, layout::PINNED);
            }
        });
        egui::CentralPanel::default().show(ui, |ui| {
            theme::scroll("explore").show(ui, |ui| {
                self.reasons_ui(ui);
                if pinned {
                    self.controls_ui(ui);
                    self.others_ui(ui);
                } else {
                    self.first_ui(ui, 220.0);
                    self.others_ui(ui);
                    self.controls_ui(ui);
                }
                self.numbers_ui(ui);
            });
        });
    }

    /// The plot over time.
    fn first_ui(&mut self, ui: &mut egui::Ui, height: f32) {
        match self.about() {
            About::Relay => self.time_ui(ui, height),
            About::OnOff => self.on_off.time_ui(ui, height),
            About::Servo => self.servo.position_ui(ui, height),
        }
    }

    /// The plots but that over time, beneath each other.
    fn others_ui(&mut self, ui: &mut egui::Ui) {
        match self.about() {
            About::Relay => {
                self.nyquist_ui(ui, 260.0);
                self.phase_ui(ui, 260.0);
            }
            About::OnOff => self.on_off.curves_ui(ui, 320.0),
            About::Servo => self.servo.others_ui(ui, 240.0),
        }
    }

    fn answer_ui(&self, ui: &mut egui::Ui) {
        match self.about() {
            About::Relay => {}
            About::OnOff => return self.on_off.answer_ui(ui),
            About::Servo => return self.servo.answer_ui(ui),
        }
        match self.finished.as_ref().map(|f| &f.data) {
            Some(Ok((data, _))) if self.is_current() => theme::answer_ui(ui, &data.text),
            Some(Ok((data, _))) => theme::answer_of_before_ui(ui, &data.text),
            Some(Err(error)) if self.is_current() => {
                ui.colored_label(ui.visuals().warn_fg_color, tr(error));
            }
            _ => theme::answer_ui(ui, "Computing ..."),
        }
    }

    /// What the answer rests on.
    fn reasons_ui(&self, ui: &mut egui::Ui) {
        match self.about() {
            About::Relay => {}
            About::OnOff => return self.on_off.reasons_ui(ui),
            About::Servo => return self.servo.reasons_ui(ui),
        }
        let Some((data, claims)) = self.data() else {
            return;
        };
        ui.label(tr(&data.stability));
        match self.figure {
            Some(number) => {
                if let Some(figure) = figures().into_iter().find(|f| f.number == number) {
                    claim_ui(ui, number, figure.title, figure.claim, claims);
                }
            }
            None => {
                ui.label(tr(&data.trust.text));
            }
        }
    }

    fn numbers_ui(&mut self, ui: &mut egui::Ui) {
        match self.about() {
            About::Relay => {
                if let Some((data, _)) = self.data() {
                    ui.separator();
                    table::predictions_ui(ui, &self.input, data);
                    table::harmonics_ui(ui, data);
                }
                if let Some(Finished {
                    asked,
                    data: Ok((data, _)),
                }) = &self.finished
                {
                    self.theory.ui(ui, &asked.input, data);
                }
                table::equations_ui(ui);
            }
            About::OnOff => self.on_off.numbers_ui(ui),
            About::Servo => self.servo.numbers_ui(ui),
        }
        self.open_ui(ui);
    }

    fn nyquist_ui(&mut self, ui: &mut egui::Ui, height: f32) {
        let Some(Ok((data, _))) = self.finished.as_ref().map(|f| &f.data) else {
            return;
        };
        let relay = &mut self.input.relay;
        let amplitude = relay_loop::swing_at(data, self.playback.clock);
        self.line_at = Some(self.nyquist.ui(ui, relay, data, amplitude, height));
    }

    fn phase_ui(&self, ui: &mut egui::Ui, height: f32) {
        if let Some((data, _)) = self.data() {
            relay_loop::phase_ui(ui, data, self.playback.clock, height);
        }
    }

    fn time_ui(&mut self, ui: &mut egui::Ui, height: f32) {
        let Some((data, _)) = self.data() else {
            return;
        };
        relay_loop::time_ui(ui, &self.input.relay, data, self.playback.clock, height);
    }
}
