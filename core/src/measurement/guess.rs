//! What the columns of a file most likely are: by their units, by what their names resemble, and by the order of their
//! values. A form that someone looks over gets the likeliest; where nobody is asked, only what can be no other is taken.

use super::clock::unit_from_1970;
use super::error::Problem;
use super::found::FoundColumn;
use super::header::{Field, Role, listed, shorten};
use super::mapping::ImportOptions;
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
        parts: &[
            "time", "zeit", "tiempo", "second", "sekunde", "elapsed", "uhr",
        ],
        words: &["t", "sec", "date", "datum", "millis", "micros", "clock"],
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
            "torque",
            "moment",
            "force",
            "kraft",
            "current",
            "strom",
            "volt",
            "spannung",
            "command",
            "stell",
            "input",
            "eingang",
            "power",
            "leistung",
            "pwm",
            "duty",
            "heater",
            "heiz",
            "valve",
            "ventil",
            "pump",
            "control",
            "manipulated",
            "actuat",
            "throttle",
            "drossel",
            "burner",
            "brenner",
            "cooler",
            "kühler",
            "kuehler",
            "ansteuer",
            "tastgrad",
        ],
        words: &[
            "u", "i", "iq", "m", "f", "tau", "q1", "q2", "u1", "uin", "ctrl", "cmd", "mv", "co",
        ],
    },
    Resembling {
        role: Role::Measured(Quantity::Output),
        parts: &[
            "output", "ausgang", "temp", "press", "druck", "level", "stand", "flow", "fluss",
            "istwert", "pegel", "niveau", "regelgr", "humid", "feuchte", "concentr", "konzentr",
            "response", "antwort",
        ],
        words: &["y", "t1", "t2", "y1", "yout", "pv", "out"],
    },
];

/// Parts of names of what no drive has, whatever its unit.
const OF_PROCESS: [&str; 7] = ["temp", "press", "druck", "level", "pegel", "flow", "fluss"];

/// Units of what no drive has.
const UNITS_OF_PROCESS: [&str; 18] = [
    "°c", "degc", "deg c", "celsius", "°f", "degf", "deg f", "k", "kelvin", "bar", "mbar", "pa",
    "kpa", "hpa", "psi", "l/min", "l/s", "m3/h",
];

/// Parts of names of what was wanted, and not measured.
const WANTED: [&str; 10] = [
    "setpoint",
    "set point",
    "set_point",
    "soll",
    "target",
    "desired",
    "reference",
    "wanted",
    "error",
    "fehler",
];

/// Names of a column that has the sampling period and not the times.
const PERIOD: [&str; 10] = [
    "ts",
    "dt",
    "delta_t",
    "deltat",
    "period",
    "sampling",
    "sample time",
    "sample period",
    "abtastzeit",
    "abtastintervall",
];

/// Whether a column of this name may have the sampling period.
pub(super) fn is_period(name: &str) -> bool {
    let name = name.to_lowercase().replace('_', " ");
    let sampled = [
        "sampling time",
        "sampling period",
        "sampling interval",
        "sample interval",
    ];
    PERIOD.contains(&name.trim())
        || sampled.iter().any(|part| name.contains(part))
        || name.trim() == "delta t"
}

