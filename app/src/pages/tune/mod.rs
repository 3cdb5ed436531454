//! How is a controller tuned from a relay experiment? Step by step, from the relay to the tuned loop.

mod adaptation;
mod controls;
mod draw;
mod loops;
mod measured;
mod model;
mod oscillation;
mod rules;
mod settings;
mod stage;
mod ultimate;

use hysteron_core::message::Message;
use hysteron_core::relay::Relay;
use hysteron_core::tuning::TuningInput;

use crate::command::Command;
use crate::desk::Desk;
use crate::export::Table;
use crate::language::tr;
use crate::layout;
use crate::live::Live;
use crate::motion;
use crate::page::{Hint, Offer, Page, View};
use crate::theme;
use hysteron_work::tasks::TuneTask;
use measured::{From, Measured};
use stage::{Seen, Stage};

/// The experiment, in its order.
const STAGES: [Stage; 6] = [
    oscillation::STAGE,
    ultimate::STAGE,
    adaptation::STAGE,
    model::STAGE,
    rules::STAGE,
    loops::STAGE,
];

/// The page: what is set, what was last computed, and the step in view.
pub struct Tune {
    input: TuningInput,
    /// Asymmetry of the asymmetric test; the loop of the other pages may have none.
    asymmetry: f64,
    stage: usize,
    live: Live<TuningInput, TuneTask>,
    /// A test that was measured, where that is wanted.
    measured: Measured,
}

impl Default for Tune {
    fn default() -> Self {
        let input = TuningInput::default();
        Self {
            asymmetry: input.relay.asymmetry,
            input,
            stage: 0,
            live: Live::default(),
            measured: Measured::default(),
        }
    }
}

/// The page as the registry has it.
pub fn page() -> Page {
    let mut view = Tune::default();
    let door = (view.measured.files)
        .door("Drop the record of a relay test, or the log of an auto-tuner, to get gains from it");
    Page::new("tune", "Tune", view).with_own_door(door)
}

impl View for Tune {
    fn update(&mut self, _ctx: &egui::Context) {
        self.measured.update();
        self.live.update();
    }

    fn ui(&mut self, ui: &mut egui::Ui, desk: &mut Desk) {
        if ui.available_width() < layout::NARROW {
            self.narrow_ui(ui, desk);
            return;
        }
        egui::Panel::left("tuning")
            .exact_size(layout::side(ui, 350.0))
            .resizable(false)
            .show(ui, |ui| {
                theme::scroll("tune_side").show(ui, |ui| {
                    ui.add_space(4.0);
                    self.measured.source_ui(ui, desk);
                    ui.separator();
                    self.side_ui(ui, desk);
                });
            });
        egui::CentralPanel::default().show(ui, |ui| {
            theme::scroll("tune").show(ui, |ui| {
                let height = (ui.max_rect().bottom() - ui.cursor().top() - 190.0).max(280.0);
                self.main_ui(ui, desk, false, height);
            });
        });
    }

    fn hook_state(&self) -> serde_json::Value {
        if self.is_measured() {
            return self.measured.state();
        }
        let stage = STAGES.get(self.stage);
        serde_json::json!({
            "busy": self.live.is_busy(),
            "step": stage.map(|s| s.id),
            "rule": self.input.rule,
            "answer": self.answer(),
            "message": self.live.message(),
        })
    }

    fn offer(&self) -> Offer<'_> {
        if self.is_measured() {
            return self.measured.offer();
        }
        Offer::new(self.hint(), self.table_names(), || self.tables())
    }
}

impl Tune {
    /// What to try next.
    fn hint(&self) -> Option<Hint> {
        let stage = STAGES.get(self.stage)?;
        let command = STAGES
            .get(self.stage + 1)
            .map_or(Command::Go("backlash"), |next| {
                Command::Set("tune", "step", serde_json::json!(next.id))
            });
        Some(Hint {
            sentence: stage.next.into(),
            commands: vec![command],
        })
    }

    /// Names of the tables that can be given now.
    fn table_names(&self) -> Vec<&'static str> {
        match self.seen(false) {
            None => Vec::new(),
            Some(seen) if self.shows_loops() => loops::table_names(seen.report),
            Some(_) => vec!["relay test", "relay input", "true Nyquist curve"],
        }
    }

    /// The numbers behind what is shown.
    fn tables(&self) -> Vec<Table> {
        let Some(seen) = self.seen(false) else {
            return Vec::new();
        };
        if self.shows_loops() {
            return loops::tables(seen.report);
        }
        let run = &seen.report.test.run;
        let [input, nyquist] = [&run.input, &seen.report.nyquist];
        vec![
            Table::new("relay test")
                .with("time [s]", run.time.iter().copied())
                .with("output y", run.output.iter().copied()),
            Table::curve("relay input", ["time [s]", "input u"], input),
            Table::curve(
                "true Nyquist curve",
                ["real part", "imaginary part"],
                nyquist,
            ),
        ]
    }
}

impl Tune {
    /// Whether the test is not simulated.
    fn is_measured(&self) -> bool {
        self.measured.from != From::Simulation
    }

