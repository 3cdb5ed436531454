//! Equations as they stand in a book: Greek letters, indices, exponents and fractions, from the text that files have.
//!
//! What is understood: `J1`, `c_s` and `u_acting` have an index, `x^3` and `e^(Ah)` an exponent, `tau` is a Greek letter,
//! and `dv1/dt`, `v / v_s` and `4k/(πa)` are fractions. Words stay words.

use std::sync::Arc;

use egui::{Color32, FontId, Galley, Painter, Pos2, Rect, Sense, Ui, Vec2, vec2};

/// Size of an index and of an exponent, by how much they are moved, and the parts of a fraction, in sizes of the letter.
const SMALL: f32 = 0.72;
const LOWERED: f32 = 0.22;
const RAISED: f32 = 0.42;
const FRACTION: f32 = 0.86;

/// Height of the middle of a letter above its line, and the gap at the bar of a fraction, in sizes of the letter.
const MIDDLE: f32 = 0.3;
const GAP: f32 = 0.06;

/// Letters by the names that they have in files.
const GREEK: [(&str, &str); 7] = [
    ("tau", "τ"),
    ("phi", "φ"),
    ("beta", "β"),
    ("pi", "π"),
    ("omega", "ω"),
    ("eps", "ε"),
    ("sigma", "σ"),
];

/// Words of one or two letters that are no symbols.
const WORDS: [&str; 14] = [
    "at", "as", "to", "in", "of", "up", "is", "if", "for", "and", "so", "zu", "bis", "in",
];

/// Symbols of two letters, of which the second is an index.
const INDEXED: [&str; 6] = ["Ku", "Tu", "Ti", "Td", "Tf", "Ms"];

/// A part of an equation.
#[derive(Clone, Debug, PartialEq)]
enum Part {
    /// Upright: a word, a number, an operator.
    Plain(String),
    /// A symbol with its index; its name is as files have it.
    Symbol {
        letter: String,
        index: String,
        name: String,
    },
    Space,
    Raised(Vec<Part>),
    Fraction(Vec<Part>, Vec<Part>),
    Group(Vec<Part>),
}

