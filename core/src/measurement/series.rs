//! Columns that come as whole series with names, from files that are no table of text.

use std::collections::HashMap;

use super::cell::Mark;
use super::clock::{Clock, unit_from_1970};
use super::controlled::as_in_the_loop;
use super::csv::assemble;
use super::error::{ImportError, Problem};
use super::fill::fill;
use super::found::{FoundColumn, Numbers, addressed};
use super::header::{Field, Header, Role, listed, shorten, understand};
use super::mapped::map;
use super::mapping::ImportOptions;
use super::period::Period;
use super::resembling::is_period;
use super::size::wrong_size;
use super::times;
use super::{Kind, Measurement};
use crate::message::Message;
use crate::msg;

/// One series of numbers with the name by which it is addressed.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Series {
    pub name: String,
    /// Its unit, where the file says one.
    pub unit: Option<String>,
    pub values: Vec<f64>,
    /// Whether the values were dates, and are seconds from the first.
    pub dates: bool,
}

/// Most series of a file that are kept: a log has some hundred at most.
const MOST_SERIES: usize = 1000;

/// Series that grow value by value, by their names and rows.
pub(super) struct Builder {
    series: Vec<(Series, Clock)>,
    places: HashMap<String, usize>,
    mark: Mark,
    /// How many values more there may be, with those that are missing between others: each that is there takes a byte
    /// of the file at least.
    left: usize,
}

impl Builder {
    /// For a file of so many bytes.
    pub fn new(bytes: usize) -> Self {
        Self {
            series: Vec::new(),
            places: HashMap::new(),
            mark: Mark::default(),
            left: bytes,
        }
    }

    /// Takes a value that stands as a text.
    pub fn text(&mut self, name: &str, row: usize, text: &str) {
        if let Some(place) = self.place(name, row) {
            let (_, clock) = &mut self.series[place];
            let value = self.mark.value(text.trim(), clock).unwrap_or(f64::NAN);
            self.put(place, value);
        }
    }

    /// Takes a number.
    pub fn number(&mut self, name: &str, row: usize, value: f64) {
        if let Some(place) = self.place(name, row) {
            self.put(place, value);
        }
    }

    /// Sets the unit of the series with this name, if it has none.
    pub fn unit(&mut self, name: &str, unit: &str) {
        if let Some(place) = self.places.get(name) {
            self.series[*place]
                .0
                .unit
                .get_or_insert_with(|| unit.to_owned());
        }
    }

    /// The series of this name, filled up to this row; `None` where the row has its value.
    fn place(&mut self, name: &str, row: usize) -> Option<usize> {
        let place = match self.places.get(name) {
            Some(place) => *place,
            None if self.series.len() < MOST_SERIES => {
                let series = Series {
                    name: name.to_owned(),
                    ..Series::default()
                };
                self.series.push((series, Clock::default()));
                self.places.insert(name.to_owned(), self.series.len() - 1);
                self.series.len() - 1
            }
            None => return None,
        };
        let values = &mut self.series[place].0.values;
        let missing = row.checked_sub(values.len())?;
        self.left = self.left.checked_sub(missing + 1)?;
        values.resize(row, f64::NAN);
        Some(place)
    }

    fn put(&mut self, place: usize, value: f64) {
        self.series[place].0.values.push(value);
    }

    /// The series, in the order in which they came.
    pub fn finish(self) -> Vec<Series> {
        let whole = |(mut series, clock): (Series, Clock)| {
            series.dates = clock.has_dates();
            series
        };
        self.series.into_iter().map(whole).collect()
    }
}

/// The series of a file.
pub(super) struct Table {
    pub series: Vec<Series>,
    /// Whether the names say what is what, as those of a header do; a workspace of MATLAB has many a variable called x
    /// or v.
    pub named: bool,
}

