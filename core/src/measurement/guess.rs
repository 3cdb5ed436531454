//! What the columns of a file most likely are: by their units, by what their names resemble, and by the order of their
//! values. A form that someone looks over gets the likeliest; where nobody is asked, only what can be no other is taken
//! (`fill`).

use super::clock::unit_from_1970;
use super::found::FoundColumn;
use super::header::Role;
use super::resembling::{RESEMBLING, is_of_process};
use super::unit::{COUNTS, is_bare_counts, parse_input, usual_units};
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
            let said = || suffix(&self.name).unwrap_or_else(|| "1".to_owned());
            return Some(self.unit.clone().unwrap_or_else(said));
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
        suffix(&self.name)
            .filter(|u| counted(u) || role.takes(kind, u))
            .map(|unit| as_usual(&unit, usual))
    }
}

/// Longest unit at the end of a name, such as the `rad_s` of `speed_rad_s`, as [`parse_input`] reads it.
fn suffix(name: &str) -> Option<String> {
    let name = name.trim();
    if let Some(sign) = name.chars().next_back().filter(|c| matches!(c, '%' | '°')) {
        return Some(sign.to_string());
    }
    let parts: Vec<&str> = name
        .split(|c: char| !c.is_alphanumeric() && c != '/')
        .filter(|p| !p.is_empty())
        .collect();
    let whole = match parts.as_slice() {
        [.., a, "per" | "Per", b] | [.., a, b @ ("s" | "sec" | "min")] => format!("{a}/{b}"),
        [.., a, "m"] => format!("{a} m"),
        _ => String::new(),
    };
    if is_unit(&whole) {
        return Some(whole);
    }
    let (&last, others) = parts.split_last()?;
    let letter = |unit: &str| unit.chars().nth(1).is_none();
    let reads = |unit: &str| is_unit(unit) && (!letter(unit) || LETTERS.contains(&unit));
    // `pos_mm`, but not `x` or `V`: a letter alone is a name.
    let name_alone = others.is_empty() && letter(last);
    if reads(last) && !name_alone {
        return Some(divided(last));
    }
    // `posMm` and `velRadPerSec`: from each capital letter behind a small one.
    let pairs = last.char_indices().zip(last.char_indices().skip(1));
    let begins = pairs.filter(|((_, a), (_, b))| a.is_lowercase() && b.is_uppercase());
    for ((before, _), (at, _)) in begins {
        let tail = &last[at..];
        // The m of `torquemNm` may be the end of a word or a thousandth.
        if is_unit(&last[before..]) {
            return None;
        }
        let unit = if letter(tail) {
            tail.to_owned()
        } else {
            let mut small = tail.chars();
            let first = small.next().into_iter().flat_map(char::to_lowercase);
            first.chain(small).collect()
        };
        if reads(&unit) {
            return Some(divided(&unit));
        }
    }
    None
}

/// Units of one letter, which are read in this case only: `Strom_A` is in amperes, `phase_a` is a phase.
const LETTERS: [&str; 5] = ["s", "m", "N", "A", "V"];

/// `radPerSec` with a line.
fn divided(unit: &str) -> String {
    let lower = unit.to_lowercase();
    match lower.split_once("per") {
        Some((above, below)) if !above.is_empty() => format!("{above}/{below}"),
        _ => unit.to_owned(),
    }
}

/// Whether this is a unit that a name may end with.
fn is_unit(text: &str) -> bool {
    let number = text.ends_with(|c: char| !c.is_alphabetic());
    !number
        && (is_bare_counts(text) || parse_input(&divided(text)).is_some() || is_of_process(text))
}

/// The unit as the lists spell it, if they have it.
fn as_usual(unit: &str, usual: &[&str]) -> String {
    if is_bare_counts(unit) && usual.contains(&COUNTS) {
        return COUNTS.to_owned();
    }
    let same = |other: &&&str| parse_input(other).is_some_and(|p| Some(p) == parse_input(unit));
    usual
        .iter()
        .find(same)
        .map_or_else(|| unit.to_owned(), |u| (*u).to_owned())
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
                "v1=Drehzahl [U/min]",
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

    #[test]
    fn a_unit_is_read_at_the_end_of_a_name() {
        let input = Role::Measured(Quantity::Input);
        let position = Role::Measured(Quantity::Position);
        let velocity = Role::Measured(Quantity::Velocity);
        for (name, role, unit) in [
            ("speed_rad_s", velocity, "rad/s"),
            ("velRadPerSec", velocity, "rad/s"),
            ("omega_deg_per_s", velocity, "deg/s"),
            ("Drehzahl_upm", velocity, "rpm"),
            ("axis 1 m/s", velocity, "m/s"),
            ("pos_m_s", velocity, "m/s"),
            ("torque_N_m", input, "N m"),
            ("torque_mNm", input, "mN m"),
            ("motorNm", input, "N m"),
            ("torquemNm", input, ""),
            ("iqMA", input, "mA"),
            ("current_ma", input, "mA"),
            ("currentA", input, "A"),
            ("phase_a", input, ""),
            ("heater_%", input, "%"),
            ("command_1", input, ""),
            ("motor_pwm", input, "PWM"),
            ("u", input, ""),
            ("V", input, ""),
            ("position_degrees", position, "deg"),
            ("enc_ticks", position, "counts"),
            ("posMm", position, "mm"),
            ("pos_mm", velocity, ""),
            ("millis", Role::Time, "ms"),
            ("Zeit_sek_ms", Role::Time, "ms"),
            ("t_seconds", Role::Time, "s"),
            ("t", Role::Time, ""),
            ("uptime", Role::Time, ""),
        ] {
            let column = FoundColumn {
                name: name.to_owned(),
                address: name.to_owned(),
                unit: None,
                known_as: None,
                numbers: super::super::found::Numbers::default(),
            };
            let found = column.unit_as(role, Kind::Drive).unwrap_or_default();
            assert_eq!(found, unit, "{name}");
        }
    }
}
