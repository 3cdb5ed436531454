//! Why a file cannot be imported, in one line.

use super::unit::ACCEPTED;
use crate::counted;
use crate::message::{Message, says};
use crate::msg;

/// Why a file cannot be imported. Shown as one line: file, line, column, what was expected.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
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
    /// In words.
    pub fn message(&self) -> Message {
        let file = Message::name(&*self.file);
        let mut what = self.problem.message();
        if let Some(advice) = self.advice.as_deref() {
            what = msg!("{}; to read it: {}", what, Message::name(advice));
        }
        match (self.line, self.column.as_deref().map(Message::name)) {
            (Some(line), Some(column)) => {
                msg!("{}, line {}, column {}: {}", file, line, column, what)
            }
            (Some(line), None) => msg!("{}, line {}: {}", file, line, what),
            (None, Some(column)) => msg!("{}, column {}: {}", file, column, what),
            (None, None) => msg!("{}: {}", file, what),
        }
    }
}

says!(ImportError);

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
    Empty,
    NotText,
    NoHeader {
        found: String,
    },
    NoUnit {
        name: String,
        example: &'static str,
    },
    WrongUnit {
        unit: String,
        expected: Box<Message>,
    },
    BareCounts {
        name: String,
    },
    NoColumn {
        wanted: &'static str,
        hint: &'static str,
    },
    Unclear {
        wanted: &'static str,
        found: String,
    },
    Date {
        name: String,
        text: String,
    },
    NoSuchColumn {
        wanted: String,
        found: String,
    },
    NeedlessTorqueConstant {
        unit: String,
        given: &'static str,
    },
    NotMapped {
        found: String,
    },
    Lengths {
        found: usize,
        other: String,
        expected: usize,
    },
    NoNumbers,
    Scenario {
        table: &'static str,
    },
    Json {
        what: String,
    },
    Hdf5Damaged {
        what: String,
    },
    #[cfg(target_arch = "wasm32")]
    Hdf5OnPage,
    MatDamaged {
        byte: usize,
        expected: &'static str,
    },
    MatTooLarge {
        mebibytes: usize,
    },
    Mat4,
    Twice {
        name: String,
    },
    Mixed {
        one: String,
        other: String,
    },
    Ragged {
        found: usize,
        expected: usize,
        hint: &'static str,
    },
    NotANumber {
        text: String,
    },
    NotFinite {
        text: String,
    },
    Size {
        text: String,
    },
    TimeOrder {
        before: String,
        now: String,
    },
    TimeTwice {
        time: String,
    },
    TimeBeginsAnew {
        before: String,
        now: String,
    },
    TooShort {
        found: usize,
        expected: usize,
    },
}

