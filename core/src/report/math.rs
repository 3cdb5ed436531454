//! Equations as `MathML`, which browsers set without a font or a script of ours.

use super::escape::escape;
use crate::equation::{Part, Piece, parse, pieces};

/// An equation in the line that it stands in; what the files have is its name for who copies or hears it.
pub(super) fn math(text: &str) -> String {
    format!(
        "<math aria-label=\"{}\">{}</math>",
        escape(text),
        row(&parse(text))
    )
}

/// A sentence of a page in which some of these formulas stand.
pub(super) fn sentence(text: &str, formulas: &[&str]) -> String {
    let set = pieces(text, formulas).into_iter().map(|piece| match piece {
        Piece::Words(words) => escape(words),
        Piece::Formula(formula) => math(formula),
    });
    set.collect()
}

/// Equations beneath each other.
pub(super) fn display<'a>(lines: impl IntoIterator<Item = &'a str>) -> String {
    let lines = lines.into_iter().filter(|l| !l.is_empty());
    let set: Vec<String> = lines.map(|l| format!("<p>{}</p>\n", math(l))).collect();
    format!("<div class=\"equations\">\n{}</div>\n", set.concat())
}

/// Parts behind each other; an exponent belongs to the part before it.
fn row(parts: &[Part]) -> String {
    let mut done: Vec<String> = Vec::new();
    for part in parts {
        let set = match part {
            Part::Raised(raised) => {
                let base = done.pop().unwrap_or_else(|| "<mrow></mrow>".to_owned());
                format!("<msup>{base}<mrow>{}</mrow></msup>", row(raised))
            }
            other => one(other),
        };
        done.push(set);
    }
    done.concat()
}

fn one(part: &Part) -> String {
    match part {
        Part::Plain(text) => plain(text),
        Part::Symbol { letter, index, .. } if index.is_empty() => {
            format!("<mi>{}</mi>", escape(letter))
        }
        Part::Symbol { letter, index, .. } => format!(
            "<msub><mi>{}</mi><mtext>{}</mtext></msub>",
            escape(letter),
            escape(index)
        ),
        Part::Space => "<mspace width=\"0.28em\"/>".to_owned(),
        Part::Raised(parts) | Part::Group(parts) => format!("<mrow>{}</mrow>", row(parts)),
        Part::Fraction(above, below) => format!(
            "<mfrac><mrow>{}</mrow><mrow>{}</mrow></mfrac>",
            row(above),
            row(below)
        ),
    }
}

/// A number, a word or a sign.
fn plain(text: &str) -> String {
    let tag = match text.chars().next() {
        Some(c) if c.is_ascii_digit() => "mn",
        Some(c) if c.is_alphabetic() => "mtext",
        _ => "mo",
    };
    format!("<{tag}>{}</{tag}>", escape(text))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_equation_has_indices_exponents_and_fractions() {
        let set = math("F = -k3 x^3");
        assert!(
            set.contains("<msub><mi>k</mi><mtext>3</mtext></msub>"),
            "{set}"
        );
        assert!(
            set.contains("<msup><mi>x</mi><mrow><mn>3</mn></mrow></msup>"),
            "{set}"
        );
        let set = math("J1 dv1/dt = u - <b>");
        assert!(set.contains("<mfrac><mrow><mtext>d</mtext><msub>"), "{set}");
        assert!(
            set.contains("<mo>&lt;</mo>") && !set.contains("<b>"),
            "{set}"
        );
        let set = math("exp(-((x-b)/c)^2)");
        assert!(
            set.contains("</mrow><mrow><mn>2</mn></mrow></msup>"),
            "{set}"
        );
    }
}
