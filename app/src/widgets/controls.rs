//! What the controls of several pages share.

use std::ops::RangeInclusive;

use hysteron_core::figures::Check;
use hysteron_core::msg;

use crate::language::tr;
use crate::theme;
use crate::widgets::typed::{DECIMALS, Typed};

/// A slider over `value * scale`, reset by a double click or by Delete. A value from elsewhere (a map, a dragged line,
/// a link) may lie beyond the slider and stays.
pub fn slider(
    ui: &mut egui::Ui,
    value: &mut f64,
    normal: f64,
    scale: f64,
    range: RangeInclusive<f64>,
    label: &'static str,
) -> egui::Response {
    let mut shown = *value * scale;
    let unit = label.strip_suffix(']').and_then(|l| l.rsplit_once('['));
    let unit = unit.map_or("", |(_, unit)| unit);
    let slider = Typed::new(shown, unit, range, DECIMALS)
        .slider(ui.ctx(), &mut shown)
        .text(tr(label))
        .clamping(egui::SliderClamping::Edits);
    let response = ui.add(slider);
    if reset_asked(ui, &response) {
        *value = normal;
    } else if response.changed() {
        *value = shown / scale;
    }
    response
}

/// The slider of how much stronger a relay pushes up than down.
pub fn asymmetry_slider(ui: &mut egui::Ui, value: &mut f64, normal: f64) {
    slider(ui, value, normal, 1.0, -0.6..=0.6, "asymmetry α")
        .on_hover_text(tr("How much stronger it pushes up than down"));
}

/// The slider of the delay of a relay in a loop, up to so many s.
pub fn delay_slider(ui: &mut egui::Ui, value: &mut f64, normal: f64, longest: f64) {
    slider(ui, value, normal, 1.0, 0.0..=longest, "delay [s]")
        .on_hover_text(tr("How long after the switch the relay's output changes"));
}

/// Whether a slider is to be set back: by a double click, or by Delete.
pub fn reset_asked(ui: &egui::Ui, response: &egui::Response) -> bool {
    track_double_clicked(ui, response) || reset_by_key(ui, response)
}

/// Whether the slider itself was double-clicked, not the number beside it: that one takes what is typed.
/// egui's sliders sense drags only, so that they never say that they were clicked.
fn track_double_clicked(ui: &egui::Ui, response: &egui::Response) -> bool {
    let mut track = response.rect;
    track.set_width(ui.spacing().slider_width);
    let pointer = ui.input(|i| {
        let twice = i
            .pointer
            .button_double_clicked(egui::PointerButton::Primary);
        twice.then(|| i.pointer.interact_pos()).flatten()
    });
    response.enabled()
        && pointer.is_some_and(|at| track.contains(at) && response.contains_pointer())
}

/// Whether Delete was pressed while the slider, or the number beside it, had the keyboard; not while a number
/// is typed, where that key belongs to the text.
fn reset_by_key(ui: &egui::Ui, response: &egui::Response) -> bool {
    response.has_focus()
        && !ui.ctx().text_edit_focused()
        && ui.input(|i| i.key_pressed(egui::Key::Delete))
}

/// What a figure of the paper claims, and whether it is so with what is set now.
pub fn claim_ui(
    ui: &mut egui::Ui,
    number: u32,
    title: &'static str,
    claim: &'static str,
    checks: &[Check],
) {
    ui.strong(tr(msg!("Fig. {}, {}. {}", number, title, claim)));
    ui.horizontal_wrapped(|ui| {
        for (i, check) in checks.iter().enumerate() {
            let (mark, color) = if check.holds {
                ("yes:", theme::NOISE)
            } else {
                ("no:", theme::MODEL)
            };
            ui.colored_label(theme::readable(ui, color), tr(mark));
            let end = if i + 1 == checks.len() { "." } else { ";" };
            ui.label(format!("{}{end}", tr(&check.text)));
        }
    });
}