impl Problem {
    /// In words.
    pub fn message(&self) -> Message {
        match self {
            Self::Empty => {
                "the file is empty; expected a header such as t [s],u [N m],x1 [rad],v1 [rad/s] and rows of \
                 numbers"
                    .into()
            }
            Self::NotText => "the file is not text in UTF-8 here; save it as CSV in UTF-8".into(),
            Self::NoHeader { found } => msg!(
                "'{}' is not a header; the first line must name the columns with units, such as t [s],u [N \
                 m],x1 [rad],v1 [rad/s] or t [s],u [1],y [1]",
                Message::name(found.clone())
            ),
            Self::NoUnit { name, example } => msg!(
                "no unit; write it in brackets after the name, such as {} [{}]; accepted: {}",
                Message::name(name.clone()),
                example,
                ACCEPTED
            ),
            Self::WrongUnit { unit, expected } => msg!(
                "the unit '{}' does not fit; expected {}",
                Message::name(unit.clone()),
                &**expected
            ),
            Self::BareCounts { name } => msg!(
                "counts need their resolution, such as {} [counts, 4096/rev] or {} [counts, 0.001 mm]",
                Message::name(name.clone()),
                Message::name(name.clone())
            ),
            Self::NoColumn { wanted, hint } => msg!("no column '{}'; {}", wanted, hint),
            Self::Unclear { wanted, found } => msg!(
                "no column '{}', and it is not clear which is meant: {}",
                wanted,
                Message::name(found.clone())
            ),
            Self::Date { name, text } => msg!(
                "the column '{}' has dates or times of day that are not understood, such as '{}'; expected \
                 2025-01-31T09:27:03.5, 31.01.2025 09:27:03 or 09:27:03.5, or a number of seconds: t [s]",
                Message::name(name.clone()),
                Message::name(text.clone())
            ),
            Self::NoSuchColumn { wanted, found } => msg!(
                "no column '{}' to map; the file has {}",
                Message::name(wanted.clone()),
                Message::name(found.clone())
            ),
            Self::NeedlessTorqueConstant { unit, given } => msg!(
                "a torque constant per {} does not fit an input in {}; it turns a current in A, a voltage in V or a \
                 command in %, PWM, counts or 1 into a torque",
                given,
                Message::name(unit.clone())
            ),
            Self::NotMapped { found } => msg!(
                "a MATLAB file does not say which variable is what; map them, such as t=time [s], u=current [A], \
                 x1=angle [rad]; it has {}",
                Message::name(found.clone())
            ),
            Self::Lengths { found, other, expected } => msg!(
                "{} values, but '{}' has {}; all must have the same number",
                found,
                Message::name(other.clone()),
                expected
            ),
            Self::NoNumbers => {
                "there are no numbers in the file; expected times, an input and an output"
                    .into()
            }
            Self::Scenario { table } => msg!(
                "the file is a scenario with a table [{}], no measurement: `hysteron simulate` and `hysteron \
                 limit-cycle` take it, and the pages Explore and Backlash",
                table
            ),
            Self::Json { what } => msg!(
                "the file begins like JSON, but is not JSON: {}",
                Message::name(what.clone())
            ),
            Self::Hdf5Damaged { what } => msg!(
                "the HDF5 file is damaged, or has something that is not read here: {}; save it from MATLAB with -v7",
                Message::name(what.clone())
            ),
            #[cfg(target_arch = "wasm32")]
            Self::Hdf5OnPage => {
                "a MATLAB v7.3 file (HDF5), which the page does not read; save it with -v7, or open it in the \
                 desktop app"
                    .into()
            }
            Self::MatDamaged { byte, expected } => msg!(
                "what begins at byte {} of the MAT-file is damaged; expected {} in it",
                byte,
                expected
            ),
            Self::MatTooLarge { mebibytes } => msg!(
                "the file unpacks to more than {} MiB; save only the variables needed",
                mebibytes
            ),
            Self::Mat4 => {
                "a MAT-file of level 4, as MATLAB's save -v4 writes it; save it with -v7"
                    .into()
            }
            Self::Twice { name } => msg!(
                "the column '{}' appears twice; each may appear only once",
                Message::name(name.clone())
            ),
            Self::Mixed { one, other } => msg!(
                "rotational and translational units are mixed ({} and {}); use N m with rad, or N with m",
                Message::name(one.clone()),
                Message::name(other.clone())
            ),
            Self::Ragged { found, expected, hint } => {
                let fields = counted!(*found, "1 field", "{} fields");
                match *hint {
                    "" => msg!("{}, but the header has {}", fields, expected),
                    hint => msg!("{}, but the header has {}; {}", fields, expected, hint),
                }
            },
            Self::NotANumber { text } => msg!(
                "'{}' is not a number; expected e.g. 0.25 or 1e-3",
                Message::name(text.clone())
            ),
            Self::NotFinite { text } => msg!(
                "'{}' is not finite; remove the row or measure again",
                Message::name(text.clone())
            ),
            Self::Size { text } => msg!(
                "'{}' is not a measurement: it is too large or too small to calculate with, by itself or next to the \
                 rest of its column; remove the row or measure again",
                Message::name(text.clone())
            ),
            Self::TimeOrder { before, now } => msg!(
                "time does not increase ({} s after {} s); rows must be in order of time, each time once",
                Message::name(now.clone()),
                Message::name(before.clone())
            ),
            Self::TimeTwice { time } => msg!(
                "time does not increase: {} s appears in two rows with different values; if the clock is too coarse \
                 for its rows, give the sampling period, which is then used instead",
                Message::name(time.clone())
            ),
            Self::TimeBeginsAnew { before, now } => msg!(
                "time starts over here ({} s after {} s), as in another run; what a process did between two runs is \
                 not known: save each run in a file of its own",
                Message::name(now.clone()),
                Message::name(before.clone())
            ),
            Self::TooShort { found, expected } => msg!(
                "only {} of numbers; at least {} are needed to tell noise from signal",
                counted!(*found, "1 row", "{} rows"),
                expected
            ),
        }
    }
}

says!(Problem);
