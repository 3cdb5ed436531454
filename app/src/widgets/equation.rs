//! Equations drawn as they stand in a book: Greek letters, indices, exponents and fractions, from the text that files
//! have; how that is read says `hysteron_core::equation`.

use std::sync::Arc;

use egui::{Color32, FontId, Galley, Painter, Pos2, Rect, Sense, Ui, Vec2, vec2};
use hysteron_core::equation::{Part, Piece, parse, pieces};

/// Size of an index and of an exponent, by how much they are moved, and the parts of a fraction, in sizes of the
/// letter.
const SMALL: f32 = 0.72;
const LOWERED: f32 = 0.22;
const RAISED: f32 = 0.42;
const FRACTION: f32 = 0.86;

/// Height of the middle of a letter above its line, and the gap at the bar of a fraction, in sizes of the letter.
const MIDDLE: f32 = 0.3;
const GAP: f32 = 0.06;

/// Draws an equation, on more lines where it needs them. What is `hovered` is the name of a symbol under the pointer.
pub fn equation_ui(
    ui: &mut Ui,
    text: &str,
    values: &dyn Fn(&str) -> Option<String>,
) -> Option<String> {
    let size = egui::TextStyle::Body.resolve(ui.style()).size + 1.0;
    sized_equation_ui(ui, text, size, values)
}

/// The same in letters of this size, points.
pub fn sized_equation_ui(
    ui: &mut Ui,
    text: &str,
    size: f32,
    values: &dyn Fn(&str) -> Option<String>,
) -> Option<String> {
    let mut hovered = None;
    for line in text.lines() {
        let parts = parse(line);
        let color = ui.visuals().text_color();
        let pieces: Vec<Laid> = split(&parts)
            .iter()
            .map(|parts| Laid::row(ui.painter(), parts, size, color))
            .collect();
        let room = ui.available_width();
        // Lines of pieces, as many on each as there is room for.
        let mut rows: Vec<Laid> = Vec::new();
        for piece in pieces {
            match rows.last_mut() {
                Some(row) if row.width + piece.width <= room => row.append(piece),
                _ => rows.push(piece),
            }
        }
        for (index, row) in rows.into_iter().enumerate() {
            let (rect, response) =
                ui.allocate_exact_size(vec2(row.width, row.ascent + row.descent), Sense::hover());
            // A screen reader says the whole line once.
            if index == 0 {
                response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Label, true, line));
            }
            let origin = rect.left_top() + vec2(0.0, row.ascent);
            row.paint(ui.painter(), origin, color);
            let pointer = response.hover_pos();
            let symbol = pointer.and_then(|at| row.symbol_at(at - origin.to_vec2()));
            if let Some((name, place)) = symbol {
                let frame = place.translate(origin.to_vec2()).expand(1.0);
                let stroke = ui.visuals().selection.stroke;
                ui.painter()
                    .rect_stroke(frame, 2.0, stroke, egui::StrokeKind::Outside);
                if let Some(value) = values(name) {
                    response.on_hover_text(value);
                }
                hovered = Some(name.to_owned());
            }
        }
    }
    hovered
}

/// Draws a sentence in which some of these formulas stand, and sets them.
pub fn sentence_ui(ui: &mut Ui, text: &str, formulas: &[&str]) {
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 0.0;
        for piece in pieces(text, formulas) {
            match piece {
                Piece::Words(words) => {
                    ui.label(words);
                }
                Piece::Formula(formula) => {
                    equation_ui(ui, formula, &|_| None);
                }
            }
        }
    });
}

/// Parts of an equation between which a line may break: behind spaces.
fn split(parts: &[Part]) -> Vec<Vec<Part>> {
    let mut pieces = vec![Vec::new()];
    for part in parts {
        if let Some(last) = pieces.last_mut() {
            last.push(part.clone());
        }
        if *part == Part::Space {
            pieces.push(Vec::new());
        }
    }
    pieces
}

/// Parts with their places, about the begin of the line on which they stand.
#[derive(Default)]
struct Laid {
    texts: Vec<(Vec2, Arc<Galley>)>,
    bars: Vec<(Vec2, f32)>,
    symbols: Vec<(String, Rect)>,
    width: f32,
    ascent: f32,
    descent: f32,
}

