//! Texts with columns: where the names stand, what divides the columns, and where the numbers begin.

use std::borrow::Cow;
use std::collections::BTreeMap;

use super::cell::{Mark, is_unit, with_unit};
use super::clock::Clock;
use super::controlled::as_in_the_loop;
use super::error::Problem;
use super::found::Numbers;
use super::header::{Field, has_number, name_and_unit};
use super::split::{BLANKS, split_header, split_row};
use crate::message::Message;

/// A problem and its line.
pub(super) type Located = (Option<usize>, Problem);

/// How the rows of a file are written.
#[derive(Clone, Copy)]
pub(super) struct Dialect {
    pub separator: char,
    pub mark: Mark,
}

/// A text, opened at its first row of numbers.
pub(super) struct Text<Rows> {
    /// Columns by their names; the names are empty where the first line holds numbers already.
    pub fields: Vec<Field>,
    /// The line that they stand in.
    pub line: usize,
    pub dialect: Dialect,
    /// What is to be said of the names.
    pub note: Option<Message>,
    /// Rows with their lines.
    pub rows: Rows,
}

/// Tables with which a scenario may begin.
const TABLES_OF_SCENARIO: [&str; 5] = ["plant", "relay", "run", "drive", "servo"];

/// The table with which a file begins that is a scenario.
pub(super) fn table_of_scenario(bytes: &[u8]) -> Option<&'static str> {
    let mut lines = decoded(bytes).ok()?.lines().map(str::trim);
    let first = lines.find(|line| !line.is_empty() && !line.starts_with('#'))?;
    let name = first.split('#').next()?.trim_end();
    let name = name.strip_prefix('[')?.strip_suffix(']')?.trim();
    TABLES_OF_SCENARIO.into_iter().find(|table| *table == name)
}

/// The bytes of a file in UTF-8: a text in UTF-16 says so with its first two, and has an even number of them.
pub(super) fn in_utf8(bytes: &[u8]) -> Cow<'_, [u8]> {
    let (units, low_first) = match bytes {
        [0xff, 0xfe, units @ ..] => (units, true),
        [0xfe, 0xff, units @ ..] => (units, false),
        _ => return Cow::Borrowed(bytes),
    };
    let (pairs, []) = units.as_chunks() else {
        return Cow::Borrowed(bytes);
    };
    let units = pairs.iter().map(|pair| {
        if low_first {
            u16::from_le_bytes(*pair)
        } else {
            u16::from_be_bytes(*pair)
        }
    });
    let text: Result<String, _> = char::decode_utf16(units).collect();
    text.map_or(Cow::Borrowed(bytes), |text| Cow::Owned(text.into_bytes()))
}

/// The text of a file, without its byte order mark.
pub(super) fn decoded(bytes: &[u8]) -> Result<&str, Located> {
    let end = if bytes.contains(&b'\n') { b'\n' } else { b'\r' };
    let text = std::str::from_utf8(bytes).map_err(|e| {
        let before = bytes.get(..e.valid_up_to()).unwrap_or_default();
        let line = before.split(|b| *b == end).count();
        (Some(line), Problem::NotText)
    })?;
    Ok(text.strip_prefix('\u{feff}').unwrap_or(text))
}

