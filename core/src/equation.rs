//! Equations as they stand in a book, read from the text that files have.
//!
//! What is understood: `J1`, `c_s` and `u_acting` have an index, `x^3` and `e^(Ah)` an exponent, `tau` is a Greek
//! letter, and `dv1/dt`, `v / v_s` and `4k/(πa)` are fractions. Words stay words.

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
pub enum Part {
    /// Upright: a word, a number, an operator.
    Plain(String),
    /// A symbol with its index; its name is as files have it.
    Symbol {
        /// The letter, Greek ones as such.
        letter: String,
        /// Its index; may be empty.
        index: String,
        /// The whole as files have it.
        name: String,
    },
    /// Between two parts.
    Space,
    /// An exponent of what stands before it.
    Raised(Vec<Part>),
    /// What stands above and below a line.
    Fraction(Vec<Part>, Vec<Part>),
    /// What stands in brackets, with them.
    Group(Vec<Part>),
}

/// Reads an equation.
pub fn parse(text: &str) -> Vec<Part> {
    let chars: Vec<char> = text.chars().collect();
    let mut at = 0;
    group(&chars, &mut at, None)
}

/// A piece of a sentence.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Piece<'t> {
    /// Words.
    Words(&'t str),
    /// A formula between them.
    Formula(&'t str),
}

/// A sentence in which some of these formulas stand, cut into words and formulas.
pub fn pieces<'t>(text: &'t str, formulas: &[&str]) -> Vec<Piece<'t>> {
    let mut pieces = Vec::new();
    let mut rest = text;
    loop {
        // Of those that begin at one place the longest: one may begin another.
        let places = formulas.iter().filter(|f| !f.is_empty());
        let places = places.filter_map(|f| Some((rest.find(f)?, f.len())));
        let first = places.min_by_key(|(at, length)| (*at, usize::MAX - length));
        let (at, length) = first.unwrap_or((rest.len(), 0));
        let (words, more) = rest.split_at(at);
        if !words.is_empty() {
            pieces.push(Piece::Words(words));
        }
        if length == 0 {
            return pieces;
        }
        let (formula, more) = more.split_at(length);
        pieces.push(Piece::Formula(formula));
        rest = more;
    }
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
    fn formulas_are_found_in_a_sentence() {
        let text = "F = a*x^2 with a = 2. It is not told from a*x or a*x^3.";
        let found = pieces(text, &["a*x", "a*x^2", "a*x^3", "b"]);
        assert_eq!(
            found,
            [
                Piece::Words("F = "),
                Piece::Formula("a*x^2"),
                Piece::Words(" with a = 2. It is not told from "),
                Piece::Formula("a*x"),
                Piece::Words(" or "),
                Piece::Formula("a*x^3"),
                Piece::Words("."),
            ]
        );
        assert_eq!(pieces("none", &[""]), [Piece::Words("none")]);
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
