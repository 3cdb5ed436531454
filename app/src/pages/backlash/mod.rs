//! How wide is the hidden gap? A drive under a relay that makes it drift, simulated or measured.

mod built_in;
mod controls;
mod design;
mod drift;
mod picture;
mod plots;
mod scene;
mod settings;
mod side;
mod structure;
mod units;
mod words;

use hysteron_core::drive::{Command, DriveInput, DriveJob, VelocityRelay, drifting_test, figures};
use hysteron_core::measurement::Kind;
use hysteron_core::message::Message;
use hysteron_core::msg;

use crate::desk::Desk;
use crate::page::{Hint, Offer, Page, View};
use crate::widgets::playback::Playback;
use built_in::BuiltIn;

use crate::export::Table;
use crate::files::{Files, Held};
use crate::hook::Targets;
use crate::jobs::Job;
use crate::language::tr;
use crate::layout;
use crate::recent::{Recents, measurement};
use crate::theme;
use crate::widgets::controls::claim_ui;
use design::Design;
use hysteron_work::content::Content;
use hysteron_work::reading::Reading;
use hysteron_work::tasks::{GapReport, GapTask, ReadTask};
use scene::{Scene, Shown};

/// Speed of the playback, times real time.
const SPEED: f64 = 0.1;

/// Time that a frame gives to the simulation, s.
const BUDGET: f64 = 1.5e-3;

/// Events between two looks at the clock.
const BATCH: usize = 200;

/// Width of the panel with the controls where there is room, points.
const SIDE: f32 = 380.0;

/// Height of the drawn masses, points.
const PICTURE: f32 = 112.0;
const LOW_PICTURE: f32 = 86.0;

/// The page: what is set, and what follows from it.
pub struct Backlash {
    input: DriveInput,
    /// Number of the figure whose claim is checked.
    figure: Option<u32>,
    /// Whether the drive is drawn as the block diagram of Fig. 8.
    structure: bool,
    design: Design,
    playback: Playback,
    /// Seconds of the drive in a second.
    speed: f64,
    /// The simulation that is under way, and for what.
    simulation: Option<(DriveInput, DriveJob)>,
    /// How long it has worked, s.
    worked: f64,
    /// The last one that was finished, or the measurement that is open.
    scene: Option<Scene>,
    /// The estimate that is under way, and for which simulation.
    estimation: Option<(Option<DriveInput>, Job<GapTask>)>,
    files: Files,
    /// Name of the measurement that is open, or about to be.
    file: Option<String>,
    /// The file that was opened last.
    last: Option<Held>,
    message: Option<Message>,
}

impl Default for Backlash {
    fn default() -> Self {
        Self {
            input: drifting_test(),
            figure: None,
            structure: false,
            design: Design::default(),
            playback: Playback::default(),
            speed: SPEED,
            simulation: None,
            worked: 0.0,
            scene: None,
            estimation: None,
            files: Files::default(),
            file: None,
            last: None,
            message: None,
        }
    }
}

impl Backlash {
    /// Whether a measurement is open, or about to be.
    fn measured(&self) -> bool {
        let opening = self.estimation.as_ref().is_some_and(|(of, _)| of.is_none());
        opening || self.scene.as_ref().is_some_and(|s| s.input().is_none())
    }

    /// Simulates for a part of a frame; the last result stays until the next is finished.
    fn simulate(&mut self, ctx: &egui::Context) {
        let known = self
            .scene
            .as_ref()
            .is_some_and(|s| s.input() == Some(&self.input));
        if self.simulation.is_none() && !known && !self.measured() && self.message.is_none() {
            match DriveJob::new(&self.input) {
                Ok(job) => {
                    self.simulation = Some((self.input, job));
                    self.worked = 0.0;
                }
                Err(error) => self.message = Some(error.into()),
            }
        }
        let Some((_, job)) = &mut self.simulation else {
            return;
        };
        let begin = web_time::Instant::now();
        let mut done = false;
        while !done && begin.elapsed().as_secs_f64() < BUDGET {
            done = job.advance(BATCH);
        }
        self.worked += begin.elapsed().as_secs_f64();
        if done && let Some((input, job)) = self.simulation.take() {
            self.scene = Some(Scene::simulated(input, job.finish(), self.figure));
        }
        ctx.request_repaint();
    }

