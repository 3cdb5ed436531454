//! Draws the little Markdown that lessons need.

use egui::RichText;

use crate::theme;
use crate::widgets::equation::equation_ui;

/// A piece of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Piece {
    Plain(&'static str),
    Strong(&'static str),
    Emphasis(&'static str),
    Formula(&'static str),
    /// Label and link.
    Link(&'static str, &'static str),
}

/// The links of a line.
pub fn links(line: &'static str) -> impl Iterator<Item = &'static str> {
    pieces(line).into_iter().filter_map(|p| match p {
        Piece::Link(_, link) => Some(link),
        _ => None,
    })
}

/// Draws the lines of a text; returns the link whose button was clicked.
pub fn ui(ui: &mut egui::Ui, lines: &[&'static str]) -> Option<&'static str> {
    let mut clicked = None;
    for line in lines {
        if line.trim().is_empty() {
            ui.add_space(4.0);
        } else if let Some(heading) = line.strip_prefix("## ") {
            ui.add_space(4.0);
            ui.strong(RichText::new(heading).size(16.0));
        } else if let Some(point) = line.strip_prefix("- ") {
            ui.horizontal_top(|ui| {
                ui.label("•");
                ui.vertical(|ui| clicked = clicked.or(line_ui(ui, point)));
            });
        } else {
            clicked = clicked.or(line_ui(ui, line));
        }
    }
    clicked
}

fn line_ui(ui: &mut egui::Ui, line: &'static str) -> Option<&'static str> {
    let pieces = pieces(line);
    let mut clicked = None;
    theme::running_text(ui, |ui| {
        ui.spacing_mut().item_spacing.x = 0.0;
        for piece in pieces {
            match piece {
                Piece::Plain(text) => {
                    ui.label(text);
                }
                Piece::Strong(text) => {
                    ui.strong(text);
                }
                Piece::Emphasis(text) => {
                    ui.label(RichText::new(text).italics());
                }
                Piece::Formula(text) if text.contains(['=', '/', '^']) => {
                    equation_ui(ui, text, &|_| None);
                }
                Piece::Formula(text) => {
                    ui.monospace(text);
                }
                Piece::Link(label, link) => {
                    if ui.button(label).clicked() {
                        clicked = Some(link);
                    }
                    ui.add_space(6.0);
                }
            }
        }
    });
    clicked
}

/// Cuts a line at its marks; a mark without its partner is text.
fn pieces(line: &'static str) -> Vec<Piece> {
    let mut pieces = Vec::new();
    let (mut plain, mut at) = (0, 0);
    while at < line.len() {
        let rest = &line[at..];
        let marked = |mark, piece: fn(&'static str) -> Piece| {
            let (text, length) = between(rest, mark, mark)?;
            (text.trim() == text).then(|| (piece(text), length))
        };
        let found = marked("**", Piece::Strong)
            .or_else(|| marked("*", Piece::Emphasis))
            .or_else(|| marked("`", Piece::Formula))
            .or_else(|| {
                let (label, first) = between(rest, "[", "]")?;
                let (link, second) = between(&rest[first..], "(", ")")?;
                Some((Piece::Link(label, link), first + second))
            });
        if let Some((piece, length)) = found {
            if plain < at {
                pieces.push(Piece::Plain(&line[plain..at]));
            }
            pieces.push(piece);
            at += length;
            plain = at;
        } else {
            at += rest.chars().next().map_or(1, char::len_utf8);
        }
    }
    if plain < at {
        pieces.push(Piece::Plain(&line[plain..]));
    }
    pieces
}

/// What stands between two marks at the beginning of a text, and the length with the marks.
fn between(text: &'static str, open: &str, close: &str) -> Option<(&'static str, usize)> {
    let inner = text.strip_prefix(open)?;
    let end = inner.find(close).filter(|end| *end > 0)?;
    Some((&inner[..end], open.len() + end + close.len()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_cut_at_its_marks() {
        assert_eq!(
            pieces("At **ε = 0.5** the `T` is *not* [half](#v1;explore) of 2 * 3 * 4 [s]."),
            [
                Piece::Plain("At "),
                Piece::Strong("ε = 0.5"),
                Piece::Plain(" the "),
                Piece::Formula("T"),
                Piece::Plain(" is "),
                Piece::Emphasis("not"),
                Piece::Plain(" "),
                Piece::Link("half", "#v1;explore"),
                Piece::Plain(" of 2 * 3 * 4 [s]."),
            ]
        );
    }
}
