//! Files of any format that is known, and columns of numbers that come without text.

use super::csv::{assemble, import_text, survey};
use super::error::{ImportError, Problem};
use super::found::{FoundColumn, Numbers, addressed};
use super::header::{Field, Header, Role, map, understand};
use super::mapping::ImportOptions;
use super::mat::{self, Format, Series};
use super::size::wrong_size;
use super::{MIN_SAMPLES, Measurement, header::shorten};

/// Reads a measurement: CSV (see [`import_csv`](super::import_csv)) or a MATLAB file of level 5
/// (`save -v6` or `-v7`), by what the file is and not by its name.
///
/// A MATLAB file has names but no units, so it needs a mapping, such as
/// `t=time [s], u=log.current [A], x1=enc [counts:4096]`. Variables in structures are addressed as in
/// MATLAB (`log.signals(2).values`), columns of matrices as `data(:,2)`.
///
/// # Errors
/// One line that names file and place and says what was expected.
pub fn import(
    name: &str,
    bytes: &[u8],
    options: &ImportOptions,
) -> Result<Measurement, ImportError> {
    let fail = |(column, problem)| ImportError {
        file: name.to_owned(),
        line: None,
        column,
        problem,
    };
    match mat::format_of(bytes) {
        Format::Other => import_text(name, bytes, options),
        Format::Hdf5 => Err(fail((None, Problem::Hdf5))),
        Format::Mat4 => Err(fail((None, Problem::Mat4))),
        Format::Mat5 => import_mat(name, bytes, options).map_err(fail),
    }
}

/// A problem and the column that it concerns.
type Located = (Option<String>, Problem);

fn import_mat(name: &str, bytes: &[u8], options: &ImportOptions) -> Result<Measurement, Located> {
    let whole = |problem| (None, problem);
    let series = mat::read(bytes).map_err(whole)?;
    let mut fields: Vec<Field> = series.iter().map(|s| Field::unknown(&s.name)).collect();
    if options.mapping.is_empty() {
        let names: Vec<&str> = series.iter().map(|s| s.name.as_str()).collect();
        let found = if names.is_empty() {
            "no numbers".to_owned()
        } else {
            names.join(", ").chars().take(200).collect()
        };
        return Err(whole(Problem::NotMapped { found }));
    }
    map(&mut fields, &options.mapping).map_err(whole)?;
    let bare = |f: &&Field| f.role.is_some() && f.unit.is_none();
    if let Some(field) = fields.iter().find(bare) {
        let name = shorten(&field.name);
        return Err((Some(name.clone()), Problem::NoUnitInMat { name }));
    }
    let header = understand(fields, options).map_err(|(column, p)| (column.map(|(_, n)| n), p))?;
    let values = in_si(&header, series)?;
    assemble(name, &header, values).map_err(whole)
}

/// The columns of a CSV or MATLAB file that are long enough to be a channel of a measurement.
///
/// # Errors
/// One line that says why the file has none, where it is damaged or of another format.
pub fn columns(name: &str, bytes: &[u8]) -> Result<Vec<FoundColumn>, ImportError> {
    let fail = |(line, problem)| ImportError {
        file: name.to_owned(),
        line,
        column: None,
        problem,
    };
    let seen = match mat::format_of(bytes) {
        Format::Other => survey(bytes, Numbers::default(), Numbers::take).map_err(fail)?,
        Format::Hdf5 => return Err(fail((None, Problem::Hdf5))),
        Format::Mat4 => return Err(fail((None, Problem::Mat4))),
        Format::Mat5 => survey_mat(bytes).map_err(|problem| fail((None, problem)))?,
    };
    let mut found = addressed(seen);
    found.retain(|column| column.numbers.count >= MIN_SAMPLES);
    Ok(found)
}

fn survey_mat(bytes: &[u8]) -> Result<Vec<(Field, Numbers)>, Problem> {
    let seen = |series: mat::Series| {
        let mut numbers = Numbers::default();
        series.values.iter().for_each(|v| numbers.take(*v));
        (Field::unknown(&series.name), numbers)
    };
    Ok(mat::read(bytes)?.into_iter().map(seen).collect())
}

/// The columns of a header in SI units, checked as the rows of a text are.
fn in_si(header: &Header, mut series: Vec<Series>) -> Result<Vec<Vec<f64>>, Located> {
    let mut all: Vec<Vec<f64>> = Vec::new();
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
        let pairs = || values.iter().zip(values.iter().skip(1));
        if column.role == Role::Time
            && let Some((i, (before, now))) = pairs().enumerate().find(|(_, (a, b))| b <= a)
        {
            let (before, now) = (format!("{before}"), format!("{now}"));
            return Err((here(i + 1), Problem::TimeOrder { before, now }));
        }
        if let Some(i) = wrong_size(column.role, &values) {
            let text = format!("{:e}", values[i] / column.factor);
            return Err((here(i), Problem::Size { text }));
        }
        all.push(values);
    }
    Ok(all)
}