    /// Has the gap of what is on the screen estimated, one estimate at a time.
    fn estimate(&mut self, ctx: &egui::Context) {
        if self.estimation.is_some() || self.simulation.is_some() {
            return;
        }
        if let Some(scene) = &self.scene
            && scene.estimate.is_none()
            && let Some(input) = scene.input()
            && *input == self.input
        {
            let task = GapTask::Simulated(Box::new(*input));
            self.estimation = Some((Some(*input), Job::run(ctx, task)));
        }
    }

    /// Opens a measurement; a bad one leaves everything as it was.
    fn open_as(&mut self, ctx: &egui::Context, name: &str, content: Content, reading: Reading) {
        self.open_held(
            ctx,
            Held {
                name: name.to_owned(),
                kind: Kind::Drive,
                content,
                reading,
            },
        );
    }

    fn open_held(&mut self, ctx: &egui::Context, file: Held) {
        if !measurement(&file.name) {
            self.message = Some(msg!(
                "{} is a model, which this page has no use for: open it in Compare, together with a measurement.",
                file.name
            ));
            return;
        }
        self.simulation = None;
        self.file = Some(file.name.clone());
        self.last = Some(file.clone());
        let task = GapTask::Measured(Box::new(ReadTask {
            file: file.name,
            content: file.content,
            reading: file.reading,
        }));
        self.estimation = Some((None, Job::run(ctx, task)));
        self.playback.clock = 0.0;
        self.message = None;
    }

    fn open_built_in(&mut self, ctx: &egui::Context, built_in: &BuiltIn) {
        self.open_held(ctx, Held::from(&built_in.file));
    }

    /// Takes what jobs and files have brought.
    fn take_news(&mut self, ctx: &egui::Context) {
        while let Some(arrival) = self.files.arrived() {
            let name = arrival.name;
            match arrival.bytes {
                Ok(bytes) => {
                    let content = Content::Plain(bytes.into());
                    self.open_as(ctx, &name, content, arrival.reading);
                }
                Err(error) => {
                    self.message = Some(msg!(
                        "{}: cannot be read ({})",
                        Message::name(name),
                        Message::name(error)
                    ));
                }
            }
        }
        let Some((of, job)) = &mut self.estimation else {
            return;
        };
        let Some(end) = job.end(|_, _| ()) else {
            return;
        };
        let of = *of;
        self.estimation = None;
        match (end, of, &mut self.scene) {
            (Ok(report), ..) => self.take_estimate(of.as_ref(), report),
            // Asked again, it would only fail again.
            (Err(error), Some(_), Some(scene)) => scene.estimate = Some(Err(error)),
            (Err(error), ..) => self.keep(error),
        }
    }

    fn take_estimate(&mut self, of: Option<&DriveInput>, report: GapReport) {
        match (report.measurement, &mut self.scene) {
            (Some(measurement), _) => match Scene::measured(&measurement, report.estimate) {
                Ok(scene) => {
                    self.scene = Some(scene);
                    self.file = self.open_file();
                    if let Some(last) = self.last.take() {
                        self.files.taken(&measurement.name, &last.reading);
                        self.files.hold(last);
                    }
                    self.figure = None;
                }
                Err(error) => self.keep(error),
            },
            (None, Some(scene)) if scene.input() == of => scene.estimate = Some(report.estimate),
            // It was about a simulation that is gone.
            (None, _) => {}
        }
    }

    /// Back to the simulation.
    fn close(&mut self) {
        self.scene = None;
        self.estimation = None;
        self.file = None;
        self.message = None;
    }

    /// Nothing came of a file: what was open before is.
    fn keep(&mut self, message: Message) {
        self.file = self.open_file();
        self.message = Some(message);
    }

    fn open_file(&self) -> Option<String> {
        self.scene.as_ref()?.file().map(str::to_owned)
    }

    /// Moves the playback on; at its end it begins again.
    fn play(&mut self, ui: &egui::Ui) {
        let Some(scene) = &self.scene else {
            return;
        };
        let end = scene.duration();
        self.playback.advance(ui, self.speed, end);
    }

    fn relay(&self) -> Option<VelocityRelay> {
        match self.input.command {
            Command::Relay(relay) => Some(relay),
            Command::Torque(_) => None,
        }
    }

