//! Comma-separated files, as people have them.

use super::error::{ImportError, Problem};
use super::found::{Numbers, addressed};
use super::guess::{fill, is_of_process};
use super::header::{Field, Header, Role, map, name_and_unit, shorten, understand};
use super::mapping::ImportOptions;
use super::rates;
use super::size::wrong_size;
use super::split::{BLANKS, split_header};
use super::unit::parse_input;
use super::{Channel, Kind, MIN_SAMPLES, Measurement, Quantity};

/// How the rows of a file are written.
struct Dialect {
    separator: char,
    /// The decimal mark, once one was seen: a file that mixes both has thousands separators in it,
    /// and those must not be read as decimals.
    mark: Option<char>,
}

/// Reads a CSV file.
///
/// The header names the columns with units in brackets: `t [s],u [N m],x1 [rad],v1 [rad/s]` for a
/// drive, `t [s],u [1],y [1]` for a process. Separated by comma, semicolon, tab or, where none of
/// these is there, blanks; with semicolon and tab a decimal comma is understood. Lines that start
/// with `#` are comments, of which the last one before the numbers is the header where the file has
/// no other and it names as many columns as there are. Units may stand in a row of their own below the
/// names. Everything but the
/// signals of a process is converted to SI units; encoder counts state their resolution in the
/// brackets (`x1 [counts, 4096/rev]`, `x1 [counts, 0.001 mm]`). `kind` is guessed from the columns
/// if not given. What no column is called is taken from the only one whose name resembles it, with a
/// warning. Other columns are ignored with a warning.
///
/// # Errors
/// One line that names file, line and column and says what was expected.
pub fn import_csv(
    name: &str,
    bytes: &[u8],
    kind: Option<Kind>,
) -> Result<Measurement, ImportError> {
    let options = ImportOptions {
        kind,
        ..ImportOptions::default()
    };
    import_text(name, bytes, &options)
}

/// Reads a CSV file with a mapping and a torque constant.
pub(super) fn import_text(
    name: &str,
    bytes: &[u8],
    options: &ImportOptions,
) -> Result<Measurement, ImportError> {
    let fail = |line: Option<usize>, column: Option<String>, problem| ImportError {
        file: name.to_owned(),
        line,
        column,
        problem,
    };
    let Text {
        mut fields,
        line,
        dialect,
        rows,
    } = open(bytes).map_err(|(line, problem)| fail(line, None, problem))?;
    if options.mapping.is_empty() && fields.iter().all(|f| f.name.is_empty()) {
        let found = rows
            .clone()
            .next()
            .map_or_else(String::new, |r| shorten(&r.1.trim().replace('\t', " ")));
        return Err(fail(Some(line), None, Problem::NoHeader { found }));
    }
    map(&mut fields, &options.mapping).map_err(|p| fail(Some(line), None, p))?;
    let look = || {
        Some(addressed(
            survey(bytes, Numbers::default(), Numbers::take).ok()?,
        ))
    };
    let taken = fill(&mut fields, options, look).map_err(|p| fail(Some(line), None, p))?;
    let date = rows
        .clone()
        .next()
        .and_then(|(_, row)| date(row, dialect.separator, &fields));
    let mut header = understand(fields, options).map_err(|(column, problem)| {
        let problem = match (problem, date) {
            (Problem::NoColumn { wanted: "t", .. }, Some(date)) => date,
            (Problem::NoUnit { name, .. }, Some(date))
                if matches!(&date, Problem::Date { name: dated, .. } if *dated == shorten(&name)) =>
            {
                date
            }
            (other, _) => other,
        };
        let column = column.map(|(i, n)| format!("{i} ({n})"));
        fail(Some(line), column, problem)
    })?;
    header.notes.splice(..0, taken);
    let separator = dialect.separator;
    let values = read_rows(&header, dialect, rows.clone())
        .and_then(|values| check_sizes(&header, separator, rows, values))
        .map_err(|(line, column, problem)| fail(Some(line), column, problem))?;
    header
        .doubt_seconds(&values)
        .map_err(|(column, problem)| fail(Some(line), column, problem))?;
    assemble(name, &header, values).map_err(|problem| fail(None, None, problem))
}

