//! Comma-separated files, as people have them.

use super::average;
use super::cell::with_unit;
use super::clock::{Clock, unit_from_1970};
use super::error::{ImportError, Problem};
use super::fill::fill;
use super::found::addressed;
use super::gaps;
use super::header::{Field, Header, Role, begin_of, shorten, understand};
use super::mapped::map;
use super::mapping::ImportOptions;
use super::period::Period;
use super::rates;
use super::resembling::{RESEMBLING, is_period};
use super::size::wrong_size;
use super::split::split_row;
use super::switched_on;
use super::text::{Dialect, Text, open, survey};
use super::times;
use super::{Channel, Kind, MIN_SAMPLES, Measurement, Quantity};
use crate::message::Message;
use crate::msg;

/// Reads a text with columns, with a mapping, a torque constant and a period.
pub(super) fn import_text(
    name: &str,
    bytes: &[u8],
    options: &ImportOptions,
) -> Result<Measurement, ImportError> {
    let fail = |line: Option<usize>, column: Option<String>, problem| {
        ImportError::new(name, line, column, problem)
    };
    let Text {
        mut fields,
        line,
        dialect,
        note,
        rows,
    } = open(bytes).map_err(|(line, problem)| fail(line, None, problem))?;
    if options.mapping.is_empty() && fields.iter().all(|f| f.name.is_empty()) {
        let found = rows
            .clone()
            .next()
            .map_or_else(String::new, |r| begin_of(&r.1.trim().replace('\t', " ")));
        return Err(fail(Some(line), None, Problem::NoHeader { found }));
    }
    let mut notes = map(&mut fields, &options.mapping).map_err(|p| fail(Some(line), None, p))?;
    notes.extend(note.filter(|_| options.mapping.is_empty()));
    let mut options = options.clone();
    let mut used = None;
    if let Some((place, period)) = period_column(&fields, &options, rows.clone(), dialect) {
        let name = shorten(&fields[place].name);
        notes.push(msg!(
            "The column '{}' is taken as the sampling period, {} s.",
            Message::name(name.clone()),
            period.seconds()
        ));
        options.period = Some(period);
        used = Some(name);
    }
    let look = || Some(addressed(survey(bytes).ok()?));
    notes.extend(fill(&mut fields, &options, look).map_err(|p| fail(Some(line), None, p))?);
    let first = rows.clone().next().map_or("", |(_, row)| row);
    let (clock, note) = clock(&mut fields, first, dialect);
    notes.extend(note);
    let date = date(first, dialect.separator, &fields);
    let units: Vec<Option<String>> = fields.iter().map(|f| f.unit.clone()).collect();
    let unread = unread(rows.clone().next(), dialect, &fields);
    let mut header = understand(fields, &options).map_err(|(column, problem)| {
        if let (Problem::NoColumn { .. }, None, Some((line, column, problem))) =
            (&problem, &date, unread)
        {
            return fail(Some(line), column, problem);
        }
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
    header.notes.splice(..0, notes);
    header.ignored.retain(|name| Some(name) != used.as_ref());
    let separator = dialect.separator;
    let located = |(line, column, problem): Failure| fail(Some(line), column, problem);
    let reader = RowReader {
        header: &header,
        units: &units,
        dialect,
        times: clock,
        other: Clock::default(),
    };
    let mut table = read_rows(reader, rows.clone()).map_err(located)?;
    let mended = in_order(&header, &mut table).map_err(located)?;
    check_sizes(&header, separator, rows, &table).map_err(located)?;
    let Rows {
        values,
        repeated,
        tail,
        ..
    } = table;
    header.notes.extend(said_of_repeated(repeated));
    header.notes.extend(tail.map(|(line, begin)| {
        msg!(
            "From line {} on there are no rows of numbers ('{}'): left out.",
            line,
            Message::name(begin)
        )
    }));
    header.notes.extend(mended);
    header
        .doubt_seconds(&values)
        .map_err(|(column, problem)| fail(Some(line), column, problem))?;
    assemble(name, &header, values).map_err(|problem| fail(None, None, problem))
}

/// The column that has the sampling period where none has the times, and the period: one number, in the first row or in
/// all.
fn period_column<'a>(
    fields: &[Field],
    options: &ImportOptions,
    rows: impl Iterator<Item = (usize, &'a str)>,
    mut dialect: Dialect,
) -> Option<(usize, Period)> {
    let timed =
        fields.iter().any(|f| f.role == Some(Role::Time)) || options.mapping.speaks_of(Role::Time);
    if timed || options.period.is_some() {
        return None;
    }
    let place = fields
        .iter()
        .position(|f| f.role.is_none() && is_period(&f.name))?;
    let mut texts = Vec::new();
    let mut period = None;
    for (_, row) in rows {
        split_row(row, dialect.separator, &mut texts);
        let text = texts.get(place).copied().unwrap_or_default();
        match period {
            None => period = Some(dialect.mark.number(text)?),
            Some(period) if text.is_empty() || dialect.mark.number(text) == Some(period) => {}
            Some(_) => return None,
        }
    }
    let unit = fields[place].unit.as_deref().unwrap_or("s");
    Some((place, Period::in_unit(period?, unit)?))
}

/// A cell of the first row that would be a number if it were written otherwise, in a column that is not known and could
/// be one that is wanted.
fn unread(row: Option<(usize, &str)>, mut dialect: Dialect, fields: &[Field]) -> Option<Failure> {
    let (line, row) = row?;
    let mut cells = Vec::with_capacity(fields.len());
    split_row(row, dialect.separator, &mut cells);
    let wanted =
        |field: &Field| field.role.is_none() && RESEMBLING.iter().any(|r| r.resembles(&field.name));
    let mut all = fields.iter().zip(cells).enumerate();
    let (place, (field, cell)) = all.find(|(_, (field, cell))| {
        let value = dialect.mark.value(cell, &mut Clock::default());
        wanted(field) && value.is_none() && cell.contains(|c: char| c.is_ascii_digit())
    })?;
    let column = format!("{} ({})", place + 1, shorten(&field.name));
    let text = shorten(cell);
    Some((line, Some(column), Problem::NotANumber { text }))
}

/// How the times are to be read, by the first of them, and what is to be said of it: dates count in seconds, and clocks
/// that count from 1970 say their unit by their size.
fn clock(fields: &mut [Field], row: &str, mut dialect: Dialect) -> (Clock, Option<Message>) {
    let mut texts = Vec::with_capacity(fields.len());
    split_row(row, dialect.separator, &mut texts);
    let mut times = fields
        .iter_mut()
        .zip(texts)
        .filter(|(f, _)| f.role == Some(Role::Time));
    let Some((field, first)) = times.next() else {
        return Default::default();
    };
    let [name, shown] = [&field.name, first].map(|text| Message::name(shorten(text)));
    let Some(number) = dialect.mark.number(first) else {
        let dated = Clock::default().date(first).is_some();
        if dated {
            field.unit = Some("s".to_owned());
        }
        let note = || {
            msg!(
                "The column '{}' has dates or times of day: counted in seconds from {}.",
                name,
                shown
            )
        };
        return (Clock::default(), dated.then(note));
    };
    let unit = unit_from_1970(number);
    match (&field.unit, unit) {
        (None, Some(unit)) => field.unit = Some(unit.to_owned()),
        (Some(own), Some(unit)) if own == unit => {}
        _ => return Default::default(),
    }
    let note = msg!(
        "The column '{}' counts {} from 1970: counted from the first time, {}.",
        name,
        Message::name(field.unit.as_deref().unwrap_or_default()),
        shown
    );
    (Clock::from_1970(first).unwrap_or_default(), Some(note))
}

/// What is said of rows that repeat the one before.
fn said_of_repeated(count: usize) -> Option<Message> {
    match count {
        0 => None,
        1 => Some(msg!(
            "{} row repeats the one before, time and values: it is read once.",
            count
        )),
        _ => Some(msg!(
            "{} rows repeat the one before, time and values: each is read once.",
            count
        )),
    }
}

type Failure = (usize, Option<String>, Problem);

/// What stands in rows.
#[derive(Default)]
struct Rows {
    /// Values by column, in SI.
    values: Vec<Vec<f64>>,
    /// The line of each row.
    lines: Vec<usize>,
    /// How many rows were left out because they repeat the one before.
    repeated: usize,
    /// The first of the lines at the end that are no rows.
    tail: Option<(usize, String)>,
}

/// Lines at the end that may be no rows: a logger that ends cuts its last row, or says what it found.
const LONGEST_TAIL: usize = 8;

/// Reads rows.
fn read_rows<'a>(
    mut reader: RowReader<'_>,
    mut lines: impl Iterator<Item = (usize, &'a str)>,
) -> Result<Rows, Failure> {
    let header = reader.header;
    let time = header.columns.iter().position(|c| c.role == Role::Time);
    let mut rows = Rows {
        values: vec![Vec::new(); header.columns.len()],
        ..Rows::default()
    };
    let mut fields: Vec<&str> = Vec::with_capacity(header.width);
    while let Some((line, row)) = lines.next() {
        let read = reader.read(row, &mut fields, &mut rows.values);
        let kept = rows.lines.len();
        if let Err((column, problem)) = read {
            rows.values.iter_mut().for_each(|v| v.truncate(kept));
            let rest: Vec<&str> = lines
                .by_ref()
                .take(LONGEST_TAIL)
                .map(|(_, row)| row)
                .collect();
            let mut is_row = |row: &&str| {
                let mut aside = vec![Vec::new(); header.columns.len()];
                reader.read(row, &mut Vec::new(), &mut aside).is_ok()
            };
            let no_row = match &problem {
                Problem::Ragged {
                    found, expected, ..
                } => found < expected,
                Problem::NotANumber { text } => !text.contains(|c: char| c.is_ascii_digit()),
                _ => false,
            };
            let ends = rest.len() < LONGEST_TAIL && !rest.iter().any(&mut is_row);
            if !(no_row && ends && kept >= MIN_SAMPLES) {
                return Err((line, column, problem));
            }
            rows.tail = Some((line, begin_of(row.trim())));
        } else if time.is_some_and(|time| repeats(&rows.values, time)) {
            rows.values.iter_mut().for_each(|v| v.truncate(kept));
            rows.repeated += 1;
        } else {
            rows.lines.push(line);
        }
    }
    Ok(rows)
}

/// What reads a row.
struct RowReader<'a> {
    header: &'a Header,
    /// Units of all columns: a number may have its unit behind it, and no other.
    units: &'a [Option<String>],
    dialect: Dialect,
    times: Clock,
    other: Clock,
}

impl RowReader<'_> {
    /// Adds the values of a row; where it is none, the column and what is wrong, with some values added.
    fn read<'a>(
        &mut self,
        row: &'a str,
        fields: &mut Vec<&'a str>,
        values: &mut [Vec<f64>],
    ) -> Result<(), (Option<String>, Problem)> {
        let (width, separator) = (self.header.width, self.dialect.separator);
        split_row(row, separator, fields);
        // A separator at the end of every row is a habit of some loggers.
        if fields.len() == width + 1 && fields.last().is_some_and(|f| f.is_empty()) {
            fields.pop();
        }
        if fields.len() != width {
            let found = fields.len();
            let hint = if separator == ',' && found > width {
                "decimal commas need ; or tab between the columns"
            } else {
                ""
            };
            let ragged = Problem::Ragged {
                found,
                expected: width,
                hint,
            };
            return Err((None, ragged));
        }
        for (column, values) in self.header.columns.iter().zip(values) {
            let here = || Some(format!("{} ({})", column.index + 1, column.name));
            let text = fields[column.index];
            let is_time = column.role == Role::Time;
            let clock = if is_time {
                &mut self.times
            } else {
                &mut self.other
            };
            let value = self.dialect.mark.value(text, clock);
            let own = self.units.get(column.index).and_then(Option::as_deref);
            let same = |_: &f64| with_unit(text).is_none_or(|(_, unit)| Some(unit) == own);
            let value = value.filter(same).ok_or_else(|| {
                let (name, text) = (column.name.clone(), shorten(text));
                let problem = if is_time && is_date(&text) {
                    Problem::Date { name, text }
                } else {
                    Problem::NotANumber { text }
                };
                (here(), problem)
            })? * column.factor;
            if !value.is_finite() {
                let text = shorten(text);
                return Err((here(), Problem::NotFinite { text }));
            }
            values.push(value);
        }
        Ok(())
    }
}

