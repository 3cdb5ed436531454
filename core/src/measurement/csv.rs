//! Comma-separated files, as people have them.

use super::error::{ImportError, Problem};
use super::header::{Header, Role, understand};
use super::{Channel, Kind, MIN_SAMPLES, Measurement, Quantity};

/// How the numbers of a file are written.
#[derive(Clone, Copy)]
struct Dialect {
    separator: u8,
    decimal_comma: bool,
}

/// Reads a CSV file.
///
/// The header names the columns with units in brackets: `t [s],u [N m],x1 [rad],v1 [rad/s]` for a
/// drive, `t [s],u [1],y [1]` for a process. Separated by comma, semicolon or tab; with the latter
/// two a decimal comma is understood. Lines that start with `#` are comments. Everything but the
/// signals of a process is converted to SI units. `kind` is guessed from the columns if not given.
///
/// # Errors
/// One line that names file, line and column and says what was expected.
pub fn import_csv(name: &str, bytes: &[u8], kind: Option<Kind>) -> Result<Measurement, ImportError> {
    let fail = |line: Option<usize>, column: Option<String>, problem| ImportError {
        file: name.to_owned(),
        line,
        column,
        problem,
    };
    let text = std::str::from_utf8(bytes).map_err(|_| fail(None, None, Problem::NotText))?;
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut lines = text
        .lines()
        .enumerate()
        .map(|(i, line)| (i + 1, line))
        .filter(|(_, line)| !line.trim().is_empty() && !line.trim_start().starts_with('#'));
    let Some((header_line, first)) = lines.next() else {
        return Err(fail(None, None, Problem::Empty));
    };
    let separator = separator_of(first);
    let fields: Vec<String> = split_header(first, separator);
    let header = understand(&fields, kind).map_err(|(column, problem)| {
        fail(Some(header_line), column.map(|(i, n)| format!("{i} ({n})")), problem)
    })?;
    let dialect = Dialect {
        separator,
        decimal_comma: separator != b',' && text.as_bytes().contains(&b',') && decimal_comma(lines.clone()),
    };
    let values = read_rows(&header, dialect, lines)
        .map_err(|(line, column, problem)| fail(Some(line), column, problem))?;
    assemble(name, &header, values).map_err(|problem| fail(None, None, problem))
}

/// The separator: tab or semicolon where the header has one outside brackets, else a comma.
fn separator_of(header: &str) -> u8 {
    let mut depth = 0;
    let mut found = b',';
    for byte in header.bytes() {
        match byte {
            b'[' | b'(' => depth += 1,
            b']' | b')' => depth -= 1,
            b'\t' if depth == 0 => return b'\t',
            b';' if depth == 0 => found = b';',
            _ => {}
        }
    }
    found
}

/// Splits a header; a separator inside brackets belongs to the unit (`[counts, 4096/rev]`).
fn split_header(header: &str, separator: u8) -> Vec<String> {
    let mut fields = vec![String::new()];
    let mut depth = 0;
    for c in header.chars() {
        match c {
            '[' | '(' => depth += 1,
            ']' | ')' => depth -= 1,
            _ => {}
        }
        if depth <= 0 && c == char::from(separator) {
            fields.push(String::new());
        } else if c != '"'
            && let Some(last) = fields.last_mut()
        {
            last.push(c);
        }
    }
    fields.iter().map(|f| f.trim().to_owned()).collect()
}

/// Whether the first row of numbers is written with a decimal comma.
fn decimal_comma<'a>(mut lines: impl Iterator<Item = (usize, &'a str)>) -> bool {
    lines.next().is_some_and(|(_, line)| line.contains(','))
}

type Failure = (usize, Option<String>, Problem);

/// Values by column, in SI.
fn read_rows<'a>(
    header: &Header,
    dialect: Dialect,
    lines: impl Iterator<Item = (usize, &'a str)>,
) -> Result<Vec<Vec<f64>>, Failure> {
    let mut values: Vec<Vec<f64>> = vec![Vec::new(); header.columns.len()];
    let time = header.columns.iter().position(|c| c.role == Role::Time);
    let mut fields: Vec<&str> = Vec::with_capacity(header.width);
    for (line, row) in lines {
        fields.clear();
        fields.extend(row.split(char::from(dialect.separator)).map(|f| f.trim().trim_matches('"')));
        // A separator at the end of every row is a habit of some loggers.
        if fields.len() == header.width + 1 && fields.last().is_some_and(|f| f.is_empty()) {
            fields.pop();
        }
        if fields.len() != header.width {
            return Err((line, None, Problem::Ragged { found: fields.len(), expected: header.width }));
        }
        for (column, values) in header.columns.iter().zip(&mut values) {
            let here = || Some(format!("{} ({})", column.index + 1, column.name));
            let text = fields[column.index];
            let value = number(text, dialect)
                .ok_or_else(|| (line, here(), Problem::NotANumber { text: shorten(text) }))?;
            if !value.is_finite() {
                return Err((line, here(), Problem::NotFinite { text: shorten(text) }));
            }
            values.push(value * column.factor);
        }
        if let Some(time) = time.map(|i| &values[i])
            && let [.., before, now] = time.as_slice()
            && now <= before
        {
            let problem = Problem::TimeOrder { before: format!("{before}"), now: format!("{now}") };
            return Err((line, None, problem));
        }
    }
    Ok(values)
}

fn number(text: &str, dialect: Dialect) -> Option<f64> {
    if dialect.decimal_comma && text.contains(',') {
        text.replacen(',', ".", 1).parse().ok()
    } else {
        text.parse().ok()
    }
}

fn shorten(text: &str) -> String {
    text.chars().take(30).collect()
}

fn assemble(name: &str, header: &Header, values: Vec<Vec<f64>>) -> Result<Measurement, Problem> {
    let mut time = Vec::new();
    let mut input = None;
    let (mut outputs, mut reference) = (Vec::new(), Vec::new());
    for (column, values) in header.columns.iter().zip(values) {
        let Role::Measured(quantity) = column.role else {
            time = values;
            continue;
        };
        let channel = Channel { quantity, name: column.name.clone(), unit: column.unit.clone(), values };
        match quantity {
            Quantity::Input => input = Some(channel),
            Quantity::LoadPosition | Quantity::LoadVelocity => reference.push(channel),
            _ => outputs.push(channel),
        }
    }
    if time.len() < MIN_SAMPLES {
        return Err(Problem::TooShort { found: time.len(), expected: MIN_SAMPLES });
    }
    let input = input.ok_or(Problem::NoColumn { wanted: "u", hint: "add the input, such as u [N m]" })?;
    outputs.sort_by_key(|c| c.quantity != Quantity::Position);
    let warnings = header
        .ignored
        .iter()
        .map(|n| format!("The column '{n}' is not used: its name is not one of t, u, x1, v1, x2, v2, y."))
        .collect();
    Ok(Measurement { name: name.to_owned(), kind: header.kind, time, input, outputs, reference, warnings })
}
