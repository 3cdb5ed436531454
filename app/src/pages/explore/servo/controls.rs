//! What can be set of a servo.

use super::settings::Settings;
use crate::language::tr;
use crate::widgets::controls::slider;

/// Values that are shown in other units than they are kept in.
const MILLI: f64 = 1e3;
const DEGREES: f64 = 180.0 / std::f64::consts::PI;
const SQUARE_MM: f64 = 1e6;

/// Part of its range below which no value comes that must be above 0.
const LEAST: f64 = 1e-3;

/// How far the sliders go.
#[derive(Default)]
pub struct Controls {
    /// What was set from elsewhere: a value there that is larger than usual has room on its slider.
    put: Settings,
}

impl Controls {
    /// Has the sliders reach as far as these values need them.
    pub fn fit(&mut self, set: &Settings) {
        self.put = set.clone();
    }

    pub fn ui(&self, ui: &mut egui::Ui, set: &mut Settings) {
        self.controller_ui(ui, set);
        self.friction_ui(ui, set);
        self.play_ui(ui, set);
        egui::CollapsingHeader::new(tr("Drive, limit and cogging"))
            .default_open(false)
            .show(ui, |ui| self.drive_ui(ui, set));
        ui.small(tr("Double-click a slider to reset it."));
    }

    fn controller_ui(&self, ui: &mut egui::Ui, set: &mut Settings) {
        let (usual, put) = (Settings::default(), &self.put);
        ui.strong(tr("Controller"));
        let most = reach(10.0, put.proportional);
        slider(
            ui,
            &mut set.proportional,
            usual.proportional,
            1.0,
            LEAST * most..=most,
            "P [N m/rad]",
        )
        .on_hover_text(tr("Torque for each rad of error"));
        let most = reach(40.0, put.integral);
        slider(
            ui,
            &mut set.integral,
            usual.integral,
            1.0,
            0.0..=most,
            "I [N m/(rad s)]",
        )
        .on_hover_text(tr("Torque that grows for as long as there is an error"));
        let most = reach(0.1, put.derivative);
        slider(
            ui,
            &mut set.derivative,
            usual.derivative,
            1.0,
            0.0..=most,
            "D [N m s/rad]",
        )
        .on_hover_text(tr("Torque against the velocity of the motor"));
    }

    fn friction_ui(&self, ui: &mut egui::Ui, set: &mut Settings) {
        let (usual, put) = (Settings::default(), &self.put);
        ui.strong(tr("Dry friction"));
        let most = reach(200.0, MILLI * put.coulomb);
        slider(
            ui,
            &mut set.coulomb,
            usual.coulomb,
            MILLI,
            0.0..=most,
            "in motion [mN m]",
        )
        .on_hover_text(tr("Coulomb friction: the level while it moves fast"));
        let most = reach(200.0, MILLI * put.excess);
        slider(
            ui,
            &mut set.excess,
            usual.excess,
            MILLI,
            0.0..=most,
            "more at rest [mN m]",
        )
        .on_hover_text(tr("Stiction: by how much more it takes to break away"));
        let most = reach(120.0, DEGREES * put.stribeck_speed);
        slider(
            ui,
            &mut set.stribeck_speed,
            usual.stribeck_speed,
            DEGREES,
            0.0..=most,
            "Stribeck speed [°/s]",
        )
        .on_hover_text(tr("Speed at which most of the stiction is gone"));
    }

    fn play_ui(&self, ui: &mut egui::Ui, set: &mut Settings) {
        let put = &self.put;
        ui.strong(tr("Play in the gear"));
        let most = reach(5.0, 2.0 * DEGREES * put.half_gap);
        slider(
            ui,
            &mut set.half_gap,
            0.0,
            2.0 * DEGREES,
            0.0..=most,
            "play [°]",
        )
        .on_hover_text(tr("Between the motor and what is measured"));
    }

    fn drive_ui(&self, ui: &mut egui::Ui, set: &mut Settings) {
        let (usual, put) = (Settings::default(), &self.put);
        let most = reach(5000.0, SQUARE_MM * put.inertia);
        slider(
            ui,
            &mut set.inertia,
            usual.inertia,
            SQUARE_MM,
            LEAST * most..=most,
            "inertia [kg mm²]",
        );
        let most = reach(0.05, put.viscous);
        slider(
            ui,
            &mut set.viscous,
            usual.viscous,
            1.0,
            0.0..=most,
            "viscous friction [N m s/rad]",
        );
        let most = reach(90.0, DEGREES * put.reference);
        slider(
            ui,
            &mut set.reference,
            usual.reference,
            DEGREES,
            -most..=most,
            "where it should be [°]",
        );
        let most = reach(5.0, put.limit);
        slider(
            ui,
            &mut set.limit,
            usual.limit,
            1.0,
            0.0..=most,
            "torque limit [N m]",
        )
        .on_hover_text(tr("0: there is none"));
        let most = reach(2.0, put.tracking_time);
        slider(
            ui,
            &mut set.tracking_time,
            usual.tracking_time,
            1.0,
            0.0..=most,
            "anti-windup time [s]",
        )
        .on_hover_text(tr(
            "How fast the integral is led back at the limit; 0: it winds up",
        ));
        let most = reach(100.0, MILLI * put.cogging);
        slider(
            ui,
            &mut set.cogging,
            usual.cogging,
            MILLI,
            0.0..=most,
            "cogging [mN m]",
        );
        let most = reach(48.0, put.per_turn);
        slider(
            ui,
            &mut set.per_turn,
            usual.per_turn,
            1.0,
            LEAST * most..=most,
            "cogging periods [1/rev]",
        );
    }
}

/// The usual end of a slider, or a farther one that has room for a value.
fn reach(usual: f64, value: f64) -> f64 {
    usual.max(2.0 * value.abs())
}