/// Makes the times of a table increase, and says what was done for it.
fn in_order(header: &Header, table: &mut Rows) -> Result<Vec<Message>, Failure> {
    let Some(time) = header.columns.iter().position(|c| c.role == Role::Time) else {
        return Ok(Vec::new());
    };
    let mended = times::mend(&mut table.values[time], header.kind).map_err(|(row, problem)| {
        let column = &header.columns[time];
        let here = Some(format!("{} ({})", column.index + 1, column.name));
        (table.lines[row], here, problem)
    })?;
    let others = table
        .values
        .iter_mut()
        .enumerate()
        .filter(|(i, _)| *i != time);
    others.for_each(|(_, values)| times::leave_out(values, &mended.out));
    times::leave_out(&mut table.lines, &mended.out);
    Ok(mended.notes)
}

/// Whether the last row is the one before it once more.
fn repeats(values: &[Vec<f64>], time: usize) -> bool {
    let same = |values: &Vec<f64>| matches!(values.as_slice(), [.., before, now] if before == now);
    values.get(time).is_some_and(same) && values.iter().all(same)
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

/// Checks that values can be calculated with.
fn check_sizes<'a>(
    header: &Header,
    separator: char,
    mut rows: impl Iterator<Item = (usize, &'a str)>,
    table: &Rows,
) -> Result<(), Failure> {
    let mut columns = header.columns.iter().zip(&table.values);
    let place =
        columns.find_map(|(column, values)| Some((column, wrong_size(column.role, values)?)));
    let Some((column, row)) = place else {
        return Ok(());
    };
    let line = table.lines[row];
    let row = rows.find(|(at, _)| *at == line).map_or("", |(_, row)| row);
    let mut fields = Vec::with_capacity(header.width);
    split_row(row, separator, &mut fields);
    let text = shorten(fields.get(column.index).copied().unwrap_or_default());
    let here = Some(format!("{} ({})", column.index + 1, column.name));
    Err((line, here, Problem::Size { text }))
}

pub(super) fn assemble(
    name: &str,
    header: &Header,
    values: Vec<Vec<f64>>,
) -> Result<Measurement, Problem> {
    let samples = values.first().map_or(0, Vec::len);
    let mut time = header
        .period
        .map_or_else(Vec::new, |period| period.times(samples));
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
    let mut input = input.ok_or(Problem::NoColumn {
        wanted: "u",
        hint: "add the input, such as u [N m]",
    })?;
    outputs.sort_by_key(|c| c.quantity != Quantity::Position);
    let step = switched_on::from_rest(&mut time, &mut input, &mut outputs, &mut reference);
    let thinned = average::thin(header.kind, &mut time, &mut input, &mut outputs);
    let warnings = rates::contradiction(&time, &outputs)
        .into_iter()
        .chain(header.ignored.iter().map(|n| ignored(n, header.kind)))
        .chain(header.notes.iter().cloned())
        .chain(step)
        .chain(thinned)
        .chain(gaps::said(header.kind, &time))
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

fn ignored(name: &str, kind: Kind) -> Message {
    let name = Message::name(name);
    match kind {
        Kind::Drive => msg!(
            "The column '{}' is not used: a drive has t, u, x1, v1, x2, v2.",
            name
        ),
        Kind::Process => msg!("The column '{}' is not used: a process has t, u, y.", name),
    }
}