/// Opens a text.
pub(super) fn open(
    bytes: &[u8],
) -> Result<Text<impl Iterator<Item = (usize, &str)> + Clone>, Located> {
    // Old loggers, and some spreadsheets, end lines with a carriage return alone.
    let end = if bytes.contains(&b'\n') { b'\n' } else { b'\r' };
    let text = decoded(bytes)?;
    let lines = text
        .split(char::from(end))
        .map(|line| unwrapped(line.strip_suffix('\r').unwrap_or(line)))
        .enumerate()
        .map(|(i, line)| (i + 1, line))
        .filter(|(_, line)| !line.trim().is_empty());
    let rows = lines.clone().filter(|(_, line)| comment(line).is_none());
    let first: Vec<&str> = rows
        .clone()
        .take(LONGEST_PREAMBLE)
        .map(|(_, row)| row)
        .collect();
    let mut rows = rows.skip(preamble(&first));
    let whole = rows.clone();
    let Some((mut line, first)) = rows.next() else {
        return Err((None, Problem::Empty));
    };
    let separator = separator_of(first, rows.clone().next().map(|(_, row)| row));
    let mut dialect = Dialect {
        separator,
        mark: if separator == ',' {
            Mark::POINT
        } else {
            Mark::default()
        },
    };
    let mut names = split_header(first, separator);
    let mark = &mut dialect.mark;
    let numeric = names
        .iter()
        .all(|f| mark.value(f, &mut Clock::default()).is_some());
    let mut bare = numeric;
    let before = lines.take_while(|(at, _)| *at < line);
    if numeric && let Some((at, header)) = before.last() {
        let header = split_header(comment(header).unwrap_or_default(), separator);
        if header.len() == names.len() && header.iter().any(|f| f.parse::<f64>().is_err()) {
            (line, names, bare) = (at, header, false);
        }
    }
    let numbered = !bare && names.iter().any(|name| has_number(name));
    let field = |text: &String| {
        let (name, unit) = if bare {
            Default::default()
        } else {
            name_and_unit(text, numbered)
        };
        Field::named(name, unit)
    };
    let mut fields: Vec<Field> = names.iter().map(field).collect();
    if !bare {
        keep_apart(&mut fields, &names);
    }
    let below = rows.clone().next().filter(|_| !numeric);
    if let Some(labels) = below.and_then(|(_, row)| labels(row, separator, &fields)) {
        rows.next();
        labelled(&mut fields, labels);
    }
    if let Some((_, row)) = rows.clone().next() {
        units_of_cells(&mut fields, row, separator);
    }
    let note = as_in_the_loop(&mut fields, values(dialect, rows.clone()));
    Ok(Text {
        fields,
        line,
        dialect,
        note,
        rows: if numeric { whole } else { rows },
    })
}

/// Gives columns without a unit the one that stands behind their first number.
fn units_of_cells(fields: &mut [Field], row: &str, separator: char) {
    let mut cells = Vec::with_capacity(fields.len());
    split_row(row, separator, &mut cells);
    for (field, cell) in fields.iter_mut().zip(cells) {
        if let (None, Some((_, unit))) = (&field.unit, with_unit(cell)) {
            field.unit = Some(unit.to_owned());
        }
    }
}

/// Gives columns their whole names where only what stands in brackets, and is no unit, tells them apart: `temp (left)`
/// and `temp (right)`.
fn keep_apart(fields: &mut [Field], names: &[String]) {
    let in_words = |f: &Field| f.unit.as_deref().is_some_and(|unit| !is_unit(unit));
    // Of each name how many columns have it, and whether all of them have a word in brackets.
    let mut alike: BTreeMap<String, (usize, bool)> = BTreeMap::new();
    for field in fields.iter() {
        let (count, words) = alike.entry(field.name.clone()).or_insert((0, true));
        *count += 1;
        *words &= in_words(field);
    }
    for (field, name) in fields.iter_mut().zip(names) {
        if let Some((2.., true)) = alike.get(&field.name) {
            *field = Field::named(name.trim().to_owned(), None);
        }
    }
}

/// The values of rows; what is no number has none.
fn values<'a>(
    mut dialect: Dialect,
    rows: impl Iterator<Item = (usize, &'a str)>,
) -> impl Iterator<Item = Vec<Option<f64>>> {
    let mut texts = Vec::new();
    rows.map(move |(_, row)| {
        split_row(row, dialect.separator, &mut texts);
        let mut value = |text: &&str| dialect.mark.value(text, &mut Clock::default());
        texts.iter().map(&mut value).collect()
    })
}