/// How much a column looks like a role by its unit and by its name; both add up.
const DATES: u32 = 50;
const BY_UNIT: u32 = 20;
const BY_NAME: u32 = 10;

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
        // Dates are times, and nothing else.
        if column.numbers.dates {
            return if self.role == Role::Time { DATES } else { 0 };
        }
        let unit = column.unit.as_deref().filter(|u| parse(u).is_some());
        let output = self.role == Role::Measured(Quantity::Output);
        let fits = if output {
            column
                .unit
                .as_deref()
                .is_some_and(is_of_process)
                .then_some(true)
        } else {
            unit.map(|u| self.role.takes(Kind::Drive, u))
        };
        let name = column.name.to_lowercase();
        let has = |parts: &[&str]| parts.iter().any(|p| name.contains(p));
        let named = self.resembles(&column.name);
        let measured = output || self.moves();
        let other_time = self.role != Role::Time
            && column.numbers.increase()
            && RESEMBLING[0].resembles(&column.name);
        if other_time || (measured && has(&WANTED)) || (self.moves() && !named && has(&OF_PROCESS))
        {
            return 0;
        }
        // The output of a process may have any unit, which then says nothing.
        let other = output && unit.is_some() && !has(&OF_PROCESS);
        match fits {
            Some(false) => 0,
            _ if other => 0,
            fits => BY_UNIT * u32::from(fits.is_some()) + BY_NAME * u32::from(named),
        }
    }

    /// Whether a name resembles its names.
    fn resembles(&self, name: &str) -> bool {
        let lower = name.to_lowercase();
        let is_word = |word: &str| self.words.contains(&word.to_lowercase().as_str());
        self.parts.iter().any(|part| lower.contains(part)) || words(name).any(is_word)
    }

    /// Whether it is what moves.
    fn moves(&self) -> bool {
        matches!(
            self.role,
            Role::Measured(Quantity::Position | Quantity::Velocity)
        )
    }

    /// Whether a column may be it where nobody looks it over: its name says so, or its unit where that is enough.
    fn may_be(&self, column: &FoundColumn) -> bool {
        let by_unit = matches!(self.role, Role::Time | Role::Measured(Quantity::Output));
        match self.likeness(column) {
            0 => false,
            BY_UNIT => by_unit,
            _ => true,
        }
    }
}

/// Whether it is a unit of what no drive has.
pub(super) fn is_of_process(unit: &str) -> bool {
    UNITS_OF_PROCESS.contains(&unit.trim().to_lowercase().as_str())
}

/// What a measurement still needs of its columns: time, input, and what moves or comes out.
fn lacking(fields: &[Field], options: &ImportOptions) -> Vec<Role> {
    use Quantity::{Input, Output, Position, Velocity};
    let has = |role: Role| fields.iter().any(|f| f.role == Some(role));
    let [moves, output] = [&[Position, Velocity][..], &[Output]]
        .map(|all| all.iter().any(|q| has(Role::Measured(*q))));
    let outputs: &[Quantity] = match options.kind {
        Some(Kind::Drive) if !moves => &[Position, Velocity],
        Some(Kind::Process) if !output => &[Output],
        None if !moves && !output => &[Position, Velocity, Output],
        _ => &[],
    };
    let first = [Role::Time, Role::Measured(Input)];
    let first = first.into_iter().filter(|role| !has(*role));
    let outputs = outputs.iter().map(|q| Role::Measured(*q));
    // What the mapping speaks of is settled by it, and times by a period.
    let settled = |role: &Role| {
        options.mapping.speaks_of(*role) || (*role == Role::Time && options.period.is_some())
    };
    first.chain(outputs).filter(|role| !settled(role)).collect()
}