/// A problem and its line.
pub(super) type Located = (Option<usize>, Problem);

/// A text, opened at its first row of numbers.
struct Text<Rows> {
    /// Columns by their names; the names are empty where the first line holds numbers already.
    fields: Vec<Field>,
    /// The line that they stand in.
    line: usize,
    dialect: Dialect,
    /// Rows with their lines.
    rows: Rows,
}

/// Opens a text.
fn open(bytes: &[u8]) -> Result<Text<impl Iterator<Item = (usize, &str)> + Clone>, Located> {
    // Old loggers, and some spreadsheets, end lines with a carriage return alone.
    let end = if bytes.contains(&b'\n') { b'\n' } else { b'\r' };
    let text = std::str::from_utf8(bytes).map_err(|e| {
        let before = bytes.get(..e.valid_up_to()).unwrap_or_default();
        let line = before.split(|b| *b == end).count();
        (Some(line), Problem::NotText)
    })?;
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let lines = text
        .split(char::from(end))
        .map(|line| line.strip_suffix('\r').unwrap_or(line))
        .enumerate()
        .map(|(i, line)| (i + 1, line))
        .filter(|(_, line)| !line.trim().is_empty());
    let mut rows = lines.clone().filter(|(_, line)| comment(line).is_none());
    let whole = rows.clone();
    let Some((mut line, first)) = rows.next() else {
        return Err((None, Problem::Empty));
    };
    let separator = separator_of(first, rows.clone().next().map(|(_, row)| row));
    let mut dialect = Dialect {
        separator,
        mark: (separator == ',').then_some('.'),
    };
    let mut names = split_header(first, separator);
    let mut numbers = |names: &[String]| names.iter().all(|f| number(f, &mut dialect).is_some());
    let numeric = numbers(&names);
    let mut bare = numeric;
    let before = lines.take_while(|(at, _)| *at < line);
    if numeric && let Some((at, header)) = before.last() {
        let header = split_header(comment(header).unwrap_or_default(), separator);
        if header.len() == names.len() && header.iter().any(|f| f.parse::<f64>().is_err()) {
            (line, names, bare) = (at, header, false);
        }
    }
    let field = |text: &String| {
        let (name, unit) = if bare {
            Default::default()
        } else {
            name_and_unit(text)
        };
        Field::named(name, unit)
    };
    let mut fields: Vec<Field> = names.iter().map(field).collect();
    let below = rows.clone().next().filter(|_| !numeric);
    if let Some(units) = below.and_then(|(_, row)| units(row, separator, fields.len())) {
        rows.next();
        for (field, unit) in fields.iter_mut().zip(units) {
            field.unit = field.unit.take().or(unit);
        }
    }
    Ok(Text {
        fields,
        line,
        dialect,
        rows: if numeric { whole } else { rows },
    })
}

/// The units of so many columns, where a row has nothing but units in it, or nothing for a column without one.
fn units(row: &str, separator: char, columns: usize) -> Option<Vec<Option<String>>> {
    let mut texts = Vec::with_capacity(columns);
    split_row(row, separator, &mut texts);
    // A separator at the end of every row is a habit of some loggers.
    if texts.len() == columns + 1 && texts.last().is_some_and(|t| t.is_empty()) {
        texts.pop();
    }
    let bare = |text: &str| text.trim_matches(['[', ']', '(', ')']).trim().to_owned();
    let texts: Vec<String> = texts.into_iter().map(bare).collect();
    let is_unit = |t: &String| t.is_empty() || parse_input(t).is_some() || is_of_process(t);
    // The 1 of a plain number is a unit, but a row of numbers is none.
    let says = |t: &String| !t.is_empty() && t.parse::<f64>().is_err();
    let all = texts.len() == columns && texts.iter().all(is_unit) && texts.iter().any(says);
    all.then(|| {
        texts
            .into_iter()
            .map(|t| Some(t).filter(|t| !t.is_empty()))
            .collect()
    })
}

/// What a comment says; `None` of a line that is none.
fn comment(line: &str) -> Option<&str> {
    Some(line.trim_start().strip_prefix('#')?.trim_start_matches('#'))
}

