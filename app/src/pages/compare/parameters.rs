//! Every parameter of the model with its uncertainty, and a slider that sets it by hand.

use hysteron_core::by_hand::ByHand;
use hysteron_core::diagnosis::{Parameter, Status, StepReport};
use hysteron_core::effect::{self, name_of};
use hysteron_core::uncertain::{interval, quantity, with_error};

use super::answer::times_noise;
use super::command::Command;
use super::state::Compare;
use crate::hook::Targets;
use crate::language::tr;
use crate::theme;

/// Size of the bar that shows an interval, points.
const BAR: egui::Vec2 = egui::vec2(70.0, 12.0);

/// Standard errors on either side of a 95 % interval.
const INTERVAL: f64 = 1.96;

pub(super) fn ui(
    page: &Compare,
    report: &StepReport,
    ui: &mut egui::Ui,
    targets: &mut Targets,
    commands: &mut Vec<Command>,
) {
    egui::CollapsingHeader::new(tr("Parameters of the model"))
        .default_open(true)
        .show(ui, |ui| {
            let fitted: Vec<f64> = report.step.parameters.iter().map(|p| p.value).collect();
            let hand = page.hand();
            let mut values = hand.map_or_else(|| fitted.clone(), |hand| hand.values.clone());
            if values.len() != fitted.len() {
                return;
            }
            // A formula of the user's own has no slider.
            let known = report
                .step
                .effects
                .iter()
                .all(|e| *e == effect::VISCOUS_FRICTION || effect::find(*e).is_some());
            let before = values.clone();
            let mut let_go = false;
            let mut held = false;
            for (p, value) in report.step.parameters.iter().zip(&mut values) {
                row_ui(p, *value, ui);
                if known && p.status != Status::Fixed {
                    let slider = slider_ui(p, value, ui);
                    targets.note(format!("hand:{}", p.name), ui, &slider);
                    let_go |= slider.drag_stopped();
                    held |= slider.dragged();
                }
            }
            let moved = values != before;
            if moved || (let_go && hand.is_some_and(|h| h.held)) {
                commands.push(Command::Hand(values, held && !let_go));
            }
            if hand.is_some() {
                by_hand_ui(page, report, ui, targets, commands);
            } else if known {
                ui.small(tr("Drag a slider to set a value by hand and see what it does to the residual."));
            }
            ui.small(tr("With one standard error. Bars: 95 % intervals, from 0 at the left to twice the value; hollow where 0 is in them."));
        });
}

/// What the values that are set by hand leave, and the way back.
fn by_hand_ui(
    page: &Compare,
    report: &StepReport,
    ui: &mut egui::Ui,
    targets: &mut Targets,
    commands: &mut Vec<Command>,
) {
    ui.horizontal_wrapped(|ui| {
        if let Some((error, exact)) = page.hand_error() {
            let about = if exact { "" } else { "about " };
            ui.label(tr(format!(
                "By hand the error is {about}{} × the noise; the fit leaves {}.",
                times_noise(error),
                times_noise(report.step.error)
            )));
        }
        let back = ui.button(tr("Back to the fit"));
        targets.note("hand:back", ui, &back);
        if back.clicked() {
            commands.push(Command::DropHand);
        }
    });
}

/// Its symbol, value, meaning and interval.
fn row_ui(p: &Parameter, value: f64, ui: &mut egui::Ui) {
    let owner = p.effect.map_or("baseline", name_of);
    let hover = format!("{}, {owner}", p.label);
    let text = if value == p.value {
        with_error(p.value, p.std_error, &p.unit)
    } else {
        quantity(value, &p.unit)
    };
    ui.horizontal(|ui| {
        ui.label(tr(&p.name)).on_hover_text(tr(&hover));
        ui.label(tr(text)).on_hover_text(tr(hover));
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            interval_ui(p, ui);
        });
    });
}

/// Sets a parameter by hand.
fn slider_ui(p: &Parameter, value: &mut f64, ui: &mut egui::Ui) -> egui::Response {
    let (low, high) = ByHand::range(p);
    ui.horizontal(|ui| {
        ui.spacing_mut().slider_width = (0.45 * ui.available_width()).max(80.0);
        let slider = egui::Slider::new(value, low..=high)
            .show_value(false)
            .clamping(egui::SliderClamping::Edits);
        let slider = ui.add(slider);
        let label = ui.small(tr(&p.label));
        slider.labelled_by(label.id)
    })
    .inner
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