/// Gives what is lacking to the columns that can be nothing else, and says which; `look` finds the columns of the file.
pub(super) fn fill(
    fields: &mut [Field],
    options: &ImportOptions,
    look: impl FnOnce() -> Option<Vec<FoundColumn>>,
) -> Result<Vec<String>, Problem> {
    let lacking = lacking(fields, options);
    let Some(columns) = (!lacking.is_empty()).then(look).flatten() else {
        return Ok(Vec::new());
    };
    let free: Vec<usize> = (0..fields.len().min(columns.len()))
        .filter(|i| fields[*i].role.is_none())
        .collect();
    let candidates = |resembling: &Resembling| -> Vec<usize> {
        let free = free.iter().copied();
        free.filter(|i| resembling.may_be(&columns[*i])).collect()
    };
    let wanted = RESEMBLING.iter().filter(|r| lacking.contains(&r.role));
    let mut found: Vec<(&Resembling, Vec<usize>)> = wanted
        .map(|r| (r, candidates(r)))
        .filter(|(_, candidates)| !candidates.is_empty())
        .collect();
    let unclear = |of: &[&(&Resembling, Vec<usize>)]| {
        let mut all: Vec<usize> = of.iter().flat_map(|(_, c)| c.iter().copied()).collect();
        all.sort_unstable();
        all.dedup();
        let names = all.iter().map(|i| columns[*i].address.as_str());
        Problem::Unclear {
            wanted: match of {
                [(only, _)] => only.role.name(),
                _ => "x1' / 'y",
            },
            found: listed(names),
        }
    };
    // A drive or a process?
    let output = |f: &&(&Resembling, Vec<usize>)| f.0.role == Role::Measured(Quantity::Output);
    let outputs: Vec<_> = found.iter().filter(|f| output(f) || f.0.moves()).collect();
    if outputs.iter().any(output) && outputs.len() > 1 {
        return Err(unclear(&outputs));
    }
    let resolved =
        lacking.iter().all(|role| !is_output(*role)) || outputs.iter().any(|f| f.1.len() == 1);
    let left = lacking
        .contains(&INPUT)
        .then(|| only_left(&columns, &free, &found))
        .flatten()
        .filter(|_| resolved);
    if let Some(left) = left {
        found.retain(|f| f.0.role != INPUT);
        found.extend(
            RESEMBLING
                .iter()
                .filter(|r| r.role == INPUT)
                .map(|r| (r, vec![left])),
        );
    }
    for one in &found {
        // What nothing else is left for needs no likeness.
        if left.is_some() && one.0.role == INPUT {
            continue;
        }
        let something_else = |i: &usize| {
            let mut others = RESEMBLING.iter().filter(|r| r.role != one.0.role);
            others.any(|r| r.may_be(&columns[*i]))
        };
        if one.1.len() > 1 || one.1.iter().any(something_else) {
            return Err(unclear(&[one]));
        }
    }
    let mut notes = Vec::new();
    for (resembling, candidates) in &found {
        for i in candidates {
            let (field, role) = (&mut fields[*i], resembling.role);
            if role == Role::Time && field.unit.is_none() {
                field.unit = columns[*i].unit_as(role, Kind::Drive);
            }
            field.role = Some(role);
            let name = shorten(&field.name);
            notes.push(format!("The column '{name}' is taken for {}.", said(role)));
        }
    }
    Ok(notes)
}

const INPUT: Role = Role::Measured(Quantity::Input);

fn is_output(role: Role) -> bool {
    use Quantity::{Output, Position, Velocity};
    matches!(role, Role::Measured(Output | Position | Velocity))
}

/// The only column that can still be the input when time and outputs have theirs: one that goes up and down, and was not
/// only wanted.
fn only_left(
    columns: &[FoundColumn],
    free: &[usize],
    found: &[(&Resembling, Vec<usize>)],
) -> Option<usize> {
    let taken = |i: usize| {
        found
            .iter()
            .any(|(r, all)| r.role != INPUT && all.contains(&i))
    };
    let moves = |i: usize| {
        let (name, numbers) = (columns[i].name.to_lowercase(), &columns[i].numbers);
        let varies = numbers
            .range
            .is_some_and(|[least, largest]| least < largest);
        varies && !numbers.increase() && !numbers.dates && !WANTED.iter().any(|w| name.contains(w))
    };
    let mut left = free.iter().copied().filter(|i| !taken(*i) && moves(*i));
    left.next().filter(|_| left.next().is_none())
}

/// A role in a sentence.
fn said(role: Role) -> &'static str {
    match role {
        Role::Time => "the time",
        Role::Measured(Quantity::Input) => "the input",
        Role::Measured(Quantity::Position | Quantity::LoadPosition) => "the position",
        Role::Measured(Quantity::Velocity | Quantity::LoadVelocity) => "the velocity",
        Role::Measured(Quantity::Output) => "the output",
    }
}

/// Whether a name resembles those of this role.
pub(super) fn resembles(role: Role, name: &str) -> bool {
    RESEMBLING
        .iter()
        .any(|r| r.role == role && r.resembles(name))
}

/// The words of a name, such as `motor` and `pos` in `motor_pos`, or `u` and `Est` in `uEst`.
fn words(name: &str) -> impl DoubleEndedIterator<Item = &str> {
    let parts = name.split(|c: char| !c.is_alphanumeric() && c != '/');
    parts.filter(|w| !w.is_empty()).flat_map(|part| {
        // The first small letter before a capital one ends a word.
        let pairs = part.char_indices().zip(part.char_indices().skip(1));
        let ends = |((_, one), (_, next)): &((usize, char), (usize, char))| {
            one.is_lowercase() && next.is_uppercase()
        };
        let end = pairs.filter(ends).map(|(_, (at, _))| at).next();
        let (first, rest) = part.split_at(end.unwrap_or(part.len()));
        [first, rest].into_iter().filter(|w| !w.is_empty())
    })
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
