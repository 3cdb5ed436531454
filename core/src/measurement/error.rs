//! Why a file cannot be imported, in one line.

use super::unit::ACCEPTED;
use crate::count::counted;

/// Why a file cannot be imported. Shown as one line: file, line, column, what was expected.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{file}{}: {problem}{}", place(*.line, .column.as_deref()), advised(.advice.as_deref()))]
pub struct ImportError {
    /// Name of the file.
    pub file: Box<str>,
    /// Line, from 1; `None` where the file as a whole is wrong.
    pub line: Option<usize>,
    /// The column, as `3 (x1)`.
    pub column: Option<Box<str>>,
    /// What is wrong and what would be right.
    pub problem: Problem,
    /// Options of the command line with which the file is read, as far as its columns go.
    pub advice: Option<Box<str>>,
}

impl ImportError {
    /// An error at this place, without advice.
    pub(super) fn new(
        file: &str,
        line: Option<usize>,
        column: Option<String>,
        problem: Problem,
    ) -> Self {
        Self {
            file: file.into(),
            line,
            column: column.map(Into::into),
            problem,
            advice: None,
        }
    }
}

fn advised(advice: Option<&str>) -> String {
    advice.map_or_else(String::new, |advice| format!("; to read it: {advice}"))
}

fn place(line: Option<usize>, column: Option<&str>) -> String {
    let line = line.map_or_else(String::new, |line| format!(", line {line}"));
    let column = column.map_or_else(String::new, |column| format!(", column {column}"));
    line + &column
}

impl Problem {
    /// Whether it is about what the columns are and not about their values, so that a mapping can mend it.
    pub fn is_about_columns(&self) -> bool {
        matches!(
            self,
            Self::NoHeader { .. }
                | Self::NoUnit { .. }
                | Self::WrongUnit { .. }
                | Self::BareCounts { .. }
                | Self::NoColumn { .. }
                | Self::Unclear { .. }
                | Self::NoSuchColumn { .. }
                | Self::Date { .. }
                | Self::NeedlessTorqueConstant { .. }
                | Self::NotMapped { .. }
                | Self::Lengths { .. }
                | Self::Twice { .. }
                | Self::Mixed { .. }
        )
    }
}

/// What is wrong with a file.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[allow(missing_docs, reason = "the message of each says it")]
pub enum Problem {
    #[error(
        "the file is empty; expected a header such as t [s],u [N m],x1 [rad],v1 [rad/s] and rows of numbers"
    )]
    Empty,
    #[error("the file is not text in UTF-8 here; save it as CSV in UTF-8")]
    NotText,
    #[error(
        "'{found}' is not a header; the first line must name the columns with units, such as t [s],u [N m],x1 [rad],v1 [rad/s] or t [s],u [1],y [1]"
    )]
    NoHeader { found: String },
    #[error(
        "no unit; write it in brackets after the name, such as {name} [{example}]; accepted: {ACCEPTED}"
    )]
    NoUnit { name: String, example: &'static str },
    #[error("the unit '{unit}' does not fit; expected {expected}")]
    WrongUnit { unit: String, expected: String },
    #[error(
        "counts need their resolution, such as {name} [counts, 4096/rev] or {name} [counts, 0.001 mm]"
    )]
    BareCounts { name: String },
    #[error("no column '{wanted}'; {hint}")]
    NoColumn {
        wanted: &'static str,
        hint: &'static str,
    },
    #[error("no column '{wanted}', and it is not clear which is meant: {found}")]
    Unclear { wanted: &'static str, found: String },
    #[error(
        "the column '{name}' has dates or times of day that are not understood, such as '{text}'; expected 2025-01-31T09:27:03.5, 31.01.2025 09:27:03 or 09:27:03.5, or a number of seconds: t [s]"
    )]
    Date { name: String, text: String },
    #[error("no column '{wanted}' to map; the file has {found}")]
    NoSuchColumn { wanted: String, found: String },
    #[error(
        "a torque constant by {given} does not fit an input in {unit}; it makes torque of a current in A, a voltage in V or a command in %, PWM, counts or 1"
    )]
    NeedlessTorqueConstant { unit: String, given: &'static str },
    #[error(
        "a file of MATLAB does not say which variable is what; map them, such as t=time [s], u=current [A], x1=angle [rad]; it has {found}"
    )]
    NotMapped { found: String },
    #[error("{found} values, but '{other}' has {expected}; all must have the same number")]
    Lengths {
        found: usize,
        other: String,
        expected: usize,
    },
    #[error("there are no numbers in the file; expected times, an input and an output")]
    NoNumbers,
    #[error(
        "the file is a scenario with a table [{table}], no measurement: `hysteron simulate` and `hysteron limit-cycle` take it, and the pages Explore and Backlash"
    )]
    Scenario { table: &'static str },
    #[error("the file begins as JSON does, but is none: {what}")]
    Json { what: String },
    #[error(
        "the HDF5 file is damaged, or has what is not read here: {what}; save it from MATLAB with -v7"
    )]
    Hdf5Damaged { what: String },
    #[cfg(target_arch = "wasm32")]
    #[error(
        "a MATLAB v7.3 file (HDF5), which the page does not read; save it with -v7, or open it in the desktop app"
    )]
    Hdf5OnPage,
    #[error("what begins at byte {byte} of the MAT-file is damaged; expected {expected} in it")]
    MatDamaged { byte: usize, expected: &'static str },
    #[error("the file unpacks to more than {mebibytes} MiB; save only the variables needed")]
    MatTooLarge { mebibytes: usize },
    #[error("a MAT-file of level 4, as MATLAB's save -v4 writes it; save it with -v7")]
    Mat4,
    #[error("the column '{name}' stands there twice; each may come once")]
    Twice { name: String },
    #[error(
        "rotational and translational units are mixed ({one} and {other}); use N m with rad, or N with m"
    )]
    Mixed { one: String, other: String },
    #[error("{}, but the header has {expected}{hint}", counted(*found, "field"))]
    Ragged {
        found: usize,
        expected: usize,
        hint: &'static str,
    },
    #[error("'{text}' is not a number; expected e.g. 0.25 or 1e-3")]
    NotANumber { text: String },
    #[error("'{text}' is not finite; remove the row or measure again")]
    NotFinite { text: String },
    #[error(
        "'{text}' is no measurement: it is too large or too small to calculate with, by itself or beside the rest of its column; remove the row or measure again"
    )]
    Size { text: String },
    #[error(
        "time does not increase ({now} s after {before} s); rows must be in order of time, each time once"
    )]
    TimeOrder { before: String, now: String },
    #[error(
        "time does not increase: {time} s stands in two rows with different values; where the clock is too coarse for its rows, give the sampling period, which then counts instead"
    )]
    TimeTwice { time: String },
    #[error(
        "time begins anew here ({now} s after {before} s), as in another run; what a process did between two runs is not known: save each run in a file of its own"
    )]
    TimeBeginsAnew { before: String, now: String },
    #[error("only {} of numbers; at least {expected} are needed to tell noise from signal", counted(*found, "row"))]
    TooShort { found: usize, expected: usize },
}
