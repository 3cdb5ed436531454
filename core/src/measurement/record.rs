//! One experiment in SI units.

use serde::{Deserialize, Serialize};

use super::column::{Role, role};
use super::kind::{Kind, Motion, Quantity};
use crate::message::Message;
use crate::msg;

/// One recorded column in SI units.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Channel {
    /// What it is.
    pub quantity: Quantity,
    /// Its name in the file, such as `v1`.
    pub name: String,
    /// Its SI unit as written on screen, such as `rad/s`; `1` for a plain number.
    pub unit: String,
    /// One value per sample, in `unit`.
    pub values: Vec<f64>,
}

/// Units that names of columns end with.
const UNITS: [&str; 24] = [
    "deg", "degree", "degrees", "rad", "rev", "turns", "rpm", "counts", "s", "ms", "us", "m", "mm",
    "um", "n", "nm", "mnm", "a", "ma", "v", "mv", "c", "degc", "k",
];

impl Channel {
    /// Its name without the unit that the file has in it, for a reader to whom its SI unit is told: the angle of
    /// `angle_deg` is in radians here.
    pub fn title(&self) -> &str {
        let end = self.name.rsplit_once(['_', ' ', '.', '(', '[']);
        match end {
            Some((title, unit)) if !title.trim().is_empty() => {
                let unit = unit.trim_end_matches([')', ']']).to_lowercase();
                if UNITS.contains(&unit.as_str()) {
                    title.trim_end()
                } else {
                    &self.name
                }
            }
            _ => &self.name,
        }
    }
}

/// What a model leaves of a column with this name, as `x1 - model`. Behind a word a language may say minus: it would be
/// read as a hyphen.
pub fn less_model(name: &str) -> Message {
    let symbol = |word: &str| {
        word.contains(|c: char| c == '_' || c.is_ascii_digit())
            || word.chars().count() < 2
            || !word.contains(char::is_lowercase)
    };
    let column = Message::name(name);
    if name.split_whitespace().all(symbol) {
        msg!("{} - model", column)
    } else {
        msg!("{}{}", column, " - model")
    }
}

/// One experiment: an input and the outputs recorded with it.
///
/// The input is held between samples: `input.values[i]` acts from `time[i]` to `time[i + 1]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Measurement {
    /// Name shown to the user, usually the file name.
    pub name: String,
    /// Drive or process.
    pub kind: Kind,
    /// Sample times in s, strictly increasing, at least [`MIN_SAMPLES`].
    pub time: Vec<f64>,
    /// The manipulated input.
    pub input: Channel,
    /// What the model must explain: position and/or velocity of a drive, `y` of a process.
    pub outputs: Vec<Channel>,
    /// Columns kept for reference only (load position and velocity).
    pub reference: Vec<Channel>,
    /// Things worth telling the user that did not stop the import.
    pub warnings: Vec<Message>,
}

/// Fewest samples that a measurement can have; below this no noise can be told from signal.
pub const MIN_SAMPLES: usize = 20;

impl Measurement {
    /// The output with this quantity, if it was recorded.
    pub fn output(&self, quantity: Quantity) -> Option<&Channel> {
        self.outputs.iter().find(|c| c.quantity == quantity)
    }

    /// Whether the drive turns or slides, by the unit of its input.
    pub fn motion(&self) -> Motion {
        match (self.kind, self.input.unit.as_str()) {
            (Kind::Process, _) => Motion::None,
            (Kind::Drive, "N") => Motion::Translational,
            (Kind::Drive, _) if self.outputs.iter().any(|o| o.unit.starts_with('m')) => {
                Motion::Translational
            }
            (Kind::Drive, _) => Motion::Rotational,
        }
    }

    /// The measurement as CSV in SI units, which [`import_csv`](super::import_csv) reads back to the same values.
    pub fn to_csv(&self) -> String {
        use std::fmt::Write as _;
        let channels: Vec<&Channel> = std::iter::once(&self.input)
            .chain(&self.outputs)
            .chain(&self.reference)
            .collect();
        let mut text = String::from("t [s]");
        // Writing into a string cannot fail.
        for channel in &channels {
            let _ = write!(text, ",{} [{}]", channel.importable_name(), channel.unit);
        }
        text.push('\n');
        for (i, time) in self.time.iter().enumerate() {
            let _ = write!(text, "{time:?}");
            for value in channels.iter().filter_map(|c| c.values.get(i)) {
                let _ = write!(text, ",{value:?}");
            }
            text.push('\n');
        }
        text
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.time.len()
    }

    /// Whether there are no samples (never true for a checked measurement).
    pub fn is_empty(&self) -> bool {
        self.time.is_empty()
    }
}

impl Channel {
    /// Its own name where the importer would understand it, else the usual one.
    fn importable_name(&self) -> &str {
        if role(&self.name) == Some(Role::Measured(self.quantity)) {
            return &self.name;
        }
        Role::Measured(self.quantity).name()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_title_of_a_column_has_no_unit_of_the_file() {
        let title = |name: &str| {
            let channel = Channel {
                quantity: Quantity::Position,
                name: name.to_owned(),
                unit: "rad".to_owned(),
                values: Vec::new(),
            };
            channel.title().to_owned()
        };
        for (name, expected) in [
            ("angle_deg", "angle"),
            ("speed (rpm)", "speed"),
            ("motor_angle", "motor_angle"),
            ("x1", "x1"),
            ("_deg", "_deg"),
            ("", ""),
        ] {
            assert_eq!(title(name), expected);
        }
    }
}
