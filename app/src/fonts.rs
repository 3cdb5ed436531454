//! The letters of the app: a regular weight, which a projector still shows, with Greek letters and raised numbers.

use std::sync::Arc;

use egui::{FontData, FontDefinitions, FontFamily};

const TEXT: &[u8] = include_bytes!("../../assets/fonts/DejaVuSansCondensed.ttf");
const FORMULAS: &[u8] = include_bytes!("../../assets/fonts/DejaVuSansMono.ttf");

/// Has everything drawn with them from the next frame on.
pub fn apply(ctx: &egui::Context) {
    let mut fonts = FontDefinitions::empty();
    for (name, bytes) in [("text", TEXT), ("formulas", FORMULAS)] {
        let data = Arc::new(FontData::from_static(bytes));
        fonts.font_data.insert(name.to_owned(), data);
    }
    let mut family = |family, names: &[&str]| {
        let names = names.iter().map(|name| (*name).to_owned());
        fonts.families.insert(family, names.collect());
    };
    family(FontFamily::Proportional, &["text"]);
    family(FontFamily::Monospace, &["formulas", "text"]);
    ctx.set_fonts(fonts);
}
