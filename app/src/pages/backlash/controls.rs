//! What can be set: figure, relay, gap, masses, contact, playback.

use hysteron_core::drive::{Command, Contact, drifting_test, figures};
use hysteron_core::msg;

use super::units::MILLI;
use super::{Backlash, SPEED};
use crate::hook::Targets;
use crate::language::{tr, tr_number};
use crate::recent::Recents;
use crate::widgets::controls::{asymmetry_slider, reset_asked, slider};
use crate::widgets::typed::{DECIMALS, Typed};

/// Width below which the playback stands in two rows, points.
const NARROW_PLAYBACK: f32 = 520.0;

/// The figure that is the block diagram.
const STRUCTURE: u32 = 8;

/// Values that a contact begins with when its kind is chosen.
const STIFFNESS: f64 = 1500.0;
const DAMPING: f64 = 0.2;

impl Backlash {
    pub(super) fn controls_ui(
        &mut self,
        ui: &mut egui::Ui,
        recent: &Recents,
        targets: &mut Targets,
    ) {
        let before = self.input;
        self.figures_ui(ui, targets);
        self.lesson_ui(ui);
        self.files_ui(ui, recent, targets);
        ui.separator();
        self.relay_ui(ui);
        egui::CollapsingHeader::new(tr("Design a drifting test")).show(ui, |ui| {
            if self.design.ui(ui, &mut self.input) {
                self.playback.clock = 0.0;
            }
        });
        self.gap_ui(ui);
        self.masses_ui(ui);
        ui.small(tr("Double-click a slider to reset it."));
        if self.input != before {
            self.message = None;
        }
    }

    /// The paper's figures, one click each.
    fn figures_ui(&mut self, ui: &mut egui::Ui, targets: &mut Targets) {
        ui.horizontal_wrapped(|ui| {
            ui.label(tr("Paper:"));
            for figure in figures() {
                let chosen = self.figure == Some(figure.number);
                let button = ui
                    .add(egui::Button::new(tr(msg!("Fig. {}", figure.number))).selected(chosen))
                    .on_hover_text(tr(msg!("{}: {}", figure.title, figure.claim)));
                targets.note(format!("gap:figure-{}", figure.number), ui, &button);
                if button.clicked() {
                    self.scene = None;
                    self.figure = (!chosen).then_some(figure.number);
                    if !chosen {
                        self.input = figure.input;
                        self.playback.clock = 0.0;
                        self.structure = figure.number == STRUCTURE;
                    }
                }
            }
        });
    }

    fn relay_ui(&mut self, ui: &mut egui::Ui) {
        ui.strong(tr("Relay on the motor's velocity"));
        let normal = drifting_test();
        let (Command::Relay(relay), Command::Relay(usual)) =
            (&mut self.input.command, normal.command)
        else {
            return;
        };
        let r = &mut relay.relay;
        slider(
            ui,
            &mut r.gain,
            usual.relay.gain,
            1.0,
            0.05..=2.0,
            "gain k [N m]",
        )
        .on_hover_text(tr("How strongly the relay pushes"));
        asymmetry_slider(ui, &mut r.asymmetry, usual.relay.asymmetry);
        slider(
            ui,
            &mut r.hysteresis,
            usual.relay.hysteresis,
            1.0,
            0.05..=8.0,
            "hysteresis ε [rad/s]",
        )
        .on_hover_text(tr("Speed at which the relay reverses the push"));
        slider(ui, &mut r.delay, 0.0, 1e3, 0.0..=2.0, "delay [ms]")
            .on_hover_text(tr("How long after a switch the push changes"));
        let mut flip = relay.flip.unwrap_or(0.0);
        let before = flip;
        slider(
            ui,
            &mut flip,
            usual.flip.unwrap_or(0.0),
            1.0,
            0.0..=5.0,
            "reverse every [s]",
        )
        .on_hover_text(tr(
            "How often the asymmetry changes sign, so that the drift reverses; 0 for never",
        ));
        if flip != before {
            relay.flip = (flip > 0.0).then_some(flip.max(0.01));
        }
        slider(
            ui,
            &mut self.input.duration,
            normal.duration,
            1.0,
            0.2..=20.0,
            "duration [s]",
        );
    }