    fn answer_ui(&mut self, ui: &mut egui::Ui) {
        if let Some(message) = self.message.clone() {
            ui.horizontal_wrapped(|ui| {
                theme::tell(&ui.colored_label(ui.visuals().warn_fg_color, tr(message)));
                if ui.small_button(tr("Dismiss")).clicked() {
                    self.message = None;
                }
            });
        }
        let Some(scene) = &self.scene else {
            let opening = self.estimation.is_some();
            theme::answer_ui(
                ui,
                if opening {
                    "Reading the measurement ..."
                } else {
                    "Simulating ..."
                },
            );
            return;
        };
        if scene.input().is_some_and(|shown| *shown != self.input) && self.simulation.is_some() {
            theme::answer_of_before_ui(ui, scene.answer());
        } else {
            theme::answer_ui(ui, scene.answer());
        }
    }

    /// What the answer rests on.
    fn reasons_ui(&self, ui: &mut egui::Ui) {
        let Some(scene) = &self.scene else {
            return;
        };
        if let Some(why) = scene.refusal() {
            ui.label(tr(why));
        }
        match (self.figure, &scene.shown) {
            (Some(number), Shown::Simulated(simulated)) => {
                if let Some(figure) = figures().into_iter().find(|f| f.number == number) {
                    claim_ui(ui, number, figure.title, figure.claim, &simulated.checks);
                }
            }
            _ => {
                ui.label(tr(&scene.lesson));
            }
        }
    }

    /// Whether the block diagram is asked for and known: a measured load has no momentum.
    fn shows_structure(&self, scene: &Scene) -> bool {
        self.structure && scene.input().is_some()
    }

    /// The masses, or the diagram of their blocks.
    fn picture_ui(&self, ui: &mut egui::Ui, scene: &Scene) {
        if self.shows_structure(scene) {
            structure::ui(ui, scene, self.playback.clock);
        } else {
            let low = theme::is_low(ui.ctx());
            let height = if low { LOW_PICTURE } else { PICTURE };
            picture::ui(ui, scene, self.playback.clock, height);
        }
    }

    /// The two plots that go with that.
    fn beside(&self, scene: &Scene) -> [fn(&mut egui::Ui, &Scene, f64, f32); 2] {
        if self.shows_structure(scene) {
            [structure::distance_ui, structure::momentum_ui]
        } else {
            [plots::phase_ui, plots::map_ui]
        }
    }

    fn wide_ui(&mut self, ui: &mut egui::Ui, recent: &Recents, targets: &mut Targets) {
        egui::Panel::left("drive")
            .exact_size(layout::side(ui, SIDE))
            .resizable(false)
            .show(ui, |ui| {
                theme::scroll("backlash_side").show(ui, |ui| self.side_ui(ui, recent, targets));
            });
        egui::CentralPanel::default().show(ui, |ui| {
            // Large type leaves less room than the plots need.
            theme::scroll("backlash").show(ui, |ui| {
                self.answer_ui(ui);
                self.reasons_ui(ui);
                self.playback_ui(ui, targets);
                let Some(scene) = &self.scene else {
                    return;
                };
                let clock = self.playback.clock;
                self.picture_ui(ui, scene);
                let height = (0.5 * ui.available_height() - 34.0).max(120.0);
                plots::time_ui(ui, scene, clock, height);
                let [left, right] = self.beside(scene);
                if layout::room_for_two(ui) {
                    ui.columns(2, |columns| {
                        left(&mut columns[0], scene, clock, height);
                        right(&mut columns[1], scene, clock, height);
                    });
                } else {
                    left(ui, scene, clock, height);
                    right(ui, scene, clock, height);
                }
            });
        });
    }

    fn narrow_ui(&mut self, ui: &mut egui::Ui, recent: &Recents, targets: &mut Targets) {
        // The answer and one plot stay in view while a slider below them is turned.
        let pinned = layout::pins(ui);
        if pinned {
            egui::Panel::top("backlash_answer").show(ui, |ui| {
                self.answer_ui(ui);
                if let Some(scene) = &self.scene {
                    plots::time_ui(ui, scene, self.playback.clock, layout::PINNED);
                }
            });
        }
        egui::CentralPanel::default().show(ui, |ui| {
            theme::scroll("backlash").show(ui, |ui| {
                if !pinned {
                    self.answer_ui(ui);
                }
                self.reasons_ui(ui);
                self.playback_ui(ui, targets);
                if let Some(scene) = &self.scene {
                    self.picture_ui(ui, scene);
                }
                if pinned {
                    self.side_ui(ui, recent, targets);
                }
                if let Some(scene) = &self.scene {
                    if !pinned {
                        plots::time_ui(ui, scene, self.playback.clock, 220.0);
                    }
                    for plot_ui in self.beside(scene) {
                        plot_ui(ui, scene, self.playback.clock, 240.0);
                    }
                }
                if !pinned {
                    self.side_ui(ui, recent, targets);
                }
            });
        });
    }
}

