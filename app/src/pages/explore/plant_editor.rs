//! The plant: chosen, or typed as a formula. What cannot be read is explained and changes nothing.

use hysteron_core::message::Message;
use hysteron_core::message::fixed;
use hysteron_core::msg;
use hysteron_core::plant::{TransferFunction, parse, presets};

use crate::language::tr;
use crate::theme;
use crate::widgets::equation::equation_ui;

/// The text that is being typed.
#[derive(Default)]
pub struct PlantEditor {
    text: String,
    /// The plant that the text stands for, if it can be read.
    read: Option<TransferFunction>,
    error: Option<Message>,
}

impl PlantEditor {
    /// Why the text is not taken.
    pub fn error(&self) -> Option<&Message> {
        self.error.as_ref()
    }

    /// Draws the editor; true when the plant was changed here.
    pub fn ui(&mut self, ui: &mut egui::Ui, plant: &mut TransferFunction) -> bool {
        let mut changed = presets_ui(ui, plant);
        // Changed elsewhere: the text follows, but never while it is being corrected.
        if self.read.as_ref() != Some(plant) && (self.error.is_none() || changed) {
            self.text = formula(plant);
            self.read = Some(plant.clone());
            self.error = None;
        }
        let typed = ui
            .horizontal(|ui| {
                let label = ui.label(tr("P(s) ="));
                let edit = theme::line(&mut self.text)
                    .font(egui::TextStyle::Monospace)
                    .hint_text("1/(s+1)^3")
                    .desired_width(f32::INFINITY);
                ui.add(edit).labelled_by(label.id).changed()
            })
            .inner;
        if typed {
            changed |= self.take(plant);
        }
        if let Some(error) = &self.error {
            ui.colored_label(ui.visuals().warn_fg_color, tr(error));
            ui.small(tr(msg!("Still showing P(s) = {}", formula(plant))));
            if ui.button(tr("Back to this plant")).clicked() {
                self.error = None;
                self.read = None;
            }
        } else {
            ui.small(tr(
                "Type it as you would write it: 2 e^{-0.5s}/(3s+1), (1-s)/((s+1)(s+2))",
            ));
        }
        if self.error.is_none() {
            equation_ui(ui, &format!("P(s) = {}", formula(plant)), &|_| None);
        }
        describe_ui(ui, plant);
        changed
    }

    fn take(&mut self, plant: &mut TransferFunction) -> bool {
        match parse(&self.text) {
            Ok(new) => {
                self.error = None;
                let changed = *plant != new;
                *plant = new.clone();
                self.read = Some(new);
                changed
            }
            Err(error) => {
                self.error = Some(error.into());
                false
            }
        }
    }
}

fn presets_ui(ui: &mut egui::Ui, plant: &mut TransferFunction) -> bool {
    let all = presets();
    let chosen = all.iter().position(|p| p.plant == *plant);
    let name = chosen
        .and_then(|i| all.get(i))
        .map_or("your own plant", |p| p.name);
    let mut changed = false;
    egui::ComboBox::from_label(tr("plant"))
        .selected_text(tr(name))
        .width(250.0)
        .show_ui(ui, |ui| {
            for (index, preset) in all.iter().enumerate() {
                let row = ui
                    .selectable_label(chosen == Some(index), tr(preset.name))
                    .on_hover_text(tr(preset.sentence));
                if row.clicked() {
                    plant.clone_from(&preset.plant);
                    changed = true;
                }
            }
        });
    changed
}

/// Poles, zeros and gain: what the formula means.
fn describe_ui(ui: &mut egui::Ui, plant: &TransferFunction) {
    ui.collapsing(tr("Poles, zeros, gain"), |ui| {
        let poles = plant
            .poles()
            .iter()
            .map(|p| root(p.re, p.im))
            .collect::<Vec<_>>();
        let zeros = plant
            .zeros()
            .iter()
            .map(|z| root(z.re, z.im))
            .collect::<Vec<_>>();
        ui.label(tr(msg!("poles [1/s]: {}", list(&poles))));
        ui.label(tr(msg!("zeros [1/s]: {}", list(&zeros))));
        ui.label(tr(msg!("gain P(0): {}", fixed(plant.dc_gain(), 4))));
        ui.label(tr(msg!("dead time: {} s", plant.dead_time)));
    });
}

fn list(roots: &[String]) -> Message {
    if roots.is_empty() {
        "none".into()
    } else {
        roots.join(",  ").into()
    }
}

fn root(re: f64, im: f64) -> String {
    if im == 0.0 {
        format!("{re:.4}")
    } else {
        format!(
            "{re:.4} {} {:.4}j",
            if im < 0.0 { '-' } else { '+' },
            im.abs()
        )
    }
}

/// The plant as it can be typed.
pub fn formula(plant: &TransferFunction) -> String {
    let terms = |p: &[f64]| p.iter().filter(|c| **c != 0.0).count();
    let numerator = polynomial(&plant.numerator);
    let numerator = if terms(&plant.numerator) > 1 {
        format!("({numerator})")
    } else {
        numerator
    };
    let delay = if plant.dead_time > 0.0 {
        format!(" e^{{-{}s}}", plant.dead_time)
    } else {
        String::new()
    };
    format!("{numerator}/({}){delay}", polynomial(&plant.denominator))
}

fn polynomial(p: &[f64]) -> String {
    let terms: Vec<String> = p
        .iter()
        .enumerate()
        .filter(|(_, c)| **c != 0.0)
        .map(|(i, c)| match (p.len() - 1 - i, *c) {
            (0, c) => format!("{c}"),
            (1, 1.0) => "s".to_owned(),
            (1, -1.0) => "-s".to_owned(),
            (1, c) => format!("{c}s"),
            (k, 1.0) => format!("s^{k}"),
            (k, -1.0) => format!("-s^{k}"),
            (k, c) => format!("{c}s^{k}"),
        })
        .collect();
    terms.join(" + ").replace("+ -", "- ")
}
