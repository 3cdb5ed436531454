//! What can be set: figure, plant, relay, noise, playback.

use hysteron_core::figures::figures;
use hysteron_core::msg;
use hysteron_core::relay::Relay;
use hysteron_core::simulate::Noise;

use super::{About, Explore};
use crate::language::tr;
use crate::widgets::controls::{asymmetry_slider, delay_slider, slider};

/// Time between the values of the noise, as a share of a second.
const NOISE_INTERVAL: f64 = 0.02;

impl Explore {
    pub(super) fn controls_ui(&mut self, ui: &mut egui::Ui) {
        ui.add_space(4.0);
        self.message_ui(ui);
        self.controller.ui(ui);
        match self.about() {
            About::Relay => {}
            About::OnOff => {
                let (set, controls) = (&mut self.on_off.set, &mut self.on_off.controls);
                return controls.ui(ui, set, self.controller, &mut self.editor, &mut self.input);
            }
            About::Servo => return self.servo.controls_ui(ui),
        }
        self.figures_ui(ui);
        if self.editor.ui(ui, &mut self.input.plant) {
            self.figure = None;
        }
        ui.separator();
        self.relay_ui(ui);
        let (set, controls) = (&mut self.on_off.set, &mut self.on_off.controls);
        controls.more_ui(ui, set, self.controller, &self.input);
        self.playback_ui(ui);
    }

    /// The paper's figures, one click each.
    fn figures_ui(&mut self, ui: &mut egui::Ui) {
        ui.horizontal_wrapped(|ui| {
            ui.label(tr("From the paper:"));
            for figure in figures() {
                let chosen = self.figure == Some(figure.number);
                let button = ui
                    .add(
                        egui::Button::new(tr(msg!("Fig. {}", figure.number)))
                            .selected(chosen)
                            .frame(true),
                    )
                    .on_hover_text(tr(msg!("{}: {}", figure.title, figure.claim)));
                if button.clicked() {
                    self.figure = (!chosen).then_some(figure.number);
                    if !chosen {
                        self.input = figure.input;
                        self.playback.clock = 0.0;
                    }
                }
            }
        });
    }

    fn relay_ui(&mut self, ui: &mut egui::Ui) {
        ui.strong(tr("Relay"));
        let relay = &mut self.input.relay;
        let normal = Relay::default();
        slider(ui, &mut relay.gain, normal.gain, 1.0, 0.1..=5.0, "gain k")
            .on_hover_text(tr("How strongly the relay pushes"));
        slider(ui, &mut relay.hysteresis, normal.hysteresis, 1.0, 0.0..=1.0, "hysteresis ε").on_hover_text(tr(
            "How far past zero the output must go before the relay switches; also by dragging the dashed line in the \
             Nyquist plot"));
        asymmetry_slider(ui, &mut relay.asymmetry, normal.asymmetry);
        delay_slider(ui, &mut relay.delay, normal.delay, 2.0);
        let noise = &mut self.input.noise;
        let mut size = noise.map_or(0.0, |n| n.std_dev);
        let before = size;
        slider(ui, &mut size, 0.0, 1.0, 0.0..=0.2, "noise σ").on_hover_text(tr(
            "Standard deviation of the noise on the output that the relay sees",
        ));
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
        ui.small(tr("Double-click a slider to reset it."));
    }

    fn playback_ui(&mut self, ui: &mut egui::Ui) {
        ui.horizontal_wrapped(|ui| {
            let label = self.playback.label(ui.ctx());
            if ui.button(tr(label)).clicked() {
                self.playback.toggle(ui.ctx());
            }
            if ui.button(tr("From the start")).clicked() {
                self.playback.clock = 0.0;
            }
            ui.checkbox(&mut self.nyquist.margin, tr("phase-margin point S"));
        });
    }
}