/// The page as the registry has it.
pub fn page() -> Page {
    let mut view = Backlash::default();
    let door = view.files.door("Drop the measurement here to find its gap");
    Page::new("backlash", "Backlash", view).with_door(door)
}

impl View for Backlash {
    fn update(&mut self, ctx: &egui::Context) {
        self.take_news(ctx);
    }

    fn ui(&mut self, ui: &mut egui::Ui, desk: &mut Desk) {
        self.simulate(ui.ctx());
        self.estimate(ui.ctx());
        if std::mem::take(&mut desk.play) {
            self.playback.toggle(ui.ctx());
        }
        self.play(ui);
        if ui.available_width() < layout::NARROW {
            self.narrow_ui(ui, &desk.recent, &mut desk.targets);
        } else {
            self.wide_ui(ui, &desk.recent, &mut desk.targets);
        }
    }

    fn hook_state(&self) -> serde_json::Value {
        let scene = self.scene.as_ref();
        let estimate = scene.and_then(|s| s.estimate.as_ref()?.as_ref().ok());
        let simulated = scene.and_then(Scene::simulation);
        serde_json::json!({
            "busy": self.simulation.is_some() || self.estimation.is_some(),
            "message": self.message,
            "figure": self.figure,
            "checks": simulated.map(|s| s.checks.iter().map(|c| c.holds).collect::<Vec<_>>()),
            "answer": scene.map(Scene::answer),
            "lesson": scene.map(|s| s.lesson.clone()),
            "file": scene.and_then(|s| s.file()),
            "gap": 2.0 * self.input.drive.half_gap,
            "gap_by_positions": simulated.and_then(|s| s.summary.gap()),
            "gap_estimated": estimate.and_then(|e| e.gap),
            "direction": simulated.zip(self.relay()).and_then(|(s, r)| s.summary.direction(&r)),
            "motor_coulomb": self.input.drive.motor.coulomb,
            "clock": self.playback.clock,
            "times_real_time": simulated.map(|_| self.input.duration / self.worked),
            "playing": self.playback.playing,
        })
    }

    fn offer(&self) -> Offer<'_> {
        Offer::new(self.hint(), self.table_names(), || self.tables())
    }
}

impl Backlash {
    /// What to try next.
    fn hint(&self) -> Hint {
        if self.measured() {
            return Hint {
                sentence: "Is the gap all that is missing? Drop the file on Compare too.".into(),
                commands: vec![crate::command::Command::Go("compare")],
            };
        }
        let motor = &self.input.drive.motor;
        let drifts = motor.coulomb > 0.0 || motor.viscous > 0.0;
        if drifts {
            Hint::open(
                "Take friction and delay away: then no asymmetry makes it drift.",
                "v1;backlash;backlash.run.drive.motor.coulomb=0;backlash.run.drive.motor.viscous=0;backlash.run.command.relay.relay.delay=0",
            )
        } else {
            Hint::open(
                "Put friction and delay back: with them an asymmetric relay drifts through the gap.",
                "v1;backlash",
            )
        }
    }

    /// Names of the tables that can be given now.
    fn table_names(&self) -> Vec<&'static str> {
        self.scene.iter().map(|_| "drive").collect()
    }

    /// The numbers behind what is shown.
    fn tables(&self) -> Vec<Table> {
        let Some(run) = self.scene.as_ref().map(|s| &s.run) else {
            return Vec::new();
        };
        let mut table = Table::new("drive").with("t [s]", run.time.iter().copied());
        for (title, values) in [
            ("u [N m]", &run.input),
            ("x1 [rad]", &run.x1),
            ("v1 [rad/s]", &run.v1),
            ("x2 [rad]", &run.x2),
        ] {
            // The load of a measured drive may be unknown.
            if values.len() == run.time.len() {
                table = table.with(title, values.iter().copied());
            }
        }
        vec![table]
    }
}
