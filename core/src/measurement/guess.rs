//! What the columns of a file most likely are, for a form that someone looks over: by their units, by what their names
//! resemble, and by the order of their values.

use super::found::FoundColumn;
use super::header::Role;
use super::unit::{COUNTS, is_bare_counts, parse, usual_units};
use super::{Kind, Quantity};

/// What the columns of a file most likely are.
#[derive(Clone, Debug, PartialEq)]
pub struct Guess {
    /// Drive or process.
    pub kind: Kind,
    /// What is what, by the place of its column among those that were given.
    pub channels: Vec<(Role, usize)>,
}

/// What resembles a role: parts of names, and whole words that are too short to be looked for in others.
struct Resembling {
    role: Role,
    parts: &'static [&'static str],
    words: &'static [&'static str],
}

/// In English and German; what is told most surely comes first.
const RESEMBLING: [Resembling; 5] = [
    Resembling {
        role: Role::Time,
        parts: &["time", "zeit", "second", "sekunde"],
        words: &["t", "sec"],
    },
    Resembling {
        role: Role::Measured(Quantity::Velocity),
        parts: &[
            "veloc", "speed", "geschw", "drehzahl", "omega", "rpm", "tacho",
        ],
        words: &["v", "v1", "vel", "w", "n"],
    },
    Resembling {
        role: Role::Measured(Quantity::Position),
        parts: &[
            "pos",
            "angle",
            "winkel",
            "lage",
            "theta",
            "phi",
            "count",
            "inkrement",
        ],
        words: &["x", "x1", "q", "enc", "encoder", "weg"],
    },
    Resembling {
        role: Role::Measured(Quantity::Input),
        parts: &[
            "torque", "moment", "force", "kraft", "current", "strom", "volt", "spannung",
            "command", "stell", "input", "eingang", "power", "leistung",
        ],
        words: &["u", "i", "iq", "m", "f", "tau"],
    },
    Resembling {
        role: Role::Measured(Quantity::Output),
        parts: &[
            "output", "ausgang", "temp", "press", "druck", "level", "stand", "flow", "fluss",
            "istwert",
        ],
        words: &["y"],
    },
];

/// Guesses what columns are.
pub fn guess(columns: &[FoundColumn]) -> Guess {
    let mut channels: Vec<(Role, usize)> = Vec::new();
    for resembling in &RESEMBLING {
        let free = (0..columns.len()).filter(|i| channels.iter().all(|(_, taken)| taken != i));
        // Of equally likely ones the first, which is the last that is seen.
        let best = free.rev().max_by_key(|i| resembling.likeness(&columns[*i]));
        if let Some(i) = best.filter(|i| resembling.likeness(&columns[*i]) > 0) {
            channels.push((resembling.role, i));
        }
    }
    let has = |q| channels.iter().any(|(role, _)| *role == Role::Measured(q));
    let moves = has(Quantity::Position) || has(Quantity::Velocity);
    let kind = if has(Quantity::Output) && !moves {
        Kind::Process
    } else {
        Kind::Drive
    };
    Guess { kind, channels }
}

impl Resembling {
    /// How much a column looks like it; 0 for not at all.
    fn likeness(&self, column: &FoundColumn) -> u32 {
        let still = column
            .numbers
            .range
            .is_none_or(|[least, largest]| least == largest);
        if still || (self.role == Role::Time && !column.numbers.increase()) {
            return 0;
        }
        if column.known_as == Some(self.role) {
            return 100;
        }
        let unit = column.unit.as_deref().filter(|u| parse(u).is_some());
        let fits =
            unit.map(|u| !usual_units(self.role).is_empty() && self.role.takes(Kind::Drive, u));
        let name = column.name.to_lowercase();
        let part = self.parts.iter().any(|p| name.contains(p));
        let word = words(&name).any(|w| self.words.contains(&w));
        match fits {
            Some(false) => 0,
            fits => 20 * u32::from(fits.is_some()) + 10 * u32::from(part || word),
        }
    }
}

/// The words of a name, such as `motor` and `pos` in `motor_pos`.
fn words(name: &str) -> impl DoubleEndedIterator<Item = &str> {
    name.split(|c: char| !c.is_alphanumeric() && c != '/')
        .filter(|w| !w.is_empty())
}

impl FoundColumn {
    /// The unit that it most likely has in this role, where something says it.
    pub fn unit_as(&self, role: Role, kind: Kind) -> Option<String> {
        if kind == Kind::Process && role != Role::Time {
            return Some(self.unit.clone().unwrap_or_else(|| "1".to_owned()));
        }
        let usual = usual_units(role);
        let counted = |unit: &str| usual.contains(&COUNTS) && is_bare_counts(unit);
        if let Some(unit) = &self.unit {
            if counted(unit) {
                return Some(COUNTS.to_owned());
            }
            return role.takes(kind, unit).then(|| unit.clone());
        }
        let last = words(&self.name).next_back()?;
        if counted(last) {
            return Some(COUNTS.to_owned());
        }
        // `pos_mm`, but not `x`: a name that is a unit alone says nothing, nor does the 1 of `command_1`.
        let named = last.len() < self.name.len() && last != "1" && usual.contains(&last);
        named.then(|| last.to_owned())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measurement::columns;

    /// What is guessed of a file with this header, as `what=column [unit]`.
    fn guessed(header: &str) -> (Kind, Vec<String>) {
        use std::fmt::Write as _;
        let width = header.split(';').count();
        let mut text = header.to_owned();
        for row in 0..30_u32 {
            // Only the first column increases.
            let _ = write!(text, "\n{row}");
            for column in 1..width as u32 {
                let _ = write!(text, ";{}", (row * column) % 7);
            }
        }
        let columns = columns("x.csv", text.as_bytes()).unwrap();
        let guess = guess(&columns);
        let said = |&(role, i): &(Role, usize)| {
            let column = &columns[i];
            let unit = column.unit_as(role, guess.kind).unwrap_or_default();
            format!("{}={} [{unit}]", role.name(), column.address)
        };
        (guess.kind, guess.channels.iter().map(said).collect())
    }

    fn check(header: &str, kind: Kind, expected: &[&str]) {
        assert_eq!(
            guessed(header),
            (kind, expected.iter().map(|s| (*s).to_owned()).collect())
        );
    }

    #[test]
    fn names_and_units_tell() {
        check(
            "Zeit_ms;Status;Strom_A;Encoder;Drehzahl [U/min]",
            Kind::Drive,
            &[
                "t=Zeit_ms [ms]",
                "v1=Drehzahl []",
                "x1=Encoder []",
                "u=Strom_A [A]",
            ],
        );
        check(
            "log.time;log.iq;log.pos_mm",
            Kind::Drive,
            &["t=log.time []", "x1=log.pos_mm [mm]", "u=log.iq []"],
        );
        check(
            "a [s];b [mN m];c [rpm];d [deg];d [N]",
            Kind::Drive,
            &["t=a [s]", "v1=c [rpm]", "x1=column 4 [deg]", "u=b [mN m]"],
        );
        check(
            "Zeit (s);Heizleistung [%];Kesseltemperatur",
            Kind::Process,
            &["t=Zeit [s]", "u=Heizleistung [%]", "y=Kesseltemperatur [1]"],
        );
        check("1;2;3", Kind::Drive, &[]);
    }
}
