//! What can be set: the plant, the relay, what is wanted, and the controller before.

use hysteron_core::msg;
use hysteron_core::plant::presets;
use hysteron_core::relay::Relay;
use hysteron_core::tuning::{AMPLITUDE_CONVENTION, Pid, RULES, TuningInput, Wish, rule};

use super::Tune;
use crate::desk::Desk;
use crate::language::tr;
use crate::widgets::controls::slider;
use crate::widgets::equation::equation_ui;

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
        ui.strong(tr("Relay"));
        let normal = Relay::default();
        slider(ui, &mut relay.gain, normal.gain, 1.0, 0.1..=5.0, "gain k")
            .on_hover_text(tr("How strongly the relay pushes in the experiment"));
        slider(
            ui,
            &mut relay.hysteresis,
            normal.hysteresis,
            1.0,
            0.0..=1.0,
            "hysteresis ε",
        )
        .on_hover_text(tr(
            "Keeps the relay from switching on noise, and makes the ultimate gain look smaller",
        ));
        slider(
            ui,
            &mut self.asymmetry,
            TuningInput::default().relay.asymmetry,
            1.0,
            -0.6..=0.6,
            "asymmetry α",
        )
        .on_hover_text(tr(
            "For the relay in step 4 only: without it a test says nothing about the static gain",
        ));
        slider(
            ui,
            &mut relay.delay,
            normal.delay,
            1.0,
            0.0..=2.0,
            "delay [s]",
        )
        .on_hover_text(tr(
            "How late the actuator responds; to the controller it is part of the plant",
        ));
    }

    fn wishes_ui(&mut self, ui: &mut egui::Ui) {
        ui.strong(tr("Controller"));
        slider(
            ui,
            &mut self.input.wish.phase_margin,
            Wish::default().phase_margin,
            180.0 / std::f64::consts::PI,
            5.0..=80.0,
            "phase margin [°]",
        )
        .on_hover_text(tr(
            "What the relay of step 3 and the rule of Åström and Hägglund aim at",
        ));
        let mut gain = self.input.present.gain;
        slider(
            ui,
            &mut gain,
            TuningInput::default().present.gain,
            1.0,
            0.1..=5.0,
            "gain before",
        )
        .on_hover_text(tr(
            "The proportional controller that the tuned one replaces",
        ));
        self.input.present = Pid::p(gain);
        let chosen = rule(&self.input.rule).map_or("", |r| r.name);
        egui::ComboBox::from_label(tr("rule"))
            .selected_text(tr(chosen))
            .width(240.0)
            .show_ui(ui, |ui| {
                for rule in &RULES {
                    let same = self.input.rule == rule.id;
                    if ui.selectable_label(same, tr(rule.name)).clicked() {
                        rule.id.clone_into(&mut self.input.rule);
                    }
                }
            });
        if let Ok(rule) = rule(&self.input.rule) {
            ui.small(tr(rule.sentence));
            ui.small(tr(rule.source));
        }
        ui.small(tr("Double-click a slider to reset it."));
    }
}

fn plant_ui(ui: &mut egui::Ui, desk: &mut Desk) {
    let all = presets();
    let plant = &mut desk.relay_loop.plant;
    let chosen = all.iter().find(|p| p.plant == *plant);
    egui::ComboBox::from_label(tr("plant"))
        .selected_text(tr(chosen.map_or("the one in Explore", |p| p.name)))
        .width(220.0)
        .show_ui(ui, |ui| {
            for preset in &all {
                let same = chosen.is_some_and(|c| c.name == preset.name);
                if ui.selectable_label(same, tr(preset.name)).clicked() {
                    plant.clone_from(&preset.plant);
                }
            }
        });
    if let Some(preset) = chosen {
        ui.small(tr(preset.sentence));
    }
    ui.small(tr(
        "Plant and relay are those in Explore; the asymmetry is that of step 4.",
    ));
}

/// What they say, and the equations behind the page.
const EQUATIONS: [(&str, &str); 4] = [
    ("Moving point, equation (4)", "M R = S,  C(jω) = S/M"),
    ("Relay for a phase margin, (7)", "k = π a/4,  ε = a sin φ"),
    ("Ultimate gain, (9)", "Ku = |N(a)| = 4k/(πa)"),
    ("Controller", "C(s) = K (1 + 1/(Ti s) + Td s/(Tf s + 1))"),
];

fn equations_ui(ui: &mut egui::Ui) {
    ui.collapsing(tr("The equations"), |ui| {
        for (what, equation) in EQUATIONS {
            ui.small(tr(what));
            equation_ui(ui, equation, &|_| None);
        }
        ui.small(tr(msg!("Convention: {}.", AMPLITUDE_CONVENTION)));
        ui.small(tr(
            "φ: phase margin, M: identified point of the Nyquist curve, S: where it should go.",
        ));
    });
}
