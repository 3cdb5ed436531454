//! Words in which symbols stand as in an equation: their letter slanted, their index small and below the line. What is
//! read aloud, searched for or copied is the text as it was.

use egui::text::LayoutJob;
use egui::{Align, Color32, FontId, TextFormat, TextStyle, Ui};
use hysteron_core::equation::{Part, indexed};

/// Size of an index, in sizes of the letter.
pub const INDEX: f32 = 0.72;

/// Height of the line of an index that stands on the bottom of a row, in sizes of the letter: so low that the index is
/// as far below as in an equation.
const INDEX_LINE: f32 = 0.53;

/// Words in letters of this font and colour.
pub fn job(words: &str, font: FontId, color: Color32) -> LayoutJob {
    let plain = TextFormat::simple(font.clone(), color);
    let letter = TextFormat {
        italics: true,
        ..plain.clone()
    };
    let below = TextFormat {
        line_height: Some(INDEX_LINE * font.size),
        valign: Align::BOTTOM,
        ..TextFormat::simple(FontId::new(INDEX * font.size, font.family), color)
    };
    let mut job = LayoutJob::default();
    for part in indexed(words) {
        match part {
            Part::Symbol {
                letter: symbol,
                index,
                ..
            } => {
                job.append(&symbol, 0.0, letter.clone());
                job.append(&index, 0.0, below.clone());
            }
            Part::Plain(words) => job.append(&words, 0.0, plain.clone()),
            // A sentence has no more.
            Part::Space | Part::Raised(_) | Part::Fraction(..) | Part::Group(_) => {}
        }
    }
    job
}

/// Words as labels have them.
pub fn body(ui: &Ui, words: &str) -> LayoutJob {
    styled(ui, words, &TextStyle::Body)
}

/// Small ones.
pub fn small(ui: &Ui, words: &str) -> LayoutJob {
    styled(ui, words, &TextStyle::Small)
}

/// Those of a heading.
pub fn strong(ui: &Ui, words: &str) -> LayoutJob {
    let font = TextStyle::Body.resolve(ui.style());
    job(words, font, ui.visuals().strong_text_color())
}

fn styled(ui: &Ui, words: &str, style: &TextStyle) -> LayoutJob {
    job(words, style.resolve(ui.style()), Color32::PLACEHOLDER)
}
