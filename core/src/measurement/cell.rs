//! What stands in one field: a number, a word for on or off, or a date.

use super::clock::Clock;

/// How the numbers of a file are written.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Mark {
    /// The decimal mark, once one was seen: a file that mixes both has thousands separators in it, and those must not
    /// be read as decimals.
    seen: Option<char>,
}

impl Mark {
    /// Only a decimal point, as where commas divide the columns.
    pub const POINT: Self = Self { seen: Some('.') };

    /// A number.
    pub fn number(&mut self, text: &str) -> Option<f64> {
        let here = text
            .bytes()
            .find(|b| matches!(b, b'.' | b','))
            .map(char::from);
        if here.is_some() && self.seen.is_some() && here != self.seen {
            return None;
        }
        let number = if here == Some(',') {
            text.replacen(',', ".", 1).parse().ok()
        } else {
            text.parse().ok()
        };
        // A date has points too.
        if number.is_some() {
            self.seen = self.seen.or(here);
        }
        number
    }

    /// What a field says: a number, 1 or 0 for a word such as `on` or `False`, or the time by the clock of its column.
    pub fn value(&mut self, text: &str, clock: &mut Clock) -> Option<f64> {
        clock
            .counted(text)
            .or_else(|| self.number(text))
            .or_else(|| state(text))
            .or_else(|| clock.date(text))
    }
}

/// Words for 1 and 0, in English and German.
const STATES: [(&str, &str); 8] = [
    ("true", "false"),
    ("on", "off"),
    ("yes", "no"),
    ("open", "closed"),
    ("ein", "aus"),
    ("ja", "nein"),
    ("wahr", "falsch"),
    ("auf", "zu"),
];

/// 1 or 0 where the text is a word for it.
fn state(text: &str) -> Option<f64> {
    // Longer than any of the words, as most texts are.
    if text.len() > 6 {
        return None;
    }
    let is = |word: &str| text.eq_ignore_ascii_case(word);
    STATES.iter().find_map(|(on, off)| match (is(on), is(off)) {
        (true, _) => Some(1.0),
        (_, true) => Some(0.0),
        _ => None,
    })
}