    fn narrow_ui(&mut self, ui: &mut egui::Ui, desk: &mut Desk) {
        // The answer and one plot stay in view while a slider below them is turned.
        let measured = self.is_measured();
        let shows = if measured {
            self.measured.has_plot()
        } else {
            self.seen(true).is_some()
        };
        let room = layout::pins(ui);
        let pinned = room && shows;
        if pinned {
            egui::Panel::top("tune_answer").show(ui, |ui| {
                if measured {
                    self.measured.pinned_ui(ui, layout::PINNED);
                } else {
                    self.pinned_ui(ui, layout::PINNED);
                }
            });
        }
        egui::CentralPanel::default().show(ui, |ui| {
            theme::scroll("tune").show(ui, |ui| {
                self.measured.source_ui(ui, desk);
                let name = if measured {
                    "Test and gains"
                } else {
                    "Plant, relay and specifications"
                };
                if pinned && !measured {
                    self.steps_ui(ui, desk);
                }
                egui::CollapsingHeader::new(tr(name))
                    .default_open(room)
                    .show(ui, |ui| self.side_ui(ui, desk));
                self.main_ui(ui, desk, pinned, 520.0);
            });
        });
    }

    fn side_ui(&mut self, ui: &mut egui::Ui, desk: &mut Desk) {
        if self.is_measured() {
            self.measured.side_ui(ui, desk);
        } else {
            self.controls_ui(ui, desk);
        }
    }

    fn main_ui(&mut self, ui: &mut egui::Ui, desk: &mut Desk, pinned: bool, height: f32) {
        if self.is_measured() {
            self.measured.ask(ui.ctx());
            self.measured.ui(ui, &mut desk.targets, pinned, height);
            return;
        }
        self.ask(ui.ctx(), desk);
        if !pinned {
            self.steps_ui(ui, desk);
        }
        self.stage_ui(ui, pinned, height);
    }

    /// Whether the step in view is that of the closed loops.
    fn shows_loops(&self) -> bool {
        let stage = STAGES.get(self.stage);
        stage.is_some_and(|s| s.id == loops::STAGE.id)
    }

    /// Starts the experiment where something was changed and none runs: so a slider that is dragged
    /// shows every experiment that could be finished meanwhile.
    fn ask(&mut self, ctx: &egui::Context, desk: &Desk) {
        self.input.plant.clone_from(&desk.relay_loop.plant);
        self.input.relay = Relay {
            asymmetry: self.asymmetry,
            ..desk.relay_loop.relay
        };
        self.live.ask(ctx, &self.input, TuneTask);
    }

    fn seen(&self, pinned: bool) -> Option<Seen<'_>> {
        let (input, report) = self.live.shown()?;
        Some(Seen {
            input,
            report,
            pinned,
        })
    }

    fn answer(&self) -> Option<Message> {
        let stage = STAGES.get(self.stage)?;
        self.seen(false).map(stage.answer)
    }

    /// The steps as buttons, and the one to the next.
    fn steps_ui(&mut self, ui: &mut egui::Ui, desk: &mut Desk) {
        ui.horizontal_wrapped(|ui| {
            for (index, stage) in STAGES.iter().enumerate() {
                let text = format!("{} {}", index + 1, tr(stage.title));
                let button = ui.selectable_label(self.stage == index, text);
                desk.targets.note(format!("step:{}", stage.id), ui, &button);
                if button.clicked() {
                    self.stage = index;
                }
            }
            if self.stage + 1 < STAGES.len() && ui.button(tr("Next step")).clicked() {
                self.stage += 1;
            }
            if self.live.is_busy() {
                motion::busy_ui(ui);
            }
        });
    }

    /// The answer and the plot of the step that stay in view.
    fn pinned_ui(&self, ui: &mut egui::Ui, height: f32) {
        let stage = STAGES.get(self.stage);
        if let Some((stage, seen)) = stage.zip(self.seen(true)) {
            self.answer_ui(ui, stage, seen);
            (stage.plot)(ui, seen, height);
        }
    }

    fn answer_ui(&self, ui: &mut egui::Ui, stage: &Stage, seen: Seen<'_>) {
        let answer = (stage.answer)(seen);
        if self.live.is_busy() && *seen.input != self.input {
            theme::answer_of_before_ui(ui, &answer);
        } else {
            theme::answer_ui(ui, &answer);
        }
    }

    fn stage_ui(&mut self, ui: &mut egui::Ui, pinned: bool, height: f32) {
        if let Some(message) = self.live.message() {
            ui.colored_label(ui.visuals().warn_fg_color, tr(message));
        }
        let Some(stage) = STAGES.get(self.stage) else {
            return;
        };
        ui.label(tr(stage.question));
        let Some((input, report)) = self.live.shown() else {
            let waits = self.live.message().is_none();
            let text = if waits {
                "The experiment runs ..."
            } else {
                "There is nothing to tune from yet: try another plant or relay."
            };
            theme::answer_ui(ui, text);
            return;
        };
        let seen = Seen {
            input,
            report,
            pinned,
        };
        if !pinned {
            self.answer_ui(ui, stage, seen);
        }
        (stage.ui)(ui, seen, height, &mut self.input.rule);
    }
}
