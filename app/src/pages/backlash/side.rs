//! The panel beside the plots: a measurement that is open, or what can be set.

use hysteron_core::backlash::GapEstimate;
use hysteron_core::drive::{Command, drifting_test};
use hysteron_core::msg;

use super::Backlash;
use super::built_in::BUILT_IN;
use super::units::MILLI;
use crate::files::MEASUREMENT;
use crate::hook::Targets;
use crate::language::{tr, tr_number, tr_sentence};
use crate::motion;
use crate::recent::{Recents, measurement};

/// Crossings that are listed.
const LISTED: usize = 12;

/// Length of the sliders, points: their labels stand beside them.
const SLIDER: f32 = 120.0;

/// Friction and delay of the lesson about the direction of drift.
const LESSON_FRICTION: f64 = 0.03;
const LESSON_DELAY: f64 = 2e-4;

impl Backlash {
    /// The panel beside the plots.
    pub(super) fn side_ui(&mut self, ui: &mut egui::Ui, recent: &Recents, targets: &mut Targets) {
        ui.add_space(4.0);
        ui.spacing_mut().slider_width = SLIDER;
        if self.measured() {
            self.measurement_ui(ui, recent, targets);
        } else {
            self.controls_ui(ui, recent, targets);
        }
    }

    /// What is open, and the way back.
    fn measurement_ui(&mut self, ui: &mut egui::Ui, recent: &Recents, targets: &mut Targets) {
        let name = self.scene.as_ref().and_then(|s| s.file());
        ui.strong(name.map_or_else(|| tr("Reading ..."), str::to_owned));
        if let Some(verdict) = self.scene.as_ref().and_then(|s| s.verdict()) {
            ui.label(tr_sentence(verdict));
        }
        if self.estimation.is_some() {
            motion::busy_ui(ui);
        }
        if let Some(Ok(estimate)) = self.scene.as_ref().and_then(|s| s.estimate.as_ref()) {
            traverses_ui(ui, estimate);
        }
        let back = ui.button(tr("Back to the simulation"));
        targets.note("gap:back", ui, &back);
        if back.clicked() {
            self.close();
        }
        ui.separator();
        self.files_ui(ui, recent, targets);
    }

    pub(super) fn files_ui(&mut self, ui: &mut egui::Ui, recent: &Recents, targets: &mut Targets) {
        ui.strong(tr("Measured drifting tests"));
        let mut chosen = None;
        ui.horizontal_wrapped(|ui| {
            for built_in in &BUILT_IN {
                let button = ui
                    .button(tr(msg!("Open {}", built_in.file.id)))
                    .on_hover_text(tr(built_in.story));
                targets.note(format!("gap:{}", built_in.file.id), ui, &button);
                if button.clicked() {
                    chosen = Some(built_in);
                }
            }
            if ui
                .button(tr("Open a file ..."))
                .on_hover_text(tr(
                    "Or drop it on this window: t [s],u [N m],x1 [rad],v1 [rad/s]",
                ))
                .clicked()
            {
                self.files.entrance.open_dialog(ui.ctx(), MEASUREMENT);
            }
        });
        if let Some(recent) = recent.ui(ui, measurement, targets) {
            self.files.entrance.reopen(ui.ctx(), &recent);
        }
        if let Some(built_in) = chosen {
            self.open_built_in(ui.ctx(), built_in);
        }
    }

    /// The direction of drift, with one effect at a time.
    pub(super) fn lesson_ui(&mut self, ui: &mut egui::Ui) {
        ui.horizontal_wrapped(|ui| {
            ui.label(tr("Drift by:")).on_hover_text(tr(
                "Which way does it drift? The direction reveals which effect is at work",
            ));
            for (name, friction, delay) in [
                ("friction alone", LESSON_FRICTION, 0.0),
                ("delay alone", 0.0, LESSON_DELAY),
                ("neither", 0.0, 0.0),
            ] {
                if ui.button(tr(name)).clicked() {
                    self.figure = None;
                    self.playback.clock = 0.0;
                    self.input = drifting_test();
                    self.input.drive.motor.coulomb = friction;
                    self.input.drive.motor.viscous = 0.0;
                    if let Command::Relay(relay) = &mut self.input.command {
                        relay.relay.delay = delay;
                    }
                }
            }
        });
    }
}

/// The gap by every crossing.
fn traverses_ui(ui: &mut egui::Ui, estimate: &GapEstimate) {
    if estimate.traverses.is_empty() {
        return;
    }
    egui::Grid::new("traverses")
        .striped(true)
        .num_columns(3)
        .show(ui, |ui| {
            for title in ["left at [s]", "reached at [s]", "gap [mrad]"] {
                ui.strong(tr(title));
            }
            ui.end_row();
            for t in estimate.traverses.iter().take(LISTED) {
                ui.label(tr_number(format!("{:.3}", t.from.time)));
                ui.label(tr_number(format!("{:.3}", t.to.time)));
                ui.label(tr_number(format!(
                    "{:.2} ± {:.2}",
                    MILLI * t.gap,
                    MILLI * t.std_error
                )));
                ui.end_row();
            }
        });
}
