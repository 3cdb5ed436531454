//! Every parameter of the model with its uncertainty.

use hysteron_core::diagnosis::{Parameter, StepReport};
use hysteron_core::effect::name_of;
use hysteron_core::uncertain::{interval, with_error};

use crate::language::tr;
use crate::theme;

/// Size of the bar that shows an interval, points.
const BAR: egui::Vec2 = egui::vec2(70.0, 12.0);

/// Standard errors on either side of a 95 % interval.
const INTERVAL: f64 = 1.96;

pub(super) fn ui(report: &StepReport, ui: &mut egui::Ui) {
    egui::CollapsingHeader::new(tr("Parameters of the model"))
        .default_open(true)
        .show(ui, |ui| {
            egui::Grid::new("parameters")
                .num_columns(3)
                .striped(true)
                .show(ui, |ui| {
                    for p in &report.step.parameters {
                        let owner = p.effect.map_or("baseline", name_of);
                        let hover = format!("{}, {owner}", p.label);
                        ui.label(tr(&p.name)).on_hover_text(tr(&hover));
                        ui.vertical(|ui| {
                            ui.spacing_mut().item_spacing.y = 0.0;
                            ui.style_mut().wrap_mode = Some(egui::TextWrapMode::Extend);
                            ui.label(tr(with_error(p.value, p.std_error, &p.unit)))
                                .on_hover_text(tr(hover));
                            ui.small(tr(&p.label));
                        });
                        interval_ui(p, ui);
                        ui.end_row();
                    }
                });
            ui.small(tr("With one standard error. Bars: 95 % intervals, from 0 at the left to twice the value; hollow where 0 is in them."));
        });
}

/// The 95 % interval as a bar about the value in the middle; its left end is 0.
fn interval_ui(p: &Parameter, ui: &mut egui::Ui) {
    let (rect, response) = ui.allocate_exact_size(BAR, egui::Sense::hover());
    let painter = ui.painter();
    let middle = rect.center();
    let faint = ui.visuals().weak_text_color();
    painter.hline(rect.x_range(), middle.y, (1.0, faint));
    painter.vline(rect.left(), rect.y_range(), (1.0, faint));
    let share = INTERVAL * p.std_error / p.value.abs();
    if share.is_nan() {
        return;
    }
    let unsure = share >= 1.0;
    let half = (0.5 * BAR.x * share.min(1.0) as f32).max(1.5);
    let bar = egui::Rect::from_center_size(middle, egui::vec2(2.0 * half, 6.0));
    if unsure {
        painter.rect_stroke(bar, 1.0, (1.5, theme::MODEL), egui::StrokeKind::Inside);
    } else {
        painter.rect_filled(bar, 1.0, theme::MODEL);
    }
    let interval = interval(p.value, p.std_error, INTERVAL, &p.unit);
    response.on_hover_text(tr(format!("95 % interval: {interval}")));
}