/// A line without the quotes around all of its columns, which some programs write.
fn unwrapped(line: &str) -> &str {
    let inside = line
        .trim()
        .strip_prefix('"')
        .and_then(|l| l.strip_suffix('"'));
    let whole = inside.filter(|l| !l.contains('"') && l.contains([',', ';', '\t']));
    whole.unwrap_or(line)
}

/// What stands below each name, where a row has nothing but units in it, or nothing for a column without one; or where
/// the names have no units, units and names of another kind: a device calls its channels by numbers, and says below
/// what was recorded on them.
fn labels(row: &str, separator: char, fields: &[Field]) -> Option<Vec<String>> {
    let mut texts = Vec::with_capacity(fields.len());
    split_row(row, separator, &mut texts);
    // A separator at the end of every row is a habit of some loggers.
    if texts.len() == fields.len() + 1 && texts.last().is_some_and(|t| t.is_empty()) {
        texts.pop();
    }
    let bare = |text: &str| text.trim_matches(['[', ']', '(', ')']).trim().to_owned();
    let units: Vec<String> = texts.iter().map(|t| bare(t)).collect();
    // The 1 of a plain number is a unit, but a row of numbers is none.
    let says = |t: &String| !t.is_empty() && t.parse::<f64>().is_err();
    if units.len() != fields.len() || !units.iter().any(says) {
        return None;
    }
    if units.iter().all(|t| t.is_empty() || is_unit(t)) {
        return Some(units);
    }
    let words = units
        .iter()
        .all(|t| t.is_empty() || says(t) && !looks_like_a_value(t));
    let plain = fields.iter().all(|f| f.unit.is_none());
    let mixed = plain && words && units.iter().any(|t| is_unit(t));
    mixed.then(|| {
        let whole = |(unit, text): (String, &str)| {
            if is_unit(&unit) {
                unit
            } else {
                text.to_owned()
            }
        };
        units.into_iter().zip(texts).map(whole).collect()
    })
}

/// Gives columns what stands below their names: a unit, or where it is none and the name says nothing, another name.
fn labelled(fields: &mut [Field], labels: Vec<String>) {
    let alone: Vec<bool> = labels
        .iter()
        .map(|l| labels.iter().filter(|o| *o == l).count() == 1)
        .collect();
    for ((field, label), alone) in fields.iter_mut().zip(labels).zip(alone) {
        if label.is_empty() {
            continue;
        }
        if is_unit(&label) || field.role.is_some() {
            field.unit.get_or_insert(label);
        } else if alone {
            let (name, unit) = name_and_unit(&label, true);
            *field = Field {
                also: std::mem::take(&mut field.name),
                ..Field::named(name, unit)
            };
        }
    }
}

/// Most rows that are looked at for the begin of the numbers.
const LONGEST_PREAMBLE: usize = 200;

/// How many rows come before the names of the columns: what a device says about itself. None where the first row may be
/// that of the names.
fn preamble(rows: &[&str]) -> usize {
    let begins = [';', '\t', ',', BLANKS].map(|separator| begin(rows, separator));
    // Of those with which numbers begin first the one that divides most.
    let begin = begins
        .into_iter()
        .flatten()
        .min_by_key(|b| (b.row, usize::MAX - b.columns));
    let Some(begin) = begin.filter(|b| b.row > 1) else {
        return 0;
    };
    let is_header = |row: &&str| begin.may_be_header(row);
    if rows.first().is_some_and(is_header) {
        return 0;
    }
    let above = rows.get(..begin.row).unwrap_or_default();
    // Names, and units or other names below them.
    let header = above
        .iter()
        .rev()
        .take_while(|row| is_header(row))
        .count()
        .min(2);
    begin.row - header
}

/// Where numbers begin if columns are divided in this way.
struct Begin {
    row: usize,
    columns: usize,
    separator: char,
}