    fn gap_ui(&mut self, ui: &mut egui::Ui) {
        ui.strong(tr("Gap and contact"));
        let normal = drifting_test().drive;
        let drive = &mut self.input.drive;
        slider(
            ui,
            &mut drive.half_gap,
            normal.half_gap,
            MILLI,
            0.5..=20.0,
            "half gap β [mrad]",
        );
        ui.horizontal(|ui| {
            let rigid = matches!(drive.contact, Contact::Rigid { .. });
            if ui.radio(rigid, tr("rigid")).clicked() && !rigid {
                drive.contact = normal.contact;
            }
            if ui.radio(!rigid, tr("compliant")).clicked() && rigid {
                drive.contact = Contact::Compliant {
                    stiffness: STIFFNESS,
                    damping: DAMPING,
                };
            }
        });
        match &mut drive.contact {
            Contact::Rigid { restitution } => {
                slider(ui, restitution, 1.0, 1.0, 0.0..=1.0, "restitution")
                    .on_hover_text(tr("Fraction of the impact speed at which they part again"));
            }
            Contact::Compliant { stiffness, damping } => {
                slider(
                    ui,
                    stiffness,
                    STIFFNESS,
                    1.0,
                    50.0..=20_000.0,
                    "stiffness [N m/rad]",
                );
                slider(ui, damping, DAMPING, 1.0, 0.0..=2.0, "damping [N m s/rad]");
            }
        }
        slider(
            ui,
            &mut drive.adhesion.upper,
            0.0,
            1.0,
            0.0..=0.2,
            "adhesion, upper [N m]",
        )
        .on_hover_text(tr(
            "Pull that the upper contact withstands before it lets go (adhesion)",
        ));
        slider(
            ui,
            &mut drive.adhesion.lower,
            0.0,
            1.0,
            0.0..=0.2,
            "adhesion, lower [N m]",
        );
    }

    fn masses_ui(&mut self, ui: &mut egui::Ui) {
        let normal = drifting_test().drive;
        let drive = &mut self.input.drive;
        for (name, body, usual) in [
            ("Motor", &mut drive.motor, normal.motor),
            ("Load", &mut drive.load, normal.load),
        ] {
            ui.strong(tr(name));
            slider(
                ui,
                &mut body.inertia,
                usual.inertia,
                1e6,
                100.0..=5000.0,
                "inertia [kg mm²]",
            );
            slider(
                ui,
                &mut body.coulomb,
                usual.coulomb,
                1.0,
                0.0..=0.2,
                "Coulomb friction [N m]",
            );
            slider(
                ui,
                &mut body.viscous,
                usual.viscous,
                1e3,
                0.0..=20.0,
                "viscous [mN m s/rad]",
            );
        }
    }

    /// Play, pause, step and speed; the speed beneath where the window is narrow.
    pub(super) fn playback_ui(&mut self, ui: &mut egui::Ui, targets: &mut Targets) {
        let narrow = ui.available_width() < NARROW_PLAYBACK;
        ui.horizontal(|ui| {
            let label = self.playback.label(ui.ctx());
            let button = ui.button(tr(label));
            targets.note("gap:play", ui, &button);
            if button.clicked() {
                self.playback.toggle(ui.ctx());
            }
            if ui
                .button(tr("Step"))
                .on_hover_text(tr("To the next event"))
                .clicked()
            {
                self.playback.playing = false;
                self.step_to_next_event();
            }
            if ui.button(tr("From the start")).clicked() {
                self.playback.clock = 0.0;
            }
            if !self.measured() {
                let blocks = ui
                    .selectable_label(self.structure, tr("Blocks"))
                    .on_hover_text(tr("The two-mass structure as a block diagram, with d and the momentum over time"));
                if blocks.clicked() {
                    self.structure = !self.structure;
                }
            }
            if !narrow {
                self.speed_ui(ui);
            }
        });
        if narrow {
            ui.horizontal(|ui| self.speed_ui(ui));
        }
    }

    fn speed_ui(&mut self, ui: &mut egui::Ui) {
        let speed = Typed::new(self.speed, "x", 0.001..=2.0, DECIMALS)
            .slider(ui.ctx(), &mut self.speed)
            .logarithmic(true)
            .suffix(" x");
        let speed = ui.add(speed);
        if reset_asked(ui, &speed) {
            self.speed = SPEED;
        }
        speed.on_hover_text(tr("Playback speed as a multiple of real time"));
        ui.label(tr_number(format!("t = {:.4} s", self.playback.clock)));
    }

    fn step_to_next_event(&mut self) {
        let Some(scene) = &self.scene else {
            return;
        };
        let run = &scene.run;
        let after = self.playback.clock + 1e-9;
        // A measurement has no events: it goes from sample to sample.
        let next = if run.events.is_empty() {
            let next = run.time.partition_point(|t| *t <= after);
            run.time.get(next).copied()
        } else {
            let next = run.events.partition_point(|e| e.time <= after);
            run.events.get(next).map(|e| e.time)
        };
        if let Some(time) = next {
            self.playback.clock = time;
        }
    }
}
