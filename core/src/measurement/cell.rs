//! What stands in one field: a number, a word for on or off, or a date.

use super::clock::Clock;
use super::resembling::is_of_process;
use super::unit::parse_input;

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

    /// A number. With both marks in it the first parts its thousands.
    pub fn number(&mut self, text: &str) -> Option<f64> {
        let mark = |c: char| matches!(c, '.' | ',');
        let last = text.chars().rfind(|c| mark(*c));
        if last.is_some() && self.seen.is_some() && last != self.seen {
            return None;
        }
        let number = match last {
            Some(decimal) if text.contains(|c| mark(c) && c != decimal) => grouped(text, decimal),
            Some(',') => text.replacen(',', ".", 1).parse().ok(),
            _ => text.parse().ok(),
        };
        // A date has points too.
        if number.is_some() {
            self.seen = self.seen.or(last);
        }
        number
    }

    /// What a field says: a number, also with its unit behind it, 1 or 0 for a word such as `on` or `False`, or the
    /// time by the clock of its column.
    pub fn value(&mut self, text: &str, clock: &mut Clock) -> Option<f64> {
        clock
            .counted(text)
            .or_else(|| self.number(text))
            .or_else(|| state(text))
            .or_else(|| clock.date(text))
            .or_else(|| self.number(with_unit(text)?.0))
    }
}

/// A number whose thousands are parted by the other mark than that of its decimals: 2.101,7 or 1,234.5.
fn grouped(text: &str, decimal: char) -> Option<f64> {
    let (whole, decimals) = text.split_once(decimal)?;
    let unsigned = whole.trim_start_matches(['-', '+']);
    let mut groups = unsigned.split(['.', ',']);
    let digits = |part: &str| part.bytes().all(|b| b.is_ascii_digit());
    let leading = groups.next()?;
    let apart = (1..=3).contains(&leading.len())
        && digits(leading)
        && groups.all(|group| group.len() == 3 && digits(group));
    let plain = whole.replace(['.', ','], "");
    apart
        .then(|| format!("{plain}.{decimals}").parse().ok())
        .flatten()
}

/// The number and the unit of a field that has both, such as `21.0 °C`.
pub(super) fn with_unit(text: &str) -> Option<(&str, &str)> {
    let end = text.rfind(|c: char| c.is_ascii_digit())? + 1;
    let (number, unit) = (&text[..end], text[end..].trim());
    let named = unit.contains(|c: char| c.is_alphabetic() || matches!(c, '%' | '°'));
    (named && is_unit(unit)).then_some((number, unit))
}

/// Whether it is a unit that a column may have.
pub(super) fn is_unit(text: &str) -> bool {
    parse_input(text).is_some() || is_of_process(text)
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

#[cfg(test)]
mod tests {
    use super::*;

    fn numbers(texts: &[&str]) -> Vec<Option<f64>> {
        let mut mark = Mark::default();
        texts.iter().map(|text| mark.number(text)).collect()
    }

    #[test]
    fn thousands_are_parted_by_the_other_mark_only() {
        assert_eq!(
            numbers(&["2.101,7", "-12.345.678,5", "0,25", "2.101", "1,5.2"]),
            [Some(2101.7), Some(-12_345_678.5), Some(0.25), None, None]
        );
        assert_eq!(
            numbers(&["1,234.5", "21,017", "12,34.5"]),
            [Some(1234.5), None, None]
        );
        assert_eq!(numbers(&["21,017", "1,2"]), [Some(21.017), Some(1.2)]);
    }

    #[test]
    fn a_number_may_have_its_unit_behind_it() {
        for (text, parts) in [
            ("21.017 °C", Some(("21.017", "°C"))),
            ("-5e-3mA", Some(("-5e-3", "mA"))),
            ("40%", Some(("40", "%"))),
            ("5", None),
            ("5 -", None),
            ("5 apples", None),
            ("°C", None),
        ] {
            assert_eq!(with_unit(text), parts, "{text}");
        }
    }
}
