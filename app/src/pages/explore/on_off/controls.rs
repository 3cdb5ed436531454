//! What can be set of a relay as it is built.

use hysteron_core::explore::ExploreInput;
use hysteron_core::limit_cycle::typical_frequency;

use super::settings::{Discrete, Settings};
use crate::language::{Language, spoken, tr, tr_number};
use crate::pages::explore::controller::Controller;
use crate::pages::explore::plant_editor::PlantEditor;
use crate::theme;
use crate::widgets::controls::{asymmetry_slider, delay_slider, slider};

/// Minimum times when they are first asked for, and the longest on the slider, in typical times of the plant.
const FIRST_HOLD: f64 = 3.0;
const LONGEST_HOLD: f64 = 10.0;

/// The same of the sampling time, and the shortest.
const FIRST_SAMPLING: f64 = 0.5;
const LONGEST_SAMPLING: f64 = 5.0;
const SHORTEST_SAMPLING: f64 = 0.01;

/// Sampling time of a plant in discrete time when it is first asked for, s.
const FIRST_Z: f64 = 0.2;

/// What is unfolded, what is typed, and how far the sliders go.
#[derive(Default)]
pub struct Controls {
    /// Whether minimum times and sampling are asked for, though they may be 0.
    holds: bool,
    samples: bool,
    /// Coefficients in `z` as they are typed, and those that the texts stand for.
    typed: [String; 2],
    read: Option<(Discrete, Language)>,
    reach: Reach,
}

/// How far the sliders go: they stay while one is dragged.
#[derive(Clone, Copy)]
struct Reach {
    gain: f64,
    output: f64,
    time: f64,
}

impl Default for Reach {
    fn default() -> Self {
        Self {
            gain: 5.0,
            output: 1.0,
            time: 1.0,
        }
    }
}

impl Reach {
    fn of(set: &Settings, shared: &ExploreInput) -> Self {
        let (plant, relay) = (&shared.plant, &shared.relay);
        let gain = plant.dc_gain().abs();
        let levels = relay.gain * (1.0 + relay.asymmetry.abs()) + relay.bias.abs();
        let farthest = if gain.is_finite() {
            gain * levels
        } else {
            levels
        };
        let needed = set
            .reference
            .abs()
            .max(set.start.abs())
            .max(relay.hysteresis);
        Self {
            gain: round_up(2.0 * relay.gain).max(5.0),
            output: round_up(farthest.min(100.0 * needed.max(1e-6)).max(needed)),
            time: round_up(1.0 / typical_frequency(plant) + plant.dead_time),
        }
    }
}

/// The next larger of 1, 2 and 5 times a power of ten.
fn round_up(value: f64) -> f64 {
    if !(value.is_finite() && value > 0.0) {
        return 1.0;
    }
    let decade = 10_f64.powf(value.log10().floor());
    let steps = [1.0, 2.0, 5.0, 10.0];
    let fits = steps.iter().find(|s| **s * decade >= 0.999 * value);
    fits.map_or(value, |s| s * decade)
}

impl Controls {
    /// Plant and relay.
    pub fn ui(
        &mut self,
        ui: &mut egui::Ui,
        set: &mut Settings,
        controller: Controller,
        editor: &mut PlantEditor,
        shared: &mut ExploreInput,
    ) {
        if ui.input(|i| !i.pointer.any_down()) {
            self.reach = Reach::of(set, shared);
        }
        if set.z.sampling > 0.0 {
            self.discrete_ui(ui, &mut set.z);
        } else {
            editor.ui(ui, &mut shared.plant);
        }
        ui.separator();
        self.relay_ui(ui, set, controller, shared);
        self.more_ui(ui, set, controller, shared);
    }

    fn relay_ui(
        &self,
        ui: &mut egui::Ui,
        set: &mut Settings,
        controller: Controller,
        shared: &mut ExploreInput,
    ) {
        let Reach { gain, output, time } = self.reach;
        let relay = &mut shared.relay;
        let usual = Settings::default();
        ui.strong(tr("Relay"));
        if controller == Controller::OneSided {
            // Off is 0: the gain is half of it.
            slider(
                ui,
                &mut relay.gain,
                1.0,
                2.0,
                0.0..=2.0 * gain,
                "full power",
            )
            .on_hover_text(tr("What the actuator gives while it is on"));
            relay.gain = relay.gain.max(1e-3 * gain);
        } else {
            slider(ui, &mut relay.gain, 1.0, 1.0, 1e-3 * gain..=gain, "gain k")
                .on_hover_text(tr("How strongly the relay pushes"));
        }
        slider(
            ui,
            &mut set.reference,
            0.0,
            1.0,
            -output..=output,
            "reference r",
        )
        .on_hover_text(tr("What the output should be"));
        let name = "hysteresis ε";
        slider(ui, &mut relay.hysteresis, 0.1, 1.0, 0.0..=output, name).on_hover_text(tr(
            "How far past its threshold the output must go before the relay switches",
        ));
        if controller == Controller::ThreePositions {
            let zone = &mut set.dead_zone;
            slider(ui, zone, usual.dead_zone, 1.0, 0.0..=output, "dead zone d").on_hover_text(tr(
                "It is off while the output is closer than this to the reference",
            ));
            slider(
                ui,
                &mut set.start,
                usual.start,
                1.0,
                -2.0 * output..=2.0 * output,
                "output at the start",
            )
            .on_hover_text(tr("Where the output is when the relay is switched on"));
        }
        if controller != Controller::OneSided {
            asymmetry_slider(ui, &mut relay.asymmetry, 0.0);
        }
        delay_slider(ui, &mut relay.delay, 0.0, 2.0 * time);
    }

