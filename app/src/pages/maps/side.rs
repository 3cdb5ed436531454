//! What to map, and what the map says at one point.

use hysteron_core::explore::ExploreInput;
use hysteron_core::maps::{Axis, Parameter, Quantity};
use hysteron_core::message::Message;

use super::Maps;
use super::words::{axis_title, stability, with_unit};
use crate::command::Command;
use crate::language::tr;
use crate::widgets::controls::reset_asked;
use crate::widgets::typed::{DECIMALS, Typed};

impl Maps {
    /// Axes and quantity.
    pub(super) fn choices_ui(&mut self, ui: &mut egui::Ui) {
        ui.add_space(4.0);
        let colour = ui.strong(tr("Colour"));
        egui::ComboBox::from_id_salt("quantity")
            .selected_text(tr(self.quantity.label()))
            .width(280.0)
            .show_ui(ui, |ui| {
                for quantity in Quantity::ALL {
                    let row =
                        ui.selectable_value(&mut self.quantity, quantity, tr(quantity.label()));
                    if row.clicked() {
                        self.picture.outdated();
                    }
                }
            })
            .response
            .labelled_by(colour.id);
        ui.add_space(4.0);
        let base = self.input.base.clone();
        axis_ui(ui, "Across", &mut self.input.x, &base);
        axis_ui(ui, "Upwards", &mut self.input.y, &base);
        if ui.button(tr("Swap the axes")).clicked() {
            std::mem::swap(&mut self.input.x, &mut self.input.y);
            self.point = self.point.map(|[x, y]| [y, x]);
        }
        ui.add_space(4.0);
        ui.small(tr("Everything else is as set in Explore. Amplitude: half of peak to peak. Ku = 4k/(πa), with the exact amplitude a."));
    }

    /// Every quantity at the chosen point.
    pub(super) fn point_ui(&mut self, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
        ui.strong(tr("At one point"));
        let (x, y) = (self.input.x, self.input.y);
        let old = self.shown_point();
        let mut point = old;
        for (value, axis) in point.iter_mut().zip([x, y]) {
            let unit = axis.parameter.unit();
            let slider = Typed::new(*value, unit, axis.from..=axis.to, DECIMALS)
                .slider(ui.ctx(), value)
                .text(tr(axis_title(axis.parameter.label(), unit)));
            let slider = ui.add(slider);
            if reset_asked(ui, &slider) {
                let usual = axis.parameter.read(&ExploreInput::default());
                *value = usual.clamp(axis.from, axis.to);
            }
        }
        if point != old {
            self.choose(point, commands);
        }
        if let Some(outcome) = self.read(point) {
            egui::Grid::new("point")
                .num_columns(2)
                .striped(true)
                .show(ui, |ui| {
                    for quantity in Quantity::ALL {
                        let text: Message = match (quantity, quantity.value(&outcome)) {
                            (_, None) => "none".into(),
                            (Quantity::Stability, Some(v)) => stability(v).into(),
                            (_, Some(v)) => with_unit(v, quantity.unit()).into(),
                        };
                        ui.label(tr(quantity.label()));
                        ui.label(tr(text));
                        ui.end_row();
                    }
                });
        }
        if self.point.is_some() {
            ui.label(tr("Explore is set to this point."));
        }
        if ui.button(tr("Show this loop in Explore")).clicked() {
            self.choose(point, commands);
            commands.push(Command::Go("explore"));
        }
    }
}

fn suffix(unit: &str) -> String {
    if unit.is_empty() {
        String::new()
    } else {
        format!(" {unit}")
    }
}

fn axis_ui(
    ui: &mut egui::Ui,
    name: &'static str,
    axis: &mut Axis,
    base: &hysteron_core::explore::ExploreInput,
) {
    let title = ui.strong(tr(name));
    egui::ComboBox::from_id_salt(name)
        .selected_text(tr(axis.parameter.label()))
        .width(280.0)
        .show_ui(ui, |ui| {
            for parameter in Parameter::ALL {
                let chosen = axis.parameter == parameter;
                if ui.selectable_label(chosen, tr(parameter.label())).clicked() && !chosen {
                    *axis = Axis::around(parameter, base);
                }
            }
        })
        .response
        .labelled_by(title.id);
    ui.horizontal(|ui| {
        let speed = 0.005 * (axis.to - axis.from).abs().max(1e-3);
        for (label, value) in [("from", &mut axis.from), ("to", &mut axis.to)] {
            let label = ui.label(tr(label));
            let unit = axis.parameter.unit();
            let field = Typed::new(*value, unit, 0.0..=1e4, DECIMALS)
                .field(ui.ctx(), value)
                .speed(speed)
                .suffix(suffix(unit));
            ui.add(field).labelled_by(label.id);
        }
    });
}
