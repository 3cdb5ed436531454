//! What can be set: figure, plant, relay, noise, playback.

use hysteron_core::figures::{Check, figures};
use hysteron_core::relay::Relay;
use hysteron_core::simulate::Noise;

use super::Explore;
use crate::theme;

/// Time between the values of the noise, as a share of a second.
const NOISE_INTERVAL: f64 = 0.02;

impl Explore {
    pub(super) fn controls_ui(&mut self, ui: &mut egui::Ui) {
        ui.add_space(4.0);
        self.figures_ui(ui);
        if self.editor.ui(ui, &mut self.input.plant) {
            self.figure = None;
        }
        ui.separator();
        self.relay_ui(ui);
        self.playback_ui(ui);
    }

    /// The paper's figures, one click each.
    fn figures_ui(&mut self, ui: &mut egui::Ui) {
        ui.horizontal_wrapped(|ui| {
            ui.label("From the paper:");
            for figure in figures() {
                let chosen = self.figure == Some(figure.number);
                let button = ui
                    .add(
                        egui::Button::new(format!("Fig. {}", figure.number))
                            .selected(chosen)
                            .frame(true),
                    )
                    .on_hover_text(format!("{}: {}", figure.title, figure.claim));
                if button.clicked() {
                    self.figure = (!chosen).then_some(figure.number);
                    if !chosen {
                        self.input = figure.input;
                        self.clock = 0.0;
                    }
                }
            }
        });
    }

    fn relay_ui(&mut self, ui: &mut egui::Ui) {
        ui.strong("Relay");
        let relay = &mut self.input.relay;
        let normal = Relay::default();
        Setting {
            range: 0.1..=5.0,
            normal: normal.gain,
            label: "gain k",
            explanation: "How strongly the relay pushes",
        }
        .ui(ui, &mut relay.gain);
        Setting {
            range: 0.0..=1.0,
            normal: normal.hysteresis,
            label: "hysteresis ε",
            explanation: "How far the output must pass zero before the relay switches; also by dragging the dashed line in the Nyquist plot",
        }
        .ui(ui, &mut relay.hysteresis);
        Setting {
            range: -0.6..=0.6,
            normal: normal.asymmetry,
            label: "asymmetry a",
            explanation: "How much stronger it pushes up than down",
        }
        .ui(ui, &mut relay.asymmetry);
        Setting {
            range: 0.0..=2.0,
            normal: normal.delay,
            label: "delay [s]",
            explanation: "How late the switch takes effect",
        }
        .ui(ui, &mut relay.delay);
        let noise = &mut self.input.noise;
        let mut size = noise.map_or(0.0, |n| n.std_dev);
        let before = size;
        Setting {
            range: 0.0..=0.2,
            normal: 0.0,
            label: "noise σ",
            explanation: "Standard deviation of the noise on the output that the relay sees",
        }
        .ui(ui, &mut size);
        if size != before {
            let old = noise.unwrap_or(Noise {
                std_dev: 0.0,
                interval: NOISE_INTERVAL,
                seed: 4,
            });
            *noise = (size > 0.0).then_some(Noise {
                std_dev: size,
                ..old
            });
        }
        ui.small("Double-click a slider to reset it.");
    }

    fn playback_ui(&mut self, ui: &mut egui::Ui) {
        ui.horizontal(|ui| {
            let label = if self.playing { "Pause" } else { "Play" };
            if ui.button(label).clicked() {
                self.playing = !self.playing;
            }
            if ui.button("From the start").clicked() {
                self.clock = 0.0;
            }
            ui.checkbox(&mut self.nyquist.margin, "phase-margin point S");
        });
    }
}

/// A slider with its reset.
struct Setting {
    range: std::ops::RangeInclusive<f64>,
    normal: f64,
    label: &'static str,
    explanation: &'static str,
}

impl Setting {
    fn ui(self, ui: &mut egui::Ui, value: &mut f64) {
        // A value from elsewhere (a map, a dragged line) may lie beyond the slider and stays.
        let slider = egui::Slider::new(value, self.range)
            .text(self.label)
            .max_decimals(3)
            .clamping(egui::SliderClamping::Edits);
        let response = ui.add(slider).on_hover_text(self.explanation);
        if response.double_clicked() {
            *value = self.normal;
        }
    }
}

/// What a figure claims, and whether it is so on the loop as it is set now.
pub(super) fn claim_ui(ui: &mut egui::Ui, number: u32, claims: &[Check]) {
    let Some(figure) = figures().into_iter().find(|f| f.number == number) else {
        return;
    };
    ui.strong(format!("Fig. {number}, {}. {}", figure.title, figure.claim));
    ui.horizontal_wrapped(|ui| {
        for (i, check) in claims.iter().enumerate() {
            let (mark, color) = if check.holds {
                ("yes:", theme::NOISE)
            } else {
                ("no:", theme::MODEL)
            };
            ui.colored_label(color, mark);
            let end = if i + 1 == claims.len() { "." } else { ";" };
            ui.label(format!("{}{end}", check.text));
        }
    });
}
