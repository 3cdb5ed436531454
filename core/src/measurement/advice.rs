//! Words for the command line with which a file is read that does not say what its columns are.

use std::fmt::Write as _;

use super::column::Role;
use super::error::{ImportError, Problem};
use super::found::FoundColumn;
use super::guess::guess;
use super::mapping::{ImportOptions, Mapping};
use super::period::Period;
use super::resembling::resembles;
use super::unit::{COUNTS, parse};
use super::{Kind, Quantity};

const INPUT: Role = Role::Measured(Quantity::Input);
const POSITION: Role = Role::Measured(Quantity::Position);
const VELOCITY: Role = Role::Measured(Quantity::Velocity);
const OUTPUT: Role = Role::Measured(Quantity::Output);

/// Adds to an error about what the columns are the words with which the file is read, or its values at least: tried out,
/// so that they are no promise. `columns` finds what the file has, and `refused` says why it is not read in a way.
pub(super) fn advise(
    error: ImportError,
    options: &ImportOptions,
    columns: impl FnOnce() -> Option<Vec<FoundColumn>>,
    refused: impl Fn(&ImportOptions) -> Option<Problem>,
) -> ImportError {
    if !error.problem.is_about_columns() {
        return error;
    }
    let Some(columns) = columns() else {
        return error;
    };
    let called = |role| columns.iter().any(|c| resembles(role, &c.name));
    let moves = guess(&columns)
        .channels
        .iter()
        .any(|(r, _)| matches!(*r, POSITION | VELOCITY))
        || called(POSITION)
        || called(VELOCITY);
    let kinds = match options.kind {
        Some(kind) => vec![kind],
        None if moves => vec![Kind::Drive, Kind::Process],
        None => vec![Kind::Process, Kind::Drive],
    };
    let all = kinds
        .into_iter()
        .filter_map(|kind| Some((kind, Words::find(&columns, options, kind)?)));
    // A period may stand in the file, so that none is needed.
    let all = all.flat_map(|(kind, words)| [(kind, words.clone(), false), (kind, words, true)]);
    let words = all.into_iter().find_map(|(kind, mut words, periodic)| {
        words.periodic &= periodic;
        let problem = refused(&words.options(options, kind)?);
        let reads = problem.is_none_or(|problem| !problem.is_about_columns());
        reads.then(|| words.text(options))
    });
    ImportError {
        advice: words.map(Into::into),
        ..error
    }
}

/// A column in a mapping.
#[derive(Clone)]
struct Word {
    role: Role,
    negative: bool,
    column: usize,
    /// In its brackets; `None` where the file says it or none is needed.
    unit: Option<String>,
    /// Whether nothing says the unit, and someone has to.
    assumed: bool,
}

/// A mapping, and whether a period is needed besides.
#[derive(Clone)]
struct Words {
    columns: Vec<Word>,
    map: String,
    periodic: bool,
    quoted: char,
}

impl Words {
    /// What the columns most likely are, with what was said of them already.
    fn find(columns: &[FoundColumn], options: &ImportOptions, kind: Kind) -> Option<Self> {
        let mut places: Vec<(Role, usize, bool)> = Vec::new();
        let mut units: Vec<(Role, String)> = Vec::new();
        for entry in &options.mapping.entries {
            let source = entry.source.as_deref().unwrap_or_default();
            let named = columns
                .iter()
                .position(|c| c.address == source || c.name == source);
            if let Some(column) = named {
                places.push((entry.role, column, entry.negative));
                units.extend(entry.unit.clone().map(|unit| (entry.role, unit)));
            }
        }
        let out = |role: Role| {
            let entries = &options.mapping.entries;
            entries.iter().any(|e| e.role == role && e.source.is_none())
        };
        let needed: &[Role] = match kind {
            Kind::Drive => &[Role::Time, INPUT, POSITION, VELOCITY],
            Kind::Process => &[Role::Time, INPUT, OUTPUT],
        };
        let timed = options.period.is_some();
        let needed: Vec<Role> = needed
            .iter()
            .copied()
            .filter(|role| !(out(*role) || timed && *role == Role::Time))
            .collect();
        places.retain(|(role, ..)| needed.contains(role) || matches!(role, Role::Measured(_)));
        for (role, column) in guess(columns).channels {
            let taken = places.iter().any(|(r, c, _)| *r == role || *c == column);
            if needed.contains(&role) && !taken {
                places.push((role, column, false));
            }
        }
        for role in needed {
            let optional = matches!(
                role,
                Role::Measured(Quantity::Position | Quantity::Velocity)
            );
            let moves = places
                .iter()
                .any(|(r, ..)| matches!(*r, POSITION | VELOCITY));
            if places.iter().any(|(r, ..)| *r == role) || (optional && moves) {
                continue;
            }
            let free = |i: &usize| places.iter().all(|(_, c, _)| c != i);
            let free = || (0..columns.len()).filter(free);
            let named = free().find(|i| resembles(role, &columns[*i].name));
            let left = named.or_else(|| free().find(|i| may_be(role, &columns[*i])));
            // What moves has one column of two, the position by anything.
            let left = left.filter(|_| role != POSITION || named.is_some() || !speeds(columns));
            match left {
                Some(column) => places.push((role, column, false)),
                None if matches!(role, Role::Time | POSITION) => {}
                None => return None,
            }
        }
        let periodic = !timed && places.iter().all(|(role, ..)| *role != Role::Time);
        let order = [Role::Time, INPUT, POSITION, VELOCITY, OUTPUT];
        places.sort_by_key(|(role, ..)| order.iter().position(|r| r == role));
        let slides = places.iter().any(|(role, column, _)| {
            let unit = columns[*column].unit_as(*role, kind).unwrap_or_default();
            let unit = units
                .iter()
                .find(|(r, _)| r == role)
                .map_or(unit, |(_, u)| u.clone());
            parse(&unit).is_some_and(|(measures, _)| matches!(measures.si(), "N" | "m" | "m/s"))
        });
        let words = places.into_iter().map(|(role, column, negative)| {
            let said = units
                .iter()
                .find(|(r, _)| *r == role)
                .map(|(_, unit)| unit.clone());
            let found = &columns[column];
            let (unit, assumed) = match said.filter(|unit| role.takes(kind, unit)) {
                Some(unit) => (Some(unit), false),
                None => unit(role, kind, found, slides),
            };
            Word {
                role,
                negative,
                column,
                unit,
                assumed,
            }
        });
        Self::write(words.collect(), columns, periodic)
    }

