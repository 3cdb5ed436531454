//! What the names and units of columns resemble: time, input, and what moves or comes out.

use super::found::FoundColumn;
use super::header::Role;
use super::unit::{is_bare_counts, parse};
use super::{Kind, Quantity};

/// What resembles a role: parts of names, and whole words that are too short to be looked for in others.
pub(super) struct Resembling {
    pub role: Role,
    parts: &'static [&'static str],
    words: &'static [&'static str],
}

/// In English and German; what is told most surely comes first.
pub(super) const RESEMBLING: [Resembling; 5] = [
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
            "entrada",
            "ssr",
        ],
        words: &[
            "u", "i", "iq", "m", "f", "tau", "q1", "q2", "u1", "uin", "ctrl", "cmd", "mv", "co",
            "op",
        ],
    },
    Resembling {
        role: Role::Measured(Quantity::Output),
        parts: &[
            "output", "ausgang", "temp", "press", "druck", "level", "stand", "flow", "fluss",
            "istwert", "pegel", "niveau", "regelgr", "humid", "feuchte", "concentr", "konzentr",
            "response", "antwort", "salida",
        ],
        words: &["y", "t1", "t2", "y1", "yout", "pv", "out"],
    },
];

/// Parts of names of what no drive has, whatever its unit.
const OF_PROCESS: [&str; 7] = ["temp", "press", "druck", "level", "pegel", "flow", "fluss"];

/// A part of the name of what comes out and is never put in, whatever else is in it, as in `current_temp`.
const TEMPERATURE: &str = "temp";

/// Parts of names of what acts, of which an output is the input of what is measured, as in `heater_output`.
const ACTORS: [&str; 12] = [
    "heat", "heiz", "valve", "ventil", "pump", "control", "burner", "brenner", "cooler", "ssr",
    "pwm", "duty",
];

/// Units of what no drive has.
const UNITS_OF_PROCESS: [&str; 18] = [
    "°c", "degc", "deg c", "celsius", "°f", "degf", "deg f", "k", "kelvin", "bar", "mbar", "pa",
    "kpa", "hpa", "psi", "l/min", "l/s", "m3/h",
];

/// How many of them are units of temperature.
const OF_TEMPERATURE: usize = 9;

/// Parts of names of what was wanted, and not measured, and whole words; and parts of what was missing of it.
const WANTED: [&str; 8] = [
    "setpoint",
    "set point",
    "set_point",
    "soll",
    "target",
    "desired",
    "reference",
    "wanted",
];
const WANTED_WORDS: [&str; 2] = ["sp", "ref"];
const MISSED: [&str; 2] = ["error", "fehler"];

/// Whether a column of this name may have a set point.
pub(super) fn is_set_point(name: &str) -> bool {
    let lower = name.to_lowercase();
    let called = WANTED.iter().any(|part| lower.contains(part));
    called || words(&lower).any(|word| WANTED_WORDS.contains(&word))
}

/// Whether a column of this name has what was wanted, or what was missing of it, and not what was measured.
pub(super) fn is_wanted(name: &str) -> bool {
    let lower = name.to_lowercase();
    is_set_point(name) || MISSED.iter().any(|part| lower.contains(part))
}

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

impl Resembling {
    /// How much a column looks like it; 0 for not at all.
    pub fn likeness(&self, column: &FoundColumn) -> u32 {
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
        let input = self.role == Role::Measured(Quantity::Input);
        let warm = is_warm(&column.name, column.unit.as_deref());
        let acts = has(&ACTORS) && !has(&OF_PROCESS);
        // What the file has in a unit of something else does not move.
        let strange = |unit: &str| parse(unit).is_none() && !is_bare_counts(unit);
        let moves_not = self.moves() && column.unit.as_deref().is_some_and(strange);
        if (input && warm) || (output && acts) || moves_not {
            return 0;
        }
        let other_time = self.role != Role::Time
            && column.numbers.increase()
            && RESEMBLING[0].resembles(&column.name);
        if other_time
            || (measured && is_wanted(&column.name))
            || (self.moves() && !named && has(&OF_PROCESS))
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
    pub fn resembles(&self, name: &str) -> bool {
        let lower = name.to_lowercase();
        let is_word = |word: &str| self.words.contains(&word.to_lowercase().as_str());
        self.parts.iter().any(|part| lower.contains(part)) || words(name).any(is_word)
    }

    /// Whether it is what moves.
    pub fn moves(&self) -> bool {
        matches!(
            self.role,
            Role::Measured(Quantity::Position | Quantity::Velocity)
        )
    }

    /// Whether a column may be it where nobody looks it over: its name says so, or its unit where that is enough.
    pub fn may_be(&self, column: &FoundColumn) -> bool {
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

/// Whether a column of this name and unit has a temperature.
pub(super) fn is_warm(name: &str, unit: Option<&str>) -> bool {
    name.to_lowercase().contains(TEMPERATURE) || unit.is_some_and(is_of_temperature)
}

/// Whether it is a unit of temperature.
fn is_of_temperature(unit: &str) -> bool {
    UNITS_OF_PROCESS[..OF_TEMPERATURE].contains(&unit.trim().to_lowercase().as_str())
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
