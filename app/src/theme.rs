//! Colours and sizes. One quantity has one colour everywhere (Okabe and Ito's colour-blind-safe set).

use egui::Color32;

/// What was measured.
pub const MEASURED: Color32 = Color32::from_rgb(0x56, 0xB4, 0xE9);
/// What the model says.
pub const MODEL: Color32 = Color32::from_rgb(0xD5, 0x5E, 0x00);
/// The difference.
pub const RESIDUAL: Color32 = Color32::from_rgb(0xCC, 0x79, 0xA7);
/// The measurement noise.
pub const NOISE: Color32 = Color32::from_rgb(0x00, 0x9E, 0x73);
/// The relay's output.
pub const INPUT: Color32 = Color32::from_rgb(0xE6, 0x9F, 0x00);
/// What the describing function predicts.
pub const DESCRIBING: Color32 = Color32::from_rgb(0xE6, 0x9F, 0x00);
/// The exact solution.
pub const EXACT: Color32 = Color32::from_rgb(0x00, 0x9E, 0x73);
/// The simulation.
pub const SIMULATED: Color32 = Color32::from_rgb(0x56, 0xB4, 0xE9);
/// Where the model fails.
pub const SHADE: Color32 = Color32::from_rgb(0xF0, 0xE4, 0x42);

/// Type sizes and spacing, large enough for the back row of a lecture hall.
pub fn apply(ctx: &egui::Context) {
    // The default greys are too faint for a projector.
    ctx.style_mut_of(egui::Theme::Dark, |style| {
        style.visuals.override_text_color = Some(Color32::from_gray(225));
    });
    ctx.style_mut_of(egui::Theme::Light, |style| {
        style.visuals.override_text_color = Some(Color32::from_gray(20));
    });
    ctx.all_styles_mut(|style| {
        use egui::{FontId, TextStyle};
        style
            .text_styles
            .insert(TextStyle::Body, FontId::proportional(14.5));
        style
            .text_styles
            .insert(TextStyle::Button, FontId::proportional(14.5));
        style
            .text_styles
            .insert(TextStyle::Small, FontId::proportional(12.0));
        style
            .text_styles
            .insert(TextStyle::Heading, FontId::proportional(20.0));
        style.spacing.item_spacing = egui::vec2(8.0, 6.0);
        style.spacing.button_padding = egui::vec2(10.0, 4.0);
        style.spacing.slider_width = 150.0;
    });
}

/// The large answer of a page.
pub fn answer_ui(ui: &mut egui::Ui, text: &str) {
    ui.add(egui::Label::new(egui::RichText::new(text).size(24.0).strong()).wrap());
}

/// A curve's colour as text: darker on a light ground, where it would be too faint to read.
pub fn readable(ui: &egui::Ui, color: Color32) -> Color32 {
    if ui.visuals().dark_mode {
        color
    } else {
        color.lerp_to_gamma(Color32::BLACK, 0.4)
    }
}
