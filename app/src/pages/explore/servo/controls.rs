//! What can be set of a servo.

use super::settings::{DEGREES, Settings};
use crate::language::tr;
use crate::widgets::controls::slider;

/// Values that are shown in other units than they are kept in.
const MILLI: f64 = 1e3;
const SQUARE_MM: f64 = 1e6;

/// Part of its range below which no value comes that must be above 0.
const LEAST: f64 = 1e-3;

/// Where a value stands among those that are set.
type Place = fn(&mut Settings) -> &mut f64;

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
        ui.strong(tr("Controller"));
        self.above_zero(ui, set, |s| &mut s.proportional, 1.0, 10.0, "P [N m/rad]")
            .on_hover_text(tr("Torque for each rad of error"));
        self.down_to_zero(ui, set, |s| &mut s.integral, 1.0, 40.0, "I [N m/(rad s)]")
            .on_hover_text(tr("Torque that grows for as long as there is an error"));
        self.down_to_zero(ui, set, |s| &mut s.derivative, 1.0, 0.1, "D [N m s/rad]")
            .on_hover_text(tr("Torque against the velocity of the motor"));
    }

    fn friction_ui(&self, ui: &mut egui::Ui, set: &mut Settings) {
        ui.strong(tr("Dry friction"));
        self.down_to_zero(
            ui,
            set,
            |s| &mut s.coulomb,
            MILLI,
            200.0,
            "in motion [mN m]",
        )
        .on_hover_text(tr("Coulomb friction: the level while it moves fast"));
        self.down_to_zero(
            ui,
            set,
            |s| &mut s.excess,
            MILLI,
            200.0,
            "more at rest [mN m]",
        )
        .on_hover_text(tr("Stiction: by how much more it takes to break away"));
        self.down_to_zero(
            ui,
            set,
            |s| &mut s.stribeck_speed,
            DEGREES,
            120.0,
            "Stribeck speed [°/s]",
        )
        .on_hover_text(tr("Speed at which most of the stiction is gone"));
    }

    fn play_ui(&self, ui: &mut egui::Ui, set: &mut Settings) {
        ui.strong(tr("Play in the gear"));
        self.down_to_zero(ui, set, |s| &mut s.half_gap, 2.0 * DEGREES, 5.0, "play [°]")
            .on_hover_text(tr("Between the motor and what is measured"));
    }

    fn drive_ui(&self, ui: &mut egui::Ui, set: &mut Settings) {
        self.above_zero(
            ui,
            set,
            |s| &mut s.inertia,
            SQUARE_MM,
            5000.0,
            "inertia [kg mm²]",
        );
        self.down_to_zero(
            ui,
            set,
            |s| &mut s.viscous,
            1.0,
            0.05,
            "viscous friction [N m s/rad]",
        );
        let (usual, most) = self.usual_and_most(|s| &mut s.reference, DEGREES, 90.0);
        slider(
            ui,
            &mut set.reference,
            usual,
            DEGREES,
            -most..=most,
            "where it should be [°]",
        );
        self.down_to_zero(ui, set, |s| &mut s.limit, 1.0, 5.0, "torque limit [N m]")
            .on_hover_text(tr("0: there is none"));
        self.down_to_zero(
            ui,
            set,
            |s| &mut s.tracking_time,
            1.0,
            2.0,
            "anti-windup time [s]",
        )
        .on_hover_text(tr(
            "How fast the integral is led back at the limit; 0: it winds up",
        ));
        self.down_to_zero(ui, set, |s| &mut s.cogging, MILLI, 100.0, "cogging [mN m]");
        self.above_zero(
            ui,
            set,
            |s| &mut s.per_turn,
            1.0,
            48.0,
            "cogging periods [1/rev]",
        );
    }

    /// The usual value in a place, and the end of its slider: as `far` as usual, or farther where what was put there
    /// needs room.
    fn usual_and_most(&self, place: Place, factor: f64, far: f64) -> (f64, f64) {
        let [usual, put] = [Settings::default(), self.put.clone()].map(|mut set| *place(&mut set));
        (usual, far.max(2.0 * (factor * put).abs()))
    }

    /// A slider from 0.
    fn down_to_zero(
        &self,
        ui: &mut egui::Ui,
        set: &mut Settings,
        place: Place,
        factor: f64,
        far: f64,
        name: &'static str,
    ) -> egui::Response {
        let (usual, most) = self.usual_and_most(place, factor, far);
        slider(ui, place(set), usual, factor, 0.0..=most, name)
    }

    /// The same of a value that must be above 0.
    fn above_zero(
        &self,
        ui: &mut egui::Ui,
        set: &mut Settings,
        place: Place,
        factor: f64,
        far: f64,
        name: &'static str,
    ) -> egui::Response {
        let (usual, most) = self.usual_and_most(place, factor, far);
        slider(ui, place(set), usual, factor, LEAST * most..=most, name)
    }
}