    /// What a textbook's relay has not; also drawn beside that one, where all of it is absent.
    pub fn more_ui(
        &mut self,
        ui: &mut egui::Ui,
        set: &mut Settings,
        controller: Controller,
        shared: &ExploreInput,
    ) {
        let time = round_up(1.0 / typical_frequency(&shared.plant) + shared.plant.dead_time);
        self.choices_ui(ui, set, time);
        if self.holds {
            let names = if controller == Controller::TwoLevels {
                ["minimum time up [s]", "minimum time down [s]"]
            } else {
                ["minimum time on [s]", "minimum time off [s]"]
            };
            let longest = LONGEST_HOLD * time;
            slider(ui, &mut set.min_on, 0.0, 1.0, 0.0..=longest, names[0]);
            slider(ui, &mut set.min_off, 0.0, 1.0, 0.0..=longest, names[1]);
        }
        if self.samples {
            sampling_ui(ui, set, time);
        }
    }

    /// What may be asked for.
    fn choices_ui(&mut self, ui: &mut egui::Ui, set: &mut Settings, time: f64) {
        self.holds |= set.min_on.max(set.min_off) > 0.0;
        self.samples |= set.sampling.max(set.z.sampling) > 0.0;
        ui.horizontal_wrapped(|ui| {
            if ui
                .checkbox(&mut self.holds, tr("minimum times on and off"))
                .on_hover_text(tr(
                    "As compressors and pumps need them: after a switch it waits before the next",
                ))
                .changed()
            {
                let first = if self.holds { FIRST_HOLD * time } else { 0.0 };
                (set.min_on, set.min_off) = (first, first);
            }
            if ui
                .checkbox(&mut self.samples, tr("sampled"))
                .on_hover_text(tr(
                    "It looks at the output at regular instants only, as a controller in software does",
                ))
                .changed()
            {
                let first = if self.samples { FIRST_SAMPLING * time } else { 0.0 };
                (set.sampling, set.z.sampling) = (first, 0.0);
            }
        });
    }

    /// The coefficients of a plant in `z`.
    fn discrete_ui(&mut self, ui: &mut egui::Ui, z: &mut Discrete) {
        let shown = (z.clone(), spoken());
        if self.read.as_ref() != Some(&shown) {
            self.typed = [&z.numerator, &z.denominator].map(|p| list(p));
            self.read = Some(shown);
        }
        ui.strong(tr("Plant in discrete time"));
        let names = ["numerator in z", "denominator in z"];
        let mut changed = false;
        for (text, name) in self.typed.iter_mut().zip(names) {
            ui.horizontal(|ui| {
                let label = ui.label(tr(name));
                let edit = theme::line(text)
                    .font(egui::TextStyle::Monospace)
                    .desired_width(f32::INFINITY);
                changed |= ui.add(edit).labelled_by(label.id).changed();
            });
        }
        let read = self.typed.each_ref().map(|text| numbers(text));
        if let [Some(numerator), Some(denominator)] = read {
            if changed {
                (z.numerator, z.denominator) = (numerator, denominator);
                self.read = Some((z.clone(), spoken()));
            }
        } else {
            let color = ui.visuals().warn_fg_color;
            ui.colored_label(
                color,
                tr("Numbers with spaces between them, the highest power of z first."),
            );
        }
    }
}

fn sampling_ui(ui: &mut egui::Ui, set: &mut Settings, time: f64) {
    let [shortest, longest] = [SHORTEST_SAMPLING, LONGEST_SAMPLING].map(|share| share * time);
    let mut discrete = set.z.sampling > 0.0;
    let sampling = if discrete {
        &mut set.z.sampling
    } else {
        &mut set.sampling
    };
    let usual = FIRST_SAMPLING * time;
    slider(
        ui,
        sampling,
        usual,
        1.0,
        shortest..=longest,
        "sampling time [s]",
    );
    *sampling = sampling.max(1e-3 * shortest);
    if ui
        .checkbox(&mut discrete, tr("plant in z"))
        .on_hover_text(tr(
            "A plant in discrete time: a transfer function in z, from sample to sample",
        ))
        .changed()
    {
        let given = if set.sampling > 0.0 {
            set.sampling
        } else {
            FIRST_Z
        };
        if discrete {
            set.z.sampling = given;
        } else {
            set.sampling = set.z.sampling;
            set.z.sampling = 0.0;
        }
    }
}

fn list(coefficients: &[f64]) -> String {
    let all: Vec<String> = coefficients.iter().map(f64::to_string).collect();
    tr_number(all.join(" "))
}

fn numbers(text: &str) -> Option<Vec<f64>> {
    let all: Option<Vec<f64>> = text
        .split([' ', ';'])
        .filter(|part| !part.is_empty())
        .map(|part| {
            part.replace(',', ".")
                .parse()
                .ok()
                .filter(|v: &f64| v.is_finite())
        })
        .collect();
    all.filter(|list| !list.is_empty())
}
