//! Which relay should one use on a drive that is known only roughly?

use hysteron_core::drive::{Command, DriftingTest, DriveInput, RoughDrive, design_drifting_test};
use hysteron_core::message::Message;
use hysteron_core::message::fixed;
use hysteron_core::msg;

use super::units::MILLI;
use crate::language::tr;
use crate::widgets::controls::reset_asked;
use crate::widgets::typed::{DECIMALS, Typed};

/// What is asked for, and the last proposal.
pub struct Design {
    /// Expected gap, rad, and the largest torque, N m.
    pub gap: f64,
    pub torque: f64,
    proposal: Option<Result<DriftingTest, Message>>,
}

impl Default for Design {
    fn default() -> Self {
        Self {
            gap: 0.02,
            torque: 0.7,
            proposal: None,
        }
    }
}

impl Design {
    /// Inputs, a button, and what was proposed; true where the drive was given a new relay.
    pub fn ui(&mut self, ui: &mut egui::Ui, input: &mut DriveInput) -> bool {
        let Command::Relay(relay) = input.command else {
            return false;
        };
        let mut shown = MILLI * self.gap;
        let gap = Typed::new(shown, "mrad", 0.5..=100.0, DECIMALS)
            .slider(ui.ctx(), &mut shown)
            .logarithmic(true)
            .text(tr("expected gap [mrad]"));
        let gap = ui.add(gap);
        if reset_asked(ui, &gap) {
            self.gap = Self::default().gap;
        } else if gap.changed() {
            self.gap = shown / MILLI;
        }
        let torque = Typed::new(self.torque, "N m", 0.01..=5.0, DECIMALS)
            .slider(ui.ctx(), &mut self.torque)
            .logarithmic(true)
            .text(tr("largest torque [N m]"));
        let torque = ui.add(torque);
        if reset_asked(ui, &torque) {
            self.torque = Self::default().torque;
        }
        let mut changed = false;
        let button = ui.button(tr("Propose a drifting test")).on_hover_text(tr(
            "For inertia, friction and delay as set on this page, each known only roughly",
        ));
        if button.clicked() {
            let rough = RoughDrive {
                motor: input.drive.motor,
                load_coulomb: input.drive.load.coulomb,
                delay: relay.relay.delay,
                gap: self.gap,
                torque: self.torque,
                sampling: None,
                velocity_noise: 2e-3,
            };
            let proposal = design_drifting_test(&rough).map_err(Message::from);
            if let Ok(test) = &proposal {
                let mut proposed = test.relay;
                // What runs here is the ideal relay; a controller should sample so fast.
                proposed.sampling = None;
                input.command = Command::Relay(proposed);
                input.duration = test.duration;
                changed = true;
            }
            self.proposal = Some(proposal);
        }
        match &self.proposal {
            Some(Ok(test)) => proposal_ui(ui, test),
            Some(Err(error)) => {
                ui.colored_label(ui.visuals().warn_fg_color, tr(error));
            }
            None => {}
        }
        changed
    }
}

fn proposal_ui(ui: &mut egui::Ui, test: &DriftingTest) {
    let relay = test.relay.relay;
    ui.label(tr(msg!(
        "k = {} N m, a = {}, ε = {} rad/s, {} ms of added delay, reversed every {} s, sampled every {} ms or faster.",
        fixed(relay.gain, 3),
        fixed(relay.asymmetry, 2),
        fixed(relay.hysteresis, 3),
        fixed(1e3 * test.added_delay, 2),
        fixed(test.relay.flip.unwrap_or(0.0), 1),
        fixed(1e3 * test.relay.sampling.unwrap_or(0.0), 2)
    )));
    ui.label(tr(msg!(
        "The cycle swings over {} mrad in {} ms and crosses the gap in {} s at most.",
        fixed(MILLI * test.cycle.swing, 2),
        fixed(1e3 * test.cycle.period, 2),
        fixed(test.traverse, 1)
    )));
    for warning in &test.warnings {
        ui.colored_label(ui.visuals().warn_fg_color, tr(warning));
    }
}
