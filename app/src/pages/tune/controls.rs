//! What can be set: the plant, the relay, what is wanted, and the controller before.

use hysteron_core::plant::presets;
use hysteron_core::relay::Relay;
use hysteron_core::tuning::{AMPLITUDE_CONVENTION, Pid, RULES, TuningInput, Wish, rule};

use super::Tune;
use crate::pages::Desk;

impl Tune {
    pub(super) fn controls_ui(&mut self, ui: &mut egui::Ui, desk: &mut Desk) {
        ui.add_space(4.0);
        plant_ui(ui, desk);
        ui.separator();
        self.relay_ui(ui, &mut desk.relay_loop.relay);
        ui.separator();
        self.wishes_ui(ui);
        ui.separator();
        equations_ui(ui);
    }

    fn relay_ui(&mut self, ui: &mut egui::Ui, relay: &mut Relay) {
        ui.strong("Relay");
        let normal = Relay::default();
        slider_ui(
            ui,
            &mut relay.gain,
            0.1..=5.0,
            normal.gain,
            "gain k",
            "How strongly the relay pushes in the experiment",
        );
        slider_ui(
            ui,
            &mut relay.hysteresis,
            0.0..=1.0,
            normal.hysteresis,
            "hysteresis ε",
            "Keeps the relay from switching on noise, and makes the ultimate gain look smaller",
        );
        slider_ui(
            ui,
            &mut self.asymmetry,
            -0.6..=0.6,
            TuningInput::default().relay.asymmetry,
            "asymmetry a",
            "Of the relay in step 4 only: without it a test tells no static gain",
        );
        slider_ui(
            ui,
            &mut relay.delay,
            0.0..=2.0,
            normal.delay,
            "delay [s]",
            "How late the actuator acts; part of the plant for the controller",
        );
    }

    fn wishes_ui(&mut self, ui: &mut egui::Ui) {
        ui.strong("Controller");
        let mut degrees = self.input.wish.phase_margin.to_degrees();
        slider_ui(
            ui,
            &mut degrees,
            5.0..=80.0,
            Wish::default().phase_margin.to_degrees(),
            "phase margin [°]",
            "What the relay of step 3 and the rule of Astrom and Hagglund aim at",
        );
        self.input.wish.phase_margin = degrees.to_radians();
        let mut gain = self.input.present.gain;
        slider_ui(
            ui,
            &mut gain,
            0.1..=5.0,
            TuningInput::default().present.gain,
            "gain before",
            "The proportional controller that the tuned one replaces",
        );
        self.input.present = Pid::p(gain);
        let chosen = rule(&self.input.rule).map_or("", |r| r.name);
        egui::ComboBox::from_label("rule")
            .selected_text(chosen)
            .width(240.0)
            .show_ui(ui, |ui| {
                for rule in &RULES {
                    let same = self.input.rule == rule.id;
                    if ui.selectable_label(same, rule.name).clicked() {
                        rule.id.clone_into(&mut self.input.rule);
                    }
                }
            });
        if let Ok(rule) = rule(&self.input.rule) {
            ui.small(rule.sentence);
            ui.small(rule.source);
        }
        ui.small("Double-click a slider to reset it.");
    }
}

fn plant_ui(ui: &mut egui::Ui, desk: &mut Desk) {
    let all = presets();
    let plant = &mut desk.relay_loop.plant;
    let chosen = all.iter().find(|p| p.plant == *plant);
    egui::ComboBox::from_label("plant")
        .selected_text(chosen.map_or("that of Explore", |p| p.name))
        .width(220.0)
        .show_ui(ui, |ui| {
            for preset in &all {
                let same = chosen.is_some_and(|c| c.name == preset.name);
                if ui.selectable_label(same, preset.name).clicked() {
                    plant.clone_from(&preset.plant);
                }
            }
        });
    if let Some(preset) = chosen {
        ui.small(preset.sentence);
    }
    ui.small("Plant and relay are those of Explore.");
}

fn slider_ui(
    ui: &mut egui::Ui,
    value: &mut f64,
    range: std::ops::RangeInclusive<f64>,
    normal: f64,
    label: &str,
    explanation: &str,
) {
    let slider = ui.add(egui::Slider::new(value, range).text(label).max_decimals(3));
    if slider.on_hover_text(explanation).double_clicked() {
        *value = normal;
    }
}

fn equations_ui(ui: &mut egui::Ui) {
    ui.collapsing("The equations", |ui| {
        ui.monospace(
            "(4) K_u = 4k/(π √(a² - ε²)), T_u: period\n\
             (7) k = π a/4,  ε = a sin φ\n\
             (8) K(n+1): secant through two runs\n\
             (9) C(jω) = S/M\n\
             C(s) = K (1 + 1/(Ti s) + Td s/(Tf s + 1))",
        );
        ui.small(format!("Convention: {AMPLITUDE_CONVENTION}."));
        ui.small(
            "φ: phase margin, M: identified point of the Nyquist curve, S: where it shall go.",
        );
    });
}
