//! Logs of names with values, one record a line: `t: 0.01 u: 3 y: 2.5`, also `t=0.01, u=3 V`.

use super::cell::{Mark, with_unit};
use super::clock::Clock;
use super::series::{Builder, Series};
use super::text::decoded;

/// Lines that are looked at to tell what a file is.
const LOOKED_AT: usize = 20;

/// Fewest values of a line, without which it may be a heading of anything.
const FEWEST: usize = 2;

/// The series of a log, by name; `None` where the file is none.
pub(super) fn read(bytes: &[u8]) -> Option<Vec<Series>> {
    let text = decoded(bytes).ok()?;
    let records = || {
        text.lines()
            .map(pairs)
            .filter(|pairs| pairs.len() >= FEWEST)
    };
    let lines = text.lines().filter(|line| !line.trim().is_empty());
    let first = lines
        .take(LOOKED_AT)
        .map(|line| pairs(line).len() >= FEWEST);
    let (are, all) = first.fold((0, 0), |(are, all), is| (are + usize::from(is), all + 1));
    if 2 * are <= all {
        return None;
    }
    let mut builder = Builder::new(bytes.len());
    for (row, record) in records().enumerate() {
        for pair in record {
            builder.text(pair.name, row, pair.value);
            if !pair.unit.is_empty() {
                builder.unit(pair.name, pair.unit);
            }
        }
    }
    Some(builder.finish())
}

/// A name with its value.
#[derive(Debug, PartialEq)]
struct Pair<'a> {
    name: &'a str,
    value: &'a str,
    unit: &'a str,
}

/// The pairs of a line. A name begins with a letter; a unit may follow the value, with a blank before it or without.
fn pairs(line: &str) -> Vec<Pair<'_>> {
    let mut pairs: Vec<Pair<'_>> = Vec::new();
    let mut rest = line;
    while let Some(mark) = rest.find([':', '=']) {
        let before = &rest[..mark];
        let after = rest[mark + 1..].trim_start();
        let name = before.trim_end();
        let name = &name[name.rfind(is_between).map_or(0, |i| i + char_len(name, i))..];
        let end = after.find(is_between).unwrap_or(after.len());
        let (word, unit) = divided(&after[..end]);
        if name.starts_with(char::is_alphabetic) && !word.is_empty() {
            let next = after[end..].trim_start();
            let following = next.find(is_between).map_or(next, |i| &next[..i]);
            let alone = !following.contains([':', '='])
                && !next[following.len()..].trim_start().starts_with([':', '=']);
            let unit = if unit.is_empty() && alone {
                following
            } else {
                unit
            };
            pairs.push(Pair {
                name,
                value: word,
                unit,
            });
            rest = &after[end..];
        } else {
            rest = &rest[mark + 1..];
        }
    }
    pairs
}

/// What stands between pairs.
fn is_between(c: char) -> bool {
    c.is_whitespace() || matches!(c, ',' | ';' | '|' | '{' | '}' | '"')
}

fn char_len(text: &str, at: usize) -> usize {
    text[at..].chars().next().map_or(1, char::len_utf8)
}

/// A value and the unit at its end.
fn divided(word: &str) -> (&str, &str) {
    let bare = with_unit(word).is_none();
    if bare && Mark::default().value(word, &mut Clock::default()).is_some() {
        return (word, "");
    }
    // The longest begin that is a number.
    let ends = word.char_indices().map(|(i, _)| i).skip(1);
    let number = ends.filter(|i| word[..*i].parse::<f64>().is_ok()).last();
    number.map_or(("", ""), |end| word.split_at(end))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(line: &str) -> Vec<(&str, &str, &str)> {
        pairs(line)
            .into_iter()
            .map(|p| (p.name, p.value, p.unit))
            .collect()
    }

    #[test]
    fn a_line_has_names_with_values_and_units() {
        for line in [
            "t: 0.01 u: 3 y: 2",
            "t=0.01,u=3,y=2",
            "t = 0.01; u = 3; y = 2",
            "[12] t:0.01 | u:3 | y:2",
        ] {
            assert_eq!(
                found(line),
                [("t", "0.01", ""), ("u", "3", ""), ("y", "2", "")],
                "{line}"
            );
        }
        assert_eq!(
            found("t: 10 ms, u: -3.5V temp=2e1 degC"),
            [
                ("t", "10", "ms"),
                ("u", "-3.5", "V"),
                ("temp", "2e1", "degC")
            ]
        );
        assert_eq!(
            found("heater: on at: 2025-01-01T10:00:00Z"),
            [("heater", "on", ""), ("at", "2025-01-01T10:00:00Z", "")]
        );
        assert!(found("12:30:01").is_empty() && found("t [s],u [N m]").is_empty());
    }
}