impl Table {
    /// The fields by their names, and what is to be said of these.
    fn fields(&self) -> (Vec<Field>, Option<Message>) {
        let field = |series: &Series| {
            let unit = series.unit.clone();
            let field = Field::named(series.name.clone(), unit);
            let role = field.role.filter(|_| self.named);
            Field { role, ..field }
        };
        let mut fields: Vec<Field> = self.series.iter().map(field).collect();
        let longest = self
            .series
            .iter()
            .map(|s| s.values.len())
            .max()
            .unwrap_or(0);
        let row = |k: usize| {
            self.series
                .iter()
                .map(|s| s.values.get(k).copied())
                .collect()
        };
        let note = as_in_the_loop(&mut fields, (0..longest).map(row));
        (fields, note)
    }

    /// Names of the records that say themselves what is input and what output, as those of MATLAB's System
    /// Identification Toolbox do.
    fn records(&self) -> impl Iterator<Item = &str> {
        let has = |name: String| self.series.iter().any(|s| s.name == name);
        let [_, input, _] = OF_A_RECORD;
        let inputs = self.series.iter();
        let inputs = inputs.filter_map(move |s| s.name.strip_suffix(input));
        inputs.filter(move |of| OF_A_RECORD.iter().all(|part| has(format!("{of}{part}"))))
    }

    /// The columns, before it is known what they are.
    pub fn columns(&self) -> Vec<FoundColumn> {
        let numbers = |series: &Series| {
            let mut numbers = Numbers::default();
            series.values.iter().for_each(|v| numbers.take(*v));
            numbers.dates = series.dates;
            numbers
        };
        let seen = self
            .fields()
            .0
            .into_iter()
            .zip(self.series.iter().map(numbers));
        addressed(seen.collect())
    }

    /// The measurement.
    pub fn import(self, name: &str, options: &ImportOptions) -> Result<Measurement, ImportError> {
        self.measurement(name, options)
            .map_err(|(column, problem)| ImportError::new(name, None, column, problem))
    }

    fn measurement(self, name: &str, options: &ImportOptions) -> Result<Measurement, Located> {
        let whole = |problem| (None, problem);
        if self.series.is_empty() {
            return Err(whole(Problem::NoNumbers));
        }
        let (mut fields, note) = self.fields();
        let mut options = options.clone();
        let mut notes = Vec::new();
        if options.mapping.is_empty() && !self.named {
            let record = self.records().next();
            let Some(record) = record.filter(|_| options.kind != Some(Kind::Drive)) else {
                let found = listed(self.series.iter().map(|s| s.name.as_str()));
                return Err(whole(Problem::NotMapped { found }));
            };
            options.mapping = record_mapping(record).parse().unwrap_or_default();
            if self.records().nth(1).is_some() {
                notes.push(msg!(
                    "The file holds {}: '{}' was read. A mapping can read another one.",
                    Message::name(listed(self.records())),
                    Message::name(record)
                ));
            }
        }
        notes.extend(map(&mut fields, &options.mapping).map_err(whole)?);
        notes.extend(note.filter(|_| options.mapping.is_empty()));
        if let Some((name, period)) = period_of(&fields, &options, &self.series) {
            notes.push(msg!(
                "The column '{}' is taken as the sampling period, {} s.",
                Message::name(name),
                period.seconds()
            ));
            options.period = Some(period);
        }
        if self.named {
            let look = || Some(self.columns());
            notes.extend(fill(&mut fields, &options, look).map_err(whole)?);
        }
        let mut series = self.series;
        notes.extend(from_first_time(&mut fields, &mut series));
        let mut header =
            understand(fields, &options).map_err(|(column, p)| (column.map(|(_, n)| n), p))?;
        header.notes.splice(..0, notes);
        let (values, mended) = columns(&header, series)?;
        header.notes.extend(mended);
        header.doubt_seconds(&values)?;
        assemble(name, &header, values).map_err(whole)
    }
}

/// Times, input and output of a record of the toolbox, behind its name.
pub(super) const OF_A_RECORD: [&str; 3] = [".Time", ".InputData", ".OutputData"];