impl Begin {
    /// Whether the row may name the columns, or say something about each: one title beside nothing does not.
    fn may_be_header(&self, row: &str) -> bool {
        let names = split_header(row, self.separator);
        let said = names.iter().filter(|name| !name.is_empty()).count();
        // A separator may end each row.
        let alike = names.len() == self.columns || names.len() + 1 == self.columns;
        alike && (said > 1 || self.columns < 3)
    }
}

/// The first row most of whose fields are values, if the next has as many.
fn begin(rows: &[&str], separator: char) -> Option<Begin> {
    let columns = |row: &str| {
        let mut fields = Vec::new();
        split_row(row, separator, &mut fields);
        let said = fields.iter().filter(|f| !f.is_empty()).count();
        let values = fields.iter().filter(|f| looks_like_a_value(f)).count();
        (values > 1 && 2 * values > said).then_some(fields.len())
    };
    let found = rows.windows(2).enumerate().find_map(|(row, pair)| {
        let count = columns(pair.first()?)?;
        (columns(pair.last()?) == Some(count)).then_some((row, count))
    });
    let (row, columns) = found?;
    Some(Begin {
        row,
        columns,
        separator,
    })
}

/// Whether a field holds a number, a word for on or off, or a date.
fn looks_like_a_value(text: &str) -> bool {
    Mark::default().value(text, &mut Clock::default()).is_some()
}

/// What a comment says; `None` of a line that is none.
fn comment(line: &str) -> Option<&str> {
    Some(line.trim_start().strip_prefix('#')?.trim_start_matches('#'))
}

/// Columns of a text, and what their numbers are; fields that are none are passed over.
pub(super) fn survey(bytes: &[u8]) -> Result<Vec<(Field, Numbers)>, Located> {
    let Text {
        fields,
        mut dialect,
        rows,
        ..
    } = open(bytes)?;
    let mut seen = vec![(Numbers::default(), Clock::default()); fields.len()];
    let mut row = Vec::with_capacity(fields.len());
    for (_, text) in rows {
        split_row(text, dialect.separator, &mut row);
        for (field, (numbers, clock)) in row.iter().zip(&mut seen) {
            if let Some(value) = dialect.mark.value(field, clock) {
                numbers.take(value);
            }
        }
    }
    let all = fields.into_iter().zip(seen);
    let known = |(field, (mut numbers, clock)): (Field, (Numbers, Clock))| {
        numbers.dates = clock.has_dates();
        (field, numbers)
    };
    Ok(all.map(known).collect())
}

/// The separator: tab or semicolon where the header has one outside brackets, else a comma, or blanks where
/// neither the header nor the row after it has any of these and the row is divided by them.
fn separator_of(header: &str, row: Option<&str>) -> char {
    let outside = outside_brackets(header);
    let numbers = |row: &str, separator| {
        let mut fields = Vec::new();
        split_row(row, separator, &mut fields);
        let numeric = fields.iter().all(|f| looks_like_a_value(f));
        numeric.then_some(fields.len())
    };
    let blanks = |row: &&str| {
        let names = split_header(header, '\t').len();
        let tabs = outside.contains('\t') && numbers(row.trim(), '\t') == Some(names);
        !tabs && numbers(row, BLANKS).is_some_and(|count| count > 1)
    };
    if outside.contains(';') && !outside.contains('\t') {
        ';'
    } else if !outside.contains([',', ';']) && row.as_ref().is_some_and(blanks) {
        BLANKS
    } else if outside.contains('\t') {
        '\t'
    } else {
        ','
    }
}

/// A header without what stands in brackets.
fn outside_brackets(header: &str) -> String {
    let mut depth = 0;
    let outside = header.chars().filter(|c| {
        match c {
            '[' | '(' => depth += 1,
            ']' | ')' => depth -= 1,
            _ => {}
        }
        depth == 0
    });
    outside.collect()
}
