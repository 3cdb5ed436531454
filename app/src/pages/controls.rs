//! What the controls of several pages share.

use std::ops::RangeInclusive;

use hysteron_core::figures::Check;

use crate::theme;

/// A slider over `value * scale`, reset by a double click. A value from elsewhere (a map, a dragged line, a
/// link) may lie beyond the slider and stays.
pub fn slider(
    ui: &mut egui::Ui,
    value: &mut f64,
    normal: f64,
    scale: f64,
    range: RangeInclusive<f64>,
    label: &str,
) -> egui::Response {
    let mut shown = *value * scale;
    let response = ui.add(
        egui::Slider::new(&mut shown, range)
            .text(label)
            .max_decimals(3)
            .clamping(egui::SliderClamping::Edits),
    );
    if response.double_clicked() {
        *value = normal;
    } else if response.changed() {
        *value = shown / scale;
    }
    response
}

/// What a figure of the paper claims, and whether it is so with what is set now.
pub fn claim_ui(ui: &mut egui::Ui, number: u32, title: &str, claim: &str, checks: &[Check]) {
    ui.strong(format!("Fig. {number}, {title}. {claim}"));
    ui.horizontal_wrapped(|ui| {
        for (i, check) in checks.iter().enumerate() {
            let (mark, color) = if check.holds {
                ("yes:", theme::NOISE)
            } else {
                ("no:", theme::MODEL)
            };
            ui.colored_label(color, mark);
            let end = if i + 1 == checks.len() { "." } else { ";" };
            ui.label(format!("{}{end}", check.text));
        }
    });
}