/// Draws an equation, on more lines where it needs them. What is `hovered` is the name of a symbol under the pointer.
pub fn equation_ui(
    ui: &mut Ui,
    text: &str,
    values: &dyn Fn(&str) -> Option<String>,
) -> Option<String> {
    let mut hovered = None;
    for line in text.lines() {
        let parts = parse(line);
        let size = egui::TextStyle::Body.resolve(ui.style()).size + 1.0;
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
        for row in rows {
            let (rect, response) =
                ui.allocate_exact_size(vec2(row.width, row.ascent + row.descent), Sense::hover());
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

/// Reads an equation.
fn parse(text: &str) -> Vec<Part> {
    let chars: Vec<char> = text.chars().collect();
    let mut at = 0;
    group(&chars, &mut at, None)
}

/// Reads up to a closing bracket.
fn group(chars: &[char], at: &mut usize, close: Option<char>) -> Vec<Part> {
    let mut parts: Vec<Part> = Vec::new();
    while let Some(c) = chars.get(*at).copied() {
        if Some(c) == close {
            *at += 1;
            break;
        }
        match c {
            ' ' => {
                *at += 1;
                if parts.last() != Some(&Part::Space) {
                    parts.push(Part::Space);
                }
            }
            '^' => {
                *at += 1;
                let raised = atom(chars, at, true);
                parts.push(Part::Raised(raised));
            }
            '/' if !parts.is_empty() => {
                *at += 1;
                let spaced = parts.last() == Some(&Part::Space);
                let above = numerator(&mut parts);
                if spaced && chars.get(*at) == Some(&' ') {
                    *at += 1;
                }
                let from = *at;
                let mut below = atom(chars, at, true);
                if chars.get(*at) == Some(&'^') {
                    // Of a power the brackets belong to what is raised.
                    *at = from;
                    below = atom(chars, at, false);
                    *at += 1;
                    below.push(Part::Raised(atom(chars, at, true)));
                }
                parts.push(Part::Fraction(above, below));
            }
            _ => parts.extend(atom(chars, at, false)),
        }
    }
    parts
}

/// What stands before a fraction line without a space: taken out of the parts.
fn numerator(parts: &mut Vec<Part>) -> Vec<Part> {
    if parts.last() == Some(&Part::Space) {
        parts.pop();
    }
    let is_operator = |part: &Part| match part {
        Part::Space => true,
        Part::Plain(text) => matches!(text.as_str(), "-" | "+" | "=" | "(" | "[" | "," | "|"),
        _ => false,
    };
    let from = parts.iter().rposition(is_operator).map_or(0, |i| i + 1);
    match &parts[from..] {
        [Part::Group(inner)] => {
            let inner = inner[1..inner.len() - 1].to_vec();
            parts.truncate(from);
            inner
        }
        _ => parts.split_off(from),
    }
}

/// Reads a bracket, a word, a number or an operator; of a bracket only what is in it, if it is to be `bare`.
fn atom(chars: &[char], at: &mut usize, bare: bool) -> Vec<Part> {
    let Some(c) = chars.get(*at).copied() else {
        return Vec::new();
    };
    let close = match c {
        '(' => ')',
        '[' => ']',
        '{' => '}',
        _ if c.is_alphabetic() => return word(chars, at),
        _ if c.is_ascii_digit() => {
            let rest = chars[*at..].iter();
            let digits: String = rest
                .take_while(|c| c.is_ascii_digit() || **c == '.')
                .collect();
            *at += digits.chars().count();
            return vec![Part::Plain(digits)];
        }
        _ => {
            *at += 1;
            let pair = (c, chars.get(*at).copied());
            let sign = match pair {
                ('<', Some('=')) => "≤",
                ('>', Some('=')) => "≥",
                ('*', _) => "·",
                ('-', _) => "−",
                _ => return vec![Part::Plain(c.to_string())],
            };
            *at += usize::from(matches!(sign, "≤" | "≥"));
            return vec![Part::Plain(sign.to_owned())];
        }
    };
    *at += 1;
    let inner = group(chars, at, Some(close));
    if bare {
        return inner;
    }
    let mut parts = vec![Part::Plain(c.to_string())];
    parts.extend(inner);
    parts.push(Part::Plain(close.to_string()));
    vec![Part::Group(parts)]
}

/// Reads a word or a symbol; `dv1` is the difference of a symbol.
fn word(chars: &[char], at: &mut usize) -> Vec<Part> {
    let in_word = |c: &&char| c.is_alphanumeric() || **c == '_';
    let text: String = chars[*at..].iter().take_while(in_word).collect();
    *at += text.chars().count();
    if WORDS.contains(&text.as_str()) {
        return vec![Part::Plain(text)];
    }
    if let Some(symbol) = symbol(&text) {
        return vec![symbol];
    }
    if let Some(symbol) = text.strip_prefix('d').and_then(symbol) {
        return vec![Part::Plain("d".to_owned()), symbol];
    }
    // Letters of a product stand together, as in 4k.
    vec![Part::Plain(text)]
}

/// A letter with an index, if it is one.
fn symbol(text: &str) -> Option<Part> {
    let (base, index) = match text.split_once('_') {
        Some((base, index)) => (base, index),
        None => text.split_at(
            text.find(|c: char| c.is_ascii_digit())
                .unwrap_or(text.len()),
        ),
    };
    let greek = GREEK.iter().find(|(name, _)| *name == base);
    let letter = greek.map_or(base, |(_, letter)| letter);
    let short = letter.chars().count() == 1;
    let digits = text.contains('_') || index.chars().all(|c| c.is_ascii_digit());
    let (letter, index) = if INDEXED.contains(&text) {
        text.split_at(1)
    } else if short && digits {
        (letter, index)
    } else {
        return None;
    };
    Some(Part::Symbol {
        letter: letter.to_owned(),
        index: index.to_owned(),
        name: text.to_owned(),
    })
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

#[cfg(test)]
mod tests {
    use super::*;

    /// The parts as one line: _ for an index, ^ for an exponent, a//b for a fraction.
    fn read(parts: &[Part]) -> String {
        let part = |part: &Part| match part {
            Part::Plain(text) => text.clone(),
            Part::Space => " ".to_owned(),
            Part::Symbol { letter, index, .. } if index.is_empty() => letter.clone(),
            Part::Symbol { letter, index, .. } => format!("{letter}_{index}"),
            Part::Raised(parts) => format!("^{{{}}}", read(parts)),
            Part::Fraction(above, below) => format!("{{{}//{}}}", read(above), read(below)),
            Part::Group(parts) => read(parts),
        };
        parts.iter().map(part).collect()
    }

    #[test]
    fn a_text_becomes_an_equation() {
        for (text, typeset) in [
            ("J1 dv1/dt = u - d1 v1", "J_1 {dv_1//dt} = u − d_1 v_1"),
            ("u_acting(t) = u(t - tau)", "u_acting(t) = u(t − τ)"),
            ("exp(-(v / v_s)^2) sgn(v)", "exp(−({v//v_s})^{2}) sgn(v)"),
            ("Ku = 4k/(πa)", "K_u = {4k//πa}"),
            ("F = -k3 x^3", "F = −k_3 x^{3}"),
            ("e^(Ah) x0", "e^{Ah} x_0"),
            (
                "C(s) = K (1 + 1/(Ti s) + Td s/(Tf s + 1))",
                "C(s) = K (1 + {1//T_i s} + T_d {s//T_f s + 1})",
            ),
            ("as long as |input| <= c", "as long as |input| ≤ c"),
            ("y/K", "{y//K}"),
            ("P(s) = 1/(s+1)^3", "P(s) = {1//(s+1)^{3}}"),
            ("(s+2)^2/(s+1)", "{(s+2)^{2}//s+1}"),
            ("a/x^2", "{a//x^{2}}"),
        ] {
            assert_eq!(read(&parse(text)), typeset);
        }
    }

    #[test]
    fn whatever_stands_there_is_read() {
        for text in [
            "", "/", "^", "a/", "((", "))", "a^", "_", "x__1", "1/0/2", "é^é/é",
        ] {
            parse(text);
        }
    }
}
