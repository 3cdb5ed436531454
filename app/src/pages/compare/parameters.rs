//! Every parameter of the model with its uncertainty, and a slider that sets it by hand.

use hysteron_core::by_hand::ByHand;
use hysteron_core::diagnosis::{Parameter, Status, StepReport};
use hysteron_core::effect::{self, Effect, name_of};
use hysteron_core::message::Message;
use hysteron_core::msg;
use hysteron_core::report::baseline;
use hysteron_core::uncertain::{NORMAL_95, quantity, with_error};

use super::command::Command;
use super::state::Compare;
use crate::hook::Targets;
use crate::language::tr;
use crate::theme;
use crate::widgets::controls::reset_asked;
use crate::widgets::equation::equation_ui;

/// Size of the bar that shows an interval, points.
const BAR: egui::Vec2 = egui::vec2(70.0, 12.0);

pub(super) fn ui(
    page: &Compare,
    report: &StepReport,
    ui: &mut egui::Ui,
    targets: &mut Targets,
    commands: &mut Vec<Command>,
) {
    // In a round of guessing the question comes first.
    let guessing = page.is_guessing();
    egui::CollapsingHeader::new(tr("Parameters of the model"))
        .id_salt(("parameters", guessing))
        .default_open(!guessing)
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
            let marked = equations_ui(page, report, &values, ui);
            let before = values.clone();
            let mut let_go = false;
            let mut held = false;
            for (p, value) in report.step.parameters.iter().zip(&mut values) {
                row_ui(p, *value, marked.as_deref() == Some(p.name.as_str()), ui);
                if known && p.status != Status::Fixed {
                    let slider = slider_ui(p, value, ui);
                    targets.note(format!("hand:{}", p.name), ui, &slider);
                    let_go |= slider.drag_stopped();
                    held |= slider.dragged();
                }
            }
            let moved = values != before;
            if moved && values == fitted {
                commands.push(Command::DropHand);
            } else if moved || (let_go && hand.is_some_and(|h| h.held)) {
                commands.push(Command::Hand(values, held && !let_go));
            }
            if hand.is_some() {
                by_hand_ui(ui, targets, commands);
            } else if known {
                ui.small(tr("Drag a slider to set a value by hand and see what it does to the residual."));
            }
            ui.small(tr(
                "With one standard error. Bars: 95 % intervals, from 0 at the left to twice the value; hollow where \
                 they include 0."));
        });
}

/// The way back from values that are set by hand.
fn by_hand_ui(ui: &mut egui::Ui, targets: &mut Targets, commands: &mut Vec<Command>) {
    let back = ui.button(tr("Back to the fit"));
    targets.note("hand:back", ui, &back);
    if back.clicked() {
        commands.push(Command::DropHand);
    }
}

/// The equations of the model, with the values in them; the name of the symbol that is pointed at.
fn equations_ui(
    page: &Compare,
    report: &StepReport,
    values: &[f64],
    ui: &mut egui::Ui,
) -> Option<String> {
    let kind = page.measurement.as_ref()?.kind;
    let value = |name: &str| {
        let place = report.step.parameters.iter().position(|p| p.name == name)?;
        let p = &report.step.parameters[place];
        Some(format!(
            "{} = {}",
            tr(Message::words(p.label.clone())),
            tr(value_text(p, values[place]))
        ))
    };
    let effects = report
        .step
        .effects
        .iter()
        .filter_map(|id| effect::find(*id));
    let effects = effects.map(Effect::equation);
    let lines = baseline(kind, &report.step.parameters)
        .into_iter()
        .chain(effects);
    let mut pointed = None;
    for line in lines.filter(|line| !line.is_empty()) {
        pointed = pointed.or(equation_ui(ui, &tr(line), &value));
    }
    ui.add_space(4.0);
    pointed
}

/// The fitted value with its error, or the one that is set by hand.
fn value_text(p: &Parameter, value: f64) -> Message {
    if value == p.value {
        with_error(p.value, p.std_error, &p.unit)
    } else {
        quantity(value, &p.unit).into()
    }
}

/// Its symbol, value, meaning and interval.
fn row_ui(p: &Parameter, value: f64, marked: bool, ui: &mut egui::Ui) {
    let label = Message::words(p.label.clone());
    let hover = match p.effect {
        Some(effect) => msg!("{}, {}", label, name_of(effect)),
        None => msg!("{}, of the baseline to which effects are added", label),
    };
    let text = value_text(p, value);
    ui.horizontal(|ui| {
        if marked {
            // Its symbol is pointed at in the equation.
            let row = ui.available_rect_before_wrap();
            let row = row.with_max_y(row.top() + ui.spacing().interact_size.y);
            let fill = ui.visuals().selection.bg_fill;
            ui.painter().rect_filled(row, 3.0, fill);
        }
        equation_ui(ui, &p.name, &|_| Some(tr(&hover)));
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
        if reset_asked(ui, &slider) {
            *value = p.value;
        }
        // With its unit, for a screen reader.
        let said = tr(value_text(p, *value));
        ui.ctx()
            .accesskit_node_builder(slider.id, |node| node.set_value(said));
        let label = egui::RichText::new(tr(Message::words(p.label.clone()))).small();
        let label = ui.add(egui::Label::new(label).truncate());
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
    let share = NORMAL_95 * p.std_error / p.value.abs();
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
    response.on_hover_text(tr(msg!("95 % interval: {}", p.interval())));
}
