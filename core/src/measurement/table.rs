//! Files of any format that is known.

use super::advice::advise;
use super::csv::import_text;
use super::error::{ImportError, Problem};
use super::found::FoundColumn;
use super::mapping::ImportOptions;
use super::mat::{self, Format};
use super::resembling::is_period;
use super::series::{Series, Table, last_name};
use super::{Kind, MIN_SAMPLES, Measurement};
use super::{found, json, log, text};

/// Reads a measurement, by what the file is and not by its name: a text with columns, JSON (an array or lines of
/// objects, or an object of arrays), lines of names with values (`t: 0.01 u: 3`), or a file of MATLAB (`save -v6`,
/// `-v7` and, as HDF5, `-v7.3`).
///
/// The header of a text names the columns with units in brackets: `t [s],u [N m],x1 [rad],v1 [rad/s]` for a drive, `t
/// [s],u [1],y [1]` for a process. They are divided by comma, semicolon, tab or, where none of these is there, blanks;
/// with semicolon and tab a decimal comma is understood. What a device says about itself above the header is passed
/// over. Lines that start with `#` are comments, of which the last one before the numbers is the header where the file
/// has no other and it names as many columns as there are. Units may stand in a row of their own below the names. Times
/// are numbers, dates (ISO 8601) or counts from 1970; words such as `True` and `off` are 1 and 0.
///
/// Everything but the signals of a process is converted to SI units; encoder counts state their resolution in the
/// brackets (`x1 [counts, 4096/rev]`, `x1 [counts, 0.001 mm]`). The kind is told by the columns if it is not given.
/// What no column is called is taken from the only one whose name resembles it, with a warning, and the input from the
/// only one that is left. Beside a set point the output may be that of a controller, which is the input here: the
/// values tell, and it is said. A few lines at the end that are no rows are left out with a warning. Other columns are
/// ignored with a warning.
///
/// A MATLAB file has names but no units, so it needs a mapping, such as `t=time [s], u=log.current [A], x1=enc
/// [counts:4096]`, but for an `iddata`, which says what is what. Variables in structures are addressed as in MATLAB
/// (`log.signals(2).values`, `speed.Data` of a timeseries), columns of matrices as `data(:,2)`.
///
/// # Errors
/// One line that names file and place and says what was expected, and with which options the file is read where it is
/// only not clear what is what.
pub fn import(
    name: &str,
    bytes: &[u8],
    options: &ImportOptions,
) -> Result<Measurement, ImportError> {
    let bytes = &*text::in_utf8(bytes);
    read(name, bytes, options).map_err(|error| {
        let columns = || all_columns(bytes).ok();
        let refused = |options: &ImportOptions| read(name, bytes, options).err().map(|e| e.problem);
        advise(error, options, columns, refused)
    })
}

/// Reads a measurement as [`import`] does that says itself what its columns are.
///
/// # Errors
/// As [`import`].
pub fn import_csv(
    name: &str,
    bytes: &[u8],
    kind: Option<Kind>,
) -> Result<Measurement, ImportError> {
    let options = ImportOptions {
        kind,
        ..ImportOptions::default()
    };
    import(name, bytes, &options)
}

/// Reads a measurement; an error has no advice yet.
fn read(name: &str, bytes: &[u8], options: &ImportOptions) -> Result<Measurement, ImportError> {
    match table(bytes).map_err(|(line, p)| ImportError::new(name, line, None, p))? {
        Some(table) => table.import(name, options),
        None => import_text(name, bytes, options),
    }
}

/// The series of a file; `None` of a text with columns, which is read row by row.
fn table(bytes: &[u8]) -> Result<Option<Table>, text::Located> {
    let whole = |problem| (None, problem);
    let of_matlab = |mut series: Vec<Series>| {
        // A workspace has counters and constants beside its records.
        if series.iter().any(|s| s.values.len() >= MIN_SAMPLES) {
            series.retain(|s| s.values.len() >= MIN_SAMPLES || is_period(last_name(&s.name)));
        }
        Table {
            series,
            named: false,
        }
    };
    match mat::format_of(bytes) {
        #[cfg(not(target_arch = "wasm32"))]
        Format::Hdf5 => Ok(Some(of_matlab(super::hdf5::read(bytes).map_err(whole)?))),
        #[cfg(target_arch = "wasm32")]
        Format::Hdf5 => Err(whole(Problem::Hdf5OnPage)),
        Format::Mat4 => Err(whole(Problem::Mat4)),
        Format::Mat5 => Ok(Some(of_matlab(mat::read(bytes).map_err(whole)?))),
        Format::Other => {
            if let Some(table) = text::table_of_scenario(bytes) {
                return Err(whole(Problem::Scenario { table }));
            }
            // A log may begin with a bracket, as JSON does.
            let series = match json::read(bytes) {
                Ok(Some(series)) => Some(series),
                Ok(None) => log::read(bytes),
                Err(no_json) => Some(log::read(bytes).ok_or(no_json)?),
            };
            Ok(series.map(|series| Table {
                series,
                named: true,
            }))
        }
    }
}

/// The columns of a file that are long enough to be a channel of a measurement.
///
/// # Errors
/// One line that says why the file has none, where it is damaged or of another format.
pub fn columns(name: &str, bytes: &[u8]) -> Result<Vec<FoundColumn>, ImportError> {
    let found = all_columns(&text::in_utf8(bytes));
    let mut found = found.map_err(|(line, p)| ImportError::new(name, line, None, p))?;
    found.retain(|column| column.numbers.count >= MIN_SAMPLES);
    Ok(found)
}

/// The columns of a file, however short they are.
fn all_columns(bytes: &[u8]) -> Result<Vec<FoundColumn>, text::Located> {
    Ok(match table(bytes)? {
        Some(table) => table.columns(),
        None => found::addressed(text::survey(bytes)?),
    })
}
