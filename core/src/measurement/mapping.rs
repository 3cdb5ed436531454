//! What the columns of a file mean, where the file does not say it.

use std::str::FromStr;

use super::column::{Role, shorten};
use super::period::Period;
use super::split::split_header;
use super::unit::{self, Measures};
use crate::message::{Message, says};
use crate::msg;

/// How to read a file; the default asks the file itself.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ImportOptions {
    /// Drive or process; guessed from the columns if `None`.
    pub kind: Option<super::Kind>,
    /// Which column is what, in which unit.
    pub mapping: Mapping,
    /// What a current, voltage or command as input of a drive becomes; see [`TorqueConstant`].
    pub torque_constant: Option<TorqueConstant>,
    /// The time from one sample to the next, where the file has no times, or others than these.
    pub period: Option<Period>,
}

/// Which column is what, as in `t=time [ms], u=-current [A], x1=enc [counts:4096]`.
///
/// On the left stands what it is (`t`, `u`, `x1`, `v1`, `x2`, `v2`, `y`), on the right the name in the
/// file, a minus before it where its direction is the other one, and its unit in brackets (needed where
/// the file has none). A column without a name of its own is called by its place, `column 3`; a minus
/// alone (`v1=-`) says that no column is it, whatever its name.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mapping {
    pub(super) entries: Vec<Entry>,
}

impl Mapping {
    /// Whether it says nothing.
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// Whether it says which column this is, or that none is.
    pub(super) fn speaks_of(&self, role: Role) -> bool {
        self.entries.iter().any(|entry| entry.role == role)
    }

    /// Whether a column of this name is the one meant where it stands in a mapping.
    pub(super) fn can_say(name: &str) -> bool {
        let read = format!("t={name} [s]").parse::<Self>();
        read.is_ok_and(|mapping| match mapping.entries.as_slice() {
            [only] => only.source.as_deref() == Some(name) && !only.negative,
            _ => false,
        })
    }
}

/// One column.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Entry {
    pub role: Role,
    /// Name in the file, or place; `None` where no column is it.
    pub source: Option<String>,
    pub negative: bool,
    pub unit: Option<String>,
}

/// Torque or force by current, voltage or command, such as `0.05 N m/A` or `0.002 N m/%`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TorqueConstant {
    /// In SI units.
    value: f64,
    /// Torque or force.
    pub(super) gives: Measures,
    /// Current, voltage or command.
    pub(super) per: Measures,
}

impl TorqueConstant {
    /// N m or N by A, V or the unit of a command.
    pub fn value(self) -> f64 {
        self.value
    }
}

/// Why a mapping or a torque constant cannot be understood.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum MappingError {
    /// A part without `=`, or with nothing on one side.
    NotAMapping {
        /// What was found.
        part: String,
    },
    /// Left of `=` stands no known quantity.
    UnknownQuantity {
        /// What was found.
        name: String,
    },
    /// A quantity or a column is mapped twice.
    Twice {
        /// Which.
        name: String,
    },
    /// Not a number with a unit of torque or force by current, voltage or command.
    NotATorqueConstant {
        /// What was found.
        text: String,
    },
}

impl MappingError {
    /// In words.
    pub fn message(&self) -> Message {
        match self {
            Self::NotAMapping { part } => msg!(
                "'{}' is not a mapping; expected what=column [unit], such as x1=enc [counts:4096]",
                Message::name(part.clone())
            ),
            Self::UnknownQuantity { name } => msg!(
                "'{}' is none of t, u, x1, v1, x2, v2 and y, which say what the column behind the = is",
                Message::name(name.clone())
            ),
            Self::Twice { name } => msg!(
                "'{}' appears in the mapping twice; each may appear only once",
                Message::name(name.clone())
            ),
            Self::NotATorqueConstant { text } => msg!(
                "'{}' is not a torque constant; expected a number other than zero and its unit, such as 0.05 N m/A, 2 \
                 N/A or 0.1 N m/V",
                Message::name(text.clone())
            ),
        }
    }
}

says!(MappingError);

impl FromStr for Mapping {
    type Err = MappingError;

    fn from_str(text: &str) -> Result<Self, MappingError> {
        let mut entries: Vec<Entry> = Vec::new();
        for part in split_header(text, ',') {
            let entry = entry(&part)?;
            let again = entries.iter().find_map(|e| {
                if e.role == entry.role {
                    Some(part.split('=').next().unwrap_or_default().trim())
                } else {
                    e.source.as_deref().filter(|_| e.source == entry.source)
                }
            });
            if let Some(name) = again {
                return Err(MappingError::Twice {
                    name: shorten(name),
                });
            }
            entries.push(entry);
        }
        Ok(Self { entries })
    }
}

fn entry(part: &str) -> Result<Entry, MappingError> {
    let wrong = || MappingError::NotAMapping {
        part: shorten(part),
    };
    let (what, column) = part.split_once('=').ok_or_else(wrong)?;
    let (what, column) = (what.trim(), column.trim());
    let (name, unit) = match column.split_once('[') {
        Some((name, rest)) => {
            let unit = rest.strip_suffix(']').ok_or_else(wrong)?.trim();
            (name.trim(), Some(unit.to_owned()).filter(|u| !u.is_empty()))
        }
        None => (column, None),
    };
    let (source, negative) = match name.strip_prefix('-') {
        Some(rest) => (rest.trim(), true),
        None => (name, false),
    };
    let none = column == "-";
    if what.is_empty() || (source.is_empty() && !none) {
        return Err(wrong());
    }
    // A file may call the position q; here the q of "q=u" is more likely a mistake that turns the columns round.
    let role = Role::called(what).ok_or_else(|| MappingError::UnknownQuantity {
        name: shorten(what),
    })?;
    Ok(Entry {
        role,
        source: (!none).then(|| source.to_owned()),
        negative,
        unit,
    })
}

impl FromStr for TorqueConstant {
    type Err = MappingError;

    fn from_str(text: &str) -> Result<Self, MappingError> {
        let wrong = || MappingError::NotATorqueConstant {
            text: shorten(text),
        };
        let (number, unit) = text.trim().split_once(' ').ok_or_else(wrong)?;
        let (gives, per) = unit.rsplit_once('/').ok_or_else(wrong)?;
        let number: f64 = number.parse().map_err(|_| wrong())?;
        let (gives, up) = unit::parse(gives).ok_or_else(wrong)?;
        let (per, down) = unit::parse_input(per).ok_or_else(wrong)?;
        let value = number * up / down;
        let fits =
            matches!(gives, Measures::Torque | Measures::Force) && per.needs_torque_constant();
        if !fits || !value.is_finite() || value == 0.0 {
            return Err(wrong());
        }
        Ok(Self { value, gives, per })
    }
}