impl Laid {
    fn row(painter: &Painter, parts: &[Part], size: f32, color: Color32) -> Self {
        let mut row = Self {
            ascent: 0.8 * size,
            descent: 0.25 * size,
            ..Self::default()
        };
        for part in parts {
            row.append(Self::part(painter, part, size, color));
        }
        row
    }

    fn part(painter: &Painter, part: &Part, size: f32, color: Color32) -> Self {
        match part {
            Part::Plain(text) => Self::text(painter, text, size, color, false),
            Part::Space => Self {
                width: 0.28 * size,
                ..Self::default()
            },
            Part::Group(parts) => Self::row(painter, parts, size, color),
            Part::Symbol {
                letter,
                index,
                name,
            } => {
                let mut laid = Self::text(painter, letter, size, color, true);
                let mut below = Self::text(painter, index, SMALL * size, color, false);
                below.shift(vec2(0.0, LOWERED * size));
                laid.append(below);
                let place = Rect::from_min_max(
                    Pos2::new(0.0, -laid.ascent),
                    Pos2::new(laid.width, laid.descent),
                );
                laid.symbols.push((name.clone(), place));
                laid
            }
            Part::Raised(parts) => {
                let mut raised = Self::row(painter, parts, SMALL * size, color);
                raised.shift(vec2(0.0, -RAISED * size));
                raised
            }
            Part::Fraction(above, below) => {
                let [mut above, mut below] =
                    [above, below].map(|p| Self::row(painter, p, FRACTION * size, color));
                let width = above.width.max(below.width) + 0.2 * size;
                let (middle, gap) = (-MIDDLE * size, GAP * size);
                above.shift(vec2(
                    0.5 * (width - above.width),
                    middle - gap - above.descent,
                ));
                below.shift(vec2(
                    0.5 * (width - below.width),
                    middle + gap + below.ascent,
                ));
                let mut laid = above;
                laid.width = 0.0;
                below.width = width;
                laid.append(below);
                laid.bars.push((vec2(0.0, middle), width));
                laid
            }
        }
    }

    fn text(painter: &Painter, text: &str, size: f32, color: Color32, slanted: bool) -> Self {
        if text.is_empty() {
            return Self::default();
        }
        let mut job = egui::text::LayoutJob::default();
        let format = egui::TextFormat {
            font_id: FontId::proportional(size),
            color,
            italics: slanted,
            ..Default::default()
        };
        job.append(text, 0.0, format);
        let galley = painter.layout_job(job);
        let ascent = galley.rows.first().map_or(0.8 * size, |row| {
            row.glyphs.first().map_or(0.8 * size, |glyph| glyph.pos.y)
        });
        Self {
            width: galley.size().x,
            ascent: 0.8 * size,
            descent: 0.25 * size,
            texts: vec![(vec2(0.0, -ascent), galley)],
            ..Self::default()
        }
    }

    fn shift(&mut self, by: Vec2) {
        self.ascent -= by.y;
        self.descent += by.y;
        self.texts.iter_mut().for_each(|(at, _)| *at += by);
        self.bars.iter_mut().for_each(|(at, _)| *at += by);
        for (_, rect) in &mut self.symbols {
            *rect = rect.translate(by);
        }
        self.width += by.x.max(0.0);
    }

    /// Puts another one behind it.
    fn append(&mut self, mut other: Self) {
        let (width, along) = (other.width, self.width);
        other.shift(vec2(along, 0.0));
        self.texts.extend(other.texts);
        self.bars.extend(other.bars);
        self.symbols.extend(other.symbols);
        self.width = along + width;
        self.ascent = self.ascent.max(other.ascent);
        self.descent = self.descent.max(other.descent);
    }

    fn paint(&self, painter: &Painter, origin: Pos2, color: Color32) {
        for (at, galley) in &self.texts {
            painter.galley(origin + *at, Arc::clone(galley), color);
        }
        for (at, width) in &self.bars {
            let from = origin + *at;
            painter.hline(from.x..=from.x + width, from.y, (1.0, color));
        }
    }

    /// The symbol at a place.
    fn symbol_at(&self, at: Pos2) -> Option<(&str, Rect)> {
        let found = self.symbols.iter().find(|(_, rect)| rect.contains(at));
        found.map(|(name, rect)| (name.as_str(), *rect))
    }
}