/// Columns of a text, and what `look` has seen of their numbers; fields that are none are passed over.
pub(super) fn survey<S: Clone>(
    bytes: &[u8],
    blank: S,
    mut look: impl FnMut(&mut S, f64),
) -> Result<Vec<(Field, S)>, Located> {
    let Text {
        fields,
        mut dialect,
        rows,
        ..
    } = open(bytes)?;
    let mut seen = vec![blank; fields.len()];
    let mut row = Vec::with_capacity(fields.len());
    for (_, text) in rows {
        split_row(text, dialect.separator, &mut row);
        for (field, seen) in row.iter().zip(&mut seen) {
            if let Some(value) = number(field, &mut dialect) {
                look(seen, value);
            }
        }
    }
    Ok(fields.into_iter().zip(seen).collect())
}

/// The separator: tab or semicolon where the header has one outside brackets, else a comma, or blanks where
/// neither the header nor the row after it has any of these and the row is divided by them.
fn separator_of(header: &str, row: Option<&str>) -> char {
    let outside = outside_brackets(header);
    let numbers = |row: &str, separator| {
        let mut fields = Vec::new();
        split_row(row, separator, &mut fields);
        let numeric = fields.iter().all(|f| f.parse::<f64>().is_ok());
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

/// Splits a row of numbers; a separator inside quotes belongs to the field.
fn split_row<'a>(row: &'a str, separator: char, fields: &mut Vec<&'a str>) {
    fields.clear();
    if separator == BLANKS {
        fields.extend(row.split_whitespace().map(|f| f.trim_matches('"')));
        return;
    }
    if !row.contains('"') {
        fields.extend(row.split(separator).map(str::trim));
        return;
    }
    let mut quoted = false;
    let pieces = row.split(|c| {
        quoted ^= c == '"';
        c == separator && !quoted
    });
    fields.extend(pieces.map(|f| f.trim().trim_matches('"').trim()));
}

type Failure = (usize, Option<String>, Problem);

/// Values by column, in SI.
fn read_rows<'a>(
    header: &Header,
    mut dialect: Dialect,
    lines: impl Iterator<Item = (usize, &'a str)>,
) -> Result<Vec<Vec<f64>>, Failure> {
    let mut values: Vec<Vec<f64>> = vec![Vec::new(); header.columns.len()];
    let time = header.columns.iter().position(|c| c.role == Role::Time);
    let mut fields: Vec<&str> = Vec::with_capacity(header.width);
    for (line, row) in lines {
        split_row(row, dialect.separator, &mut fields);
        // A separator at the end of every row is a habit of some loggers.
        if fields.len() == header.width + 1 && fields.last().is_some_and(|f| f.is_empty()) {
            fields.pop();
        }
        if fields.len() != header.width {
            return Err((
                line,
                None,
                Problem::Ragged {
                    found: fields.len(),
                    expected: header.width,
                    hint: if dialect.separator == ',' && fields.len() > header.width {
                        "; decimal commas need ; or tab between the columns"
                    } else {
                        ""
                    },
                },
            ));
        }
        for (column, values) in header.columns.iter().zip(&mut values) {
            let here = || Some(format!("{} ({})", column.index + 1, column.name));
            let text = fields[column.index];
            let value = number(text, &mut dialect).ok_or_else(|| {
                let (name, text) = (column.name.clone(), shorten(text));
                let problem = if column.role == Role::Time && is_date(&text) {
                    Problem::Date { name, text }
                } else {
                    Problem::NotANumber { text }
                };
                (line, here(), problem)
            })? * column.factor;
            if !value.is_finite() {
                return Err((
                    line,
                    here(),
                    Problem::NotFinite {
                        text: shorten(text),
                    },
                ));
            }
            values.push(value);
        }
        if let Some((column, time)) = time.map(|i| (&header.columns[i], &values[i]))
            && let [.., before, now] = time.as_slice()
            && now <= before
        {
            let here = Some(format!("{} ({})", column.index + 1, column.name));
            let problem = Problem::TimeOrder {
                before: format!("{before}"),
                now: format!("{now}"),
            };
            return Err((line, here, problem));
        }
    }
    Ok(values)
}

/// The first of the columns that are the time, or nothing that is known, which has a date in this row.
fn date(row: &str, separator: char, fields: &[Field]) -> Option<Problem> {
    let mut texts = Vec::with_capacity(fields.len());
    split_row(row, separator, &mut texts);
    let mut free = fields
        .iter()
        .zip(texts)
        .filter(|(field, _)| field.role.is_none_or(|r| r == Role::Time));
    free.find(|(_, text)| is_date(text))
        .map(|(field, text)| Problem::Date {
            name: shorten(&field.name),
            text: shorten(text),
        })
}

/// Whether a text is a date or a time of day: digits with a colon between them, or three parts of digits with a
/// hyphen or a slash between them.
fn is_date(text: &str) -> bool {
    let digit = |c: Option<&u8>| c.is_some_and(u8::is_ascii_digit);
    let between = |marks: &[u8]| {
        let triples = text.as_bytes().windows(3);
        let is_mark = |t: &&[u8]| marks.contains(&t[1]) && digit(t.first()) && digit(t.last());
        triples.filter(is_mark).count()
    };
    digit(text.as_bytes().first()) && (between(b":") > 0 || between(b"-/") > 1)
}

/// The values of these rows, if they can be calculated with.
fn check_sizes<'a>(
    header: &Header,
    separator: char,
    mut rows: impl Iterator<Item = (usize, &'a str)>,
    values: Vec<Vec<f64>>,
) -> Result<Vec<Vec<f64>>, Failure> {
    let mut columns = header.columns.iter().zip(&values);
    let place =
        columns.find_map(|(column, values)| Some((column, wrong_size(column.role, values)?)));
    let Some((column, (line, row))) = place.and_then(|(c, row)| Some((c, rows.nth(row)?))) else {
        return Ok(values);
    };
    let mut fields = Vec::with_capacity(header.width);
    split_row(row, separator, &mut fields);
    let text = shorten(fields.get(column.index).copied().unwrap_or_default());
    let here = Some(format!("{} ({})", column.index + 1, column.name));
    Err((line, here, Problem::Size { text }))
}

fn number(text: &str, dialect: &mut Dialect) -> Option<f64> {
    let mark = text
        .bytes()
        .find(|b| matches!(b, b'.' | b','))
        .map(char::from);
    match (mark, dialect.mark) {
        (Some(here), Some(before)) if here != before => return None,
        (Some(here), None) => dialect.mark = Some(here),
        _ => {}
    }
    if mark == Some(',') {
        text.replacen(',', ".", 1).parse().ok()
    } else {
        text.parse().ok()
    }
}

pub(super) fn assemble(
    name: &str,
    header: &Header,
    values: Vec<Vec<f64>>,
) -> Result<Measurement, Problem> {
    let mut time = Vec::new();
    let mut input = None;
    let (mut outputs, mut reference) = (Vec::new(), Vec::new());
    for (column, values) in header.columns.iter().zip(values) {
        let Role::Measured(quantity) = column.role else {
            time = values;
            continue;
        };
        let channel = Channel {
            quantity,
            name: column.name.clone(),
            unit: column.unit.clone(),
            values,
        };
        match quantity {
            Quantity::Input => input = Some(channel),
            Quantity::LoadPosition | Quantity::LoadVelocity => reference.push(channel),
            _ => outputs.push(channel),
        }
    }
    if time.len() < MIN_SAMPLES {
        return Err(Problem::TooShort {
            found: time.len(),
            expected: MIN_SAMPLES,
        });
    }
    let input = input.ok_or(Problem::NoColumn {
        wanted: "u",
        hint: "add the input, such as u [N m]",
    })?;
    outputs.sort_by_key(|c| c.quantity != Quantity::Position);
    let warnings = rates::contradiction(&time, &outputs)
        .into_iter()
        .chain(header.ignored.iter().map(|n| ignored(n, header.kind)))
        .chain(header.notes.iter().cloned())
        .collect();
    Ok(Measurement {
        name: name.to_owned(),
        kind: header.kind,
        time,
        input,
        outputs,
        reference,
        warnings,
    })
}

fn ignored(name: &str, kind: Kind) -> String {
    let used = match kind {
        Kind::Drive => "a drive has t, u, x1, v1, x2, v2",
        Kind::Process => "a process has t, u, y",
    };
    format!("The column '{name}' is not used: {used}.")
}