/// What is what in a record of the toolbox.
fn record_mapping(of: &str) -> String {
    let roles = ["t", "u", "y"].iter().zip(OF_A_RECORD);
    let parts: Vec<String> = roles
        .map(|(role, part)| format!("{role}={of}{part}"))
        .collect();
    parts.join(",")
}

/// A problem and the column that it concerns.
type Located = (Option<String>, Problem);

/// The sampling period, by its name, where the file has no times.
fn period_of(
    fields: &[Field],
    options: &ImportOptions,
    series: &[Series],
) -> Option<(String, Period)> {
    let timed =
        fields.iter().any(|f| f.role == Some(Role::Time)) || options.mapping.speaks_of(Role::Time);
    if timed || options.period.is_some() {
        return None;
    }
    let place = fields
        .iter()
        .position(|f| f.role.is_none() && is_period(last_name(&f.name)))?;
    let (first, others) = series.get(place)?.values.split_first()?;
    let unit = fields[place].unit.as_deref().unwrap_or("s");
    let period = Period::in_unit(*first, unit).filter(|_| others.iter().all(|v| v == first))?;
    Some((shorten(&fields[place].name), period))
}

/// The last of the names on the way to a series, as in `log.Ts`.
pub(super) fn last_name(name: &str) -> &str {
    name.rsplit('.').next().unwrap_or(name)
}

/// Counts times from the first of them that are counted from 1970, or are dates, and says so.
fn from_first_time(fields: &mut [Field], series: &mut [Series]) -> Option<Message> {
    let time = fields.iter().position(|f| f.role == Some(Role::Time))?;
    let (field, series) = (fields.get_mut(time)?, series.get_mut(time)?);
    let name = shorten(&field.name);
    if series.dates {
        field.unit = Some("s".to_owned());
        return Some(msg!(
            "The column '{}' has dates or times of day: counted in seconds from the first.",
            Message::name(name)
        ));
    }
    let first = *series.values.first()?;
    let unit = unit_from_1970(first)?;
    if field.unit.get_or_insert_with(|| unit.to_owned()) != unit {
        return None;
    }
    series.values.iter_mut().for_each(|value| *value -= first);
    Some(msg!(
        "The column '{}' counts {} from 1970: counted from the first time.",
        Message::name(name),
        unit
    ))
}

/// The columns of a header in SI units, checked as the rows of a text are, and what was done to the times.
fn columns(
    header: &Header,
    mut series: Vec<Series>,
) -> Result<(Vec<Vec<f64>>, Vec<Message>), Located> {
    let mut all: Vec<Vec<f64>> = Vec::new();
    let mut in_order = None;
    for column in &header.columns {
        let mut values = series
            .get_mut(column.index)
            .map(|s| std::mem::take(&mut s.values))
            .unwrap_or_default();
        if let (Some(first), Some(other)) = (all.first(), header.columns.first())
            && first.len() != values.len()
        {
            let problem = Problem::Lengths {
                found: values.len(),
                other: shorten(&other.name),
                expected: first.len(),
            };
            return Err((Some(shorten(&column.name)), problem));
        }
        let here = |i: usize| Some(format!("{}, sample {}", shorten(&column.name), i + 1));
        for (i, value) in values.iter_mut().enumerate() {
            let text = *value;
            *value *= column.factor;
            if !value.is_finite() {
                let text = format!("{text}");
                return Err((here(i), Problem::NotFinite { text }));
            }
        }
        if column.role == Role::Time {
            let mut times = values.clone();
            let mended = times::mend(&mut times, header.kind);
            let mended = mended.map_err(|(i, problem)| (here(i), problem))?;
            in_order = Some((all.len(), times, mended));
        }
        if let Some(i) = wrong_size(column.role, &values) {
            let text = format!("{:e}", values[i] / column.factor);
            return Err((here(i), Problem::Size { text }));
        }
        all.push(values);
    }
    let Some((time, times, mended)) = in_order else {
        return Ok((all, Vec::new()));
    };
    for values in &mut all {
        times::leave_out(values, &mended.out);
    }
    all[time] = times;
    Ok((all, mended.notes))
}
