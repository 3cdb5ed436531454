//! What the columns of a file most likely are: by their units, by what their names resemble, and by the order of their
//! values. A form that someone looks over gets the likeliest; where nobody is asked, only what can be no other is taken
//! (`fill`).

use super::clock::unit_from_1970;
use super::found::FoundColumn;
use super::header::Role;
use super::resembling::{RESEMBLING, words};
use super::unit::{COUNTS, is_bare_counts, usual_units};
use super::{Kind, Quantity};

/// What the columns of a file most likely are.
#[derive(Clone, Debug, PartialEq)]
pub struct Guess {
    /// Drive or process.
    pub kind: Kind,
    /// What is what, by the place of its column among those that were given.
    pub channels: Vec<(Role, usize)>,
}

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

impl FoundColumn {
    /// The unit that it most likely has in this role, where something says it.
    pub fn unit_as(&self, role: Role, kind: Kind) -> Option<String> {
        if kind == Kind::Process && role != Role::Time {
            return Some(self.unit.clone().unwrap_or_else(|| "1".to_owned()));
        }
        let first = self.numbers.first.first().copied().unwrap_or_default();
        if role == Role::Time && self.numbers.dates {
            return Some("s".to_owned());
        }
        if role == Role::Time
            && self.unit.is_none()
            && let Some(unit) = unit_from_1970(first)
        {
            return Some(unit.to_owned());
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
        check(
            "Time;Q1;T1",
            Kind::Process,
            &["t=Time []", "u=Q1 [1]", "y=T1 [1]"],
        );
        check(
            "t [s];pump [%];setpoint level [cm];level [cm]",
            Kind::Process,
            &["t=t [s]", "u=pump [%]", "y=level [cm]"],
        );
        check(
            "t [s];pwm [%];target angle [deg];angle_1 [deg];a [degC]",
            Kind::Drive,
            &["t=t [s]", "x1=angle_1 [deg]", "u=pwm [%]", "y=a []"],
        );
        check("t;command_1", Kind::Drive, &["t=t []", "u=command_1 []"]);
        check("1;2;3", Kind::Drive, &[]);
    }
}