    /// Writes the mapping; `None` where a shell would not leave it as it is.
    fn write(words: Vec<Word>, columns: &[FoundColumn], periodic: bool) -> Option<Self> {
        let mut parts: Vec<String> = Vec::new();
        for word in &words {
            let sign = if word.negative { "-" } else { "" };
            let address = &columns[word.column].address;
            let mut part = format!("{}={sign}{address}", word.role.name());
            if let Some(unit) = &word.unit {
                // Writing into a string cannot fail.
                let _ = write!(part, " [{unit}]");
            }
            parts.push(part);
        }
        // Nothing else is taken by its name.
        let others = columns.iter().filter_map(|c| c.known_as);
        for role in others.filter(|role| words.iter().all(|w| w.role != *role)) {
            let out = format!("{}=-", role.name());
            if !parts.contains(&out) && role != Role::Time {
                parts.push(out);
            }
        }
        let map = parts.join(", ");
        let special = |c: char| matches!(c, '"' | '$' | '`' | '\\' | '!');
        let quoted = if map.contains(special) { '\'' } else { '"' };
        let fits = (!map.contains('\'') || quoted == '"') && !map.contains(char::is_control);
        fits.then_some(Self {
            columns: words,
            map,
            periodic,
            quoted,
        })
    }

    /// The same for the importer.
    fn options(&self, options: &ImportOptions, kind: Kind) -> Option<ImportOptions> {
        let period = self.periodic.then(|| Period::from_seconds(1.0)).flatten();
        Some(ImportOptions {
            // A kind that was not asked for is told by the mapping, or the words do not do.
            kind: options.kind.filter(|k| *k == kind),
            mapping: self.map.parse::<Mapping>().ok()?,
            torque_constant: options.torque_constant,
            period: options.period.or(period),
        })
    }

    fn text(&self, options: &ImportOptions) -> String {
        let mut text = match options.kind {
            Some(kind) => format!("--kind {} ", kind.name()),
            None => String::new(),
        };
        if let Some(period) = options.period {
            let _ = write!(text, "--period {}s ", period.seconds());
        }
        if self.periodic {
            text.push_str("--period 1s ");
        }
        let quoted = self.quoted;
        let _ = write!(text, "--map {quoted}{}{quoted}", self.map);
        match (self.periodic, self.columns.iter().any(|word| word.assumed)) {
            (true, true) => text.push_str(" with the true period and units"),
            (true, false) => text.push_str(" with the true period"),
            (false, true) => text.push_str(" with the true units"),
            (false, false) => {}
        }
        text
    }
}

/// Whether a column is called as velocities are.
fn speeds(columns: &[FoundColumn]) -> bool {
    columns.iter().any(|c| resembles(VELOCITY, &c.name))
}

/// Whether a column may have this role that resembles nothing.
fn may_be(role: Role, column: &FoundColumn) -> bool {
    let numbers = &column.numbers;
    let varies = numbers
        .range
        .is_some_and(|[least, largest]| least < largest);
    match role {
        Role::Time => varies && numbers.increase(),
        Role::Measured(_) => varies && !numbers.dates,
    }
}

/// The unit that a mapping must say, and whether nothing says that it is this one.
fn unit(role: Role, kind: Kind, column: &FoundColumn, slides: bool) -> (Option<String>, bool) {
    let counts = |unit: &str| unit == COUNTS && kind == Kind::Drive;
    match (&column.unit, column.unit_as(role, kind)) {
        (_, Some(unit)) if counts(&unit) => (Some("counts, 4096/rev".to_owned()), true),
        // What the file says, or what is seen by the times themselves.
        (Some(own), Some(unit)) if *own == unit => (None, false),
        (_, Some(unit)) if kind == Kind::Process && role != Role::Time && unit == "1" => {
            (None, false)
        }
        (_, Some(unit)) => (Some(unit), false),
        (_, None) if kind == Kind::Process && role != Role::Time => (None, false),
        (_, None) => (Some(usual(role, &column.name, slides).to_owned()), true),
    }
}

/// A unit that a column of this name often has.
fn usual(role: Role, name: &str, slides: bool) -> &'static str {
    let name = name.to_lowercase();
    let has = |parts: &[&str]| parts.iter().any(|part| name.contains(part));
    match role {
        Role::Time | Role::Measured(Quantity::Output) => "s",
        INPUT if has(&["volt", "spannung"]) => "V",
        INPUT if has(&["current", "strom", "amp"]) => "A",
        INPUT if has(&["pwm", "duty", "command", "load", "power"]) => "%",
        INPUT if slides => "N",
        Role::Measured(Quantity::Input) => "N m",
        Role::Measured(Quantity::Velocity | Quantity::LoadVelocity) if slides => "m/s",
        Role::Measured(Quantity::Velocity | Quantity::LoadVelocity) => "rad/s",
        Role::Measured(Quantity::Position | Quantity::LoadPosition) if slides => "m",
        Role::Measured(Quantity::Position | Quantity::LoadPosition) => "rad",
    }
}
