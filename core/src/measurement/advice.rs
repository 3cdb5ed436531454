//! Words for the command line with which a file is read that does not say what its columns are.

use std::fmt::Write as _;

use super::column::Role;
use super::error::{ImportError, Problem};
use super::found::FoundColumn;
use super::guess::guess;
use super::mapping::{ImportOptions, Mapping};
use super::period::Period;
use super::resembling::{is_wanted, resembles};
use super::unit::{COUNTS, is_bare_counts, parse};
use super::{Kind, Quantity};

const INPUT: Role = Role::Measured(Quantity::Input);
const POSITION: Role = Role::Measured(Quantity::Position);
const VELOCITY: Role = Role::Measured(Quantity::Velocity);
const OUTPUT: Role = Role::Measured(Quantity::Output);

/// Adds to an error about what the columns are the words with which the file is read, or its values at least: tried
/// out, so that they are no promise. `columns` finds what the file has, and `refused` says why it is not read in a way.
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
    let acts = columns.iter().any(|c| resembles(INPUT, &c.name));
    // A q alone may be an angle, a flow or a heat.
    let says = |c: &FoundColumn| acts || c.unit.is_some() || !c.name.eq_ignore_ascii_case("q");
    let called = |role| columns.iter().any(|c| resembles(role, &c.name) && says(c));
    let guessed = guess(&columns).channels;
    let mut moving = guessed
        .iter()
        .filter(|(r, _)| matches!(*r, POSITION | VELOCITY));
    let moves = moving.any(|(_, i)| says(&columns[*i])) || called(POSITION) || called(VELOCITY);
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
    /// What stands for it where the file does not say which column it is.
    open: Option<&'static str>,
}

/// A mapping, and whether a period is needed besides.
#[derive(Clone)]
struct Words {
    columns: Vec<Word>,
    map: String,
    /// The mapping as it is shown, with words for what the file does not say.
    shown: String,
    open: Open,
    periodic: bool,
    quoted: char,
}

/// Columns of which nothing says what they are.
#[derive(Clone, Default)]
struct Open {
    columns: Vec<String>,
    steps: Vec<String>,
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
        let mut settler = Settler::new(columns, kind, places);
        for role in needed {
            settler.settle(role)?;
        }
        let Settler {
            mut places, open, ..
        } = settler;
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
                open: open.iter().find(|(r, _)| *r == role).map(|(_, word)| *word),
            }
        });
        Self::write(words.collect(), columns, kind, periodic)
    }

    /// Writes the mapping; `None` where a shell would not leave it as it is.
    fn write(
        words: Vec<Word>,
        columns: &[FoundColumn],
        kind: Kind,
        periodic: bool,
    ) -> Option<Self> {
        let part = |word: &Word, source: &str| {
            let sign = if word.negative { "-" } else { "" };
            let mut part = format!("{}={sign}{source}", word.role.name());
            if let Some(unit) = &word.unit {
                // Writing into a string cannot fail.
                let _ = write!(part, " [{unit}]");
            }
            part
        };
        let address = |word: &Word| columns[word.column].address.as_str();
        let mut parts: Vec<String> = words.iter().map(|w| part(w, address(w))).collect();
        let shown = words.iter().map(|w| part(w, w.open.unwrap_or(address(w))));
        let mut shown: Vec<String> = shown.collect();
        // Nothing else is taken by its name.
        let unused = (0..columns.len()).filter(|i| words.iter().all(|w| w.column != *i));
        let others = unused.filter_map(|i| columns[i].known_as);
        for role in others.filter(|role| words.iter().all(|w| w.role != *role)) {
            let out = format!("{}=-", role.name());
            if !parts.contains(&out) && role != Role::Time {
                parts.push(out.clone());
                shown.push(out);
            }
        }
        let open = Open::of(&words, kind, columns);
        let (map, shown) = (parts.join(", "), shown.join(", "));
        let special = |c: char| matches!(c, '"' | '$' | '`' | '\\' | '!');
        let quoted = if map.contains(special) { '\'' } else { '"' };
        let fits = (!map.contains('\'') || quoted == '"') && !map.contains(char::is_control);
        fits.then_some(Self {
            columns: words,
            map,
            shown,
            open,
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
        let _ = write!(text, "--map {quoted}{}{quoted}", self.shown);
        let mut with = Vec::new();
        match (self.periodic, self.columns.iter().any(|word| word.assumed)) {
            (true, true) => with.push("the true period and units".to_owned()),
            (true, false) => with.push("the true period".to_owned()),
            (false, true) => with.push("the true units".to_owned()),
            (false, false) => {}
        }
        let open: Vec<&str> = self.columns.iter().filter_map(|word| word.open).collect();
        if let Some((first, others)) = open.split_first() {
            let number = if others.is_empty() { "one" } else { "two" };
            let words = others
                .iter()
                .fold((*first).to_owned(), |all, word| format!("{all} and {word}"));
            with.push(format!(
                "{number} of {} for {words}",
                several(&self.open.columns)
            ));
        }
        if !with.is_empty() {
            let _ = write!(text, " with {}", with.join(", and with "));
        }
        if !open.is_empty() && !self.open.steps.is_empty() {
            let goes = if self.open.steps.len() == 1 {
                "goes"
            } else {
                "go"
            };
            let _ = write!(
                text,
                " ({} {goes} in steps, as an input does, or what was wanted)",
                several(&self.open.steps)
            );
        }
        text
    }
}

/// Most columns that are listed.
const LISTED: usize = 8;

/// Columns in a sentence.
fn several(columns: &[String]) -> String {
    let shown: Vec<&str> = columns.iter().take(LISTED).map(String::as_str).collect();
    let more = if columns.len() > LISTED { " ..." } else { "" };
    shown.join(", ") + more
}

impl Open {
    /// What may stand for the words of a mapping that are open.
    fn of(words: &[Word], kind: Kind, columns: &[FoundColumn]) -> Self {
        let settled = |i: usize| words.iter().any(|w| w.open.is_none() && w.column == i);
        let Some(first) = words.iter().find(|w| w.open.is_some()) else {
            return Self::default();
        };
        let count = columns[first.column].numbers.count;
        let free =
            (0..columns.len()).filter(|i| !settled(*i) && columns[*i].numbers.count == count);
        let free: Vec<&FoundColumn> = free.map(|i| &columns[i]).collect();
        // What is the same throughout may be the input where nothing goes in steps.
        let steps = free.iter().any(|c| is_signal(c) && c.numbers.step());
        let open = words.iter().filter(|w| w.open.is_some());
        let roles: Vec<Role> = open.map(|w| w.role).collect();
        let may_be = |c: &&FoundColumn| {
            let fit = roles.iter().any(|role| fits(*role, kind, c));
            fit && (is_signal(c) || (!steps && is_held(c)))
        };
        let free: Vec<&FoundColumn> = free.into_iter().filter(may_be).collect();
        let addresses = |all: &[&FoundColumn]| all.iter().map(|c| c.address.clone()).collect();
        let stepping: Vec<&FoundColumn> =
            free.iter().copied().filter(|c| c.numbers.step()).collect();
        Self {
            columns: addresses(&free),
            steps: addresses(&stepping),
        }
    }
}

/// Gives roles to columns by what their names, units and values say, and leaves open what they do not.
struct Settler<'a> {
    columns: &'a [FoundColumn],
    kind: Kind,
    places: Vec<(Role, usize, bool)>,
    open: Vec<(Role, &'static str)>,
    /// Values in a column of the record, which a file of MATLAB has beside others.
    count: usize,
}

impl<'a> Settler<'a> {
    fn new(columns: &'a [FoundColumn], kind: Kind, places: Vec<(Role, usize, bool)>) -> Self {
        let counts = columns
            .iter()
            .filter(|c| is_signal(c))
            .map(|c| c.numbers.count);
        let how_many = |count: usize| counts.clone().filter(|other| *other == count).count();
        let usual = counts
            .clone()
            .max_by_key(|count| (how_many(*count), *count));
        let placed = places.first().map(|(_, i, _)| columns[*i].numbers.count);
        Self {
            columns,
            kind,
            count: placed.or(usual).unwrap_or_default(),
            places,
            open: Vec::new(),
        }
    }

    fn has(&self, role: Role) -> bool {
        self.places.iter().any(|(r, ..)| *r == role)
    }

    fn put(&mut self, role: Role, column: usize) {
        self.places.push((role, column, false));
    }

    /// Columns that are free and are as long as the others.
    fn free(&self) -> impl DoubleEndedIterator<Item = usize> {
        let columns = self.columns.iter().enumerate();
        let free = columns.filter(|(i, c)| {
            c.numbers.count == self.count && self.places.iter().all(|(_, taken, _)| taken != i)
        });
        free.map(|(i, _)| i)
    }

    /// The free ones that may be a signal by their values, and were not only wanted.
    fn signals(&self) -> Vec<usize> {
        self.free()
            .filter(|i| is_signal(&self.columns[*i]))
            .collect()
    }

    /// Those of them whose unit, where the file says one, this role may have.
    fn fitting(&self, role: Role) -> Vec<usize> {
        let mut signals = self.signals();
        signals.retain(|i| fits(role, self.kind, &self.columns[*i]));
        signals
    }

    fn named(&self, role: Role) -> Option<usize> {
        let mut signals = self.fitting(role).into_iter();
        signals.find(|i| resembles(role, &self.columns[*i].name))
    }

    /// What is called so and does not move in what was read: the name of an output says more than its values.
    fn named_though_still(&self, role: Role) -> Option<usize> {
        let still = |i: &usize| {
            let column = &self.columns[*i];
            let of_role = fits(role, self.kind, column) && resembles(role, &column.name);
            of_role && !column.numbers.vary() && !column.numbers.dates && !is_wanted(&column.name)
        };
        self.free().find(|i| role != INPUT && still(i))
    }

    /// Finds a column for a role; `None` where the file has none.
    fn settle(&mut self, role: Role) -> Option<()> {
        let moves = matches!(role, POSITION | VELOCITY);
        if self.has(role) || (moves && (self.has(POSITION) || self.has(VELOCITY))) {
            return Some(());
        }
        if role == Role::Time {
            self.settle_time();
            return Some(());
        }
        if let Some(named) = self.named(role) {
            self.put(role, named);
            return Some(());
        }
        // What moves has one column of two; the last that is asked for is the velocity.
        if role == POSITION && (self.named(VELOCITY).is_some() || speeds(self.columns)) {
            return Some(());
        }
        if let Some(still) = self.named_though_still(role) {
            self.put(role, still);
            return Some(());
        }
        let signals = self.fitting(role);
        let only = match (signals.as_slice(), role) {
            ([one], INPUT) if self.has_output() => Some(*one),
            ([one], _) if role != INPUT && self.has(INPUT) && self.is_settled(INPUT) => Some(*one),
            (two @ [_, _], INPUT) if !self.has_output() => self.the_one_that_steps(two),
            ([one], INPUT) if !self.has_output() => {
                self.held().filter(|_| !self.columns[*one].numbers.step())
            }
            _ => None,
        };
        if let Some(column) = only {
            self.put(role, column);
            return Some(());
        }
        let word = if role == INPUT { "INPUT" } else { "OUTPUT" };
        let stand_in = signals.first().copied()?;
        self.open.push((role, word));
        self.put(role, stand_in);
        Some(())
    }

    fn settle_time(&mut self) {
        let runs = |i: &usize| {
            let numbers = &self.columns[*i].numbers;
            numbers.increase() && numbers.vary() || numbers.increase_in_runs()
        };
        let named = |i: &usize| resembles(Role::Time, &self.columns[*i].name);
        let found = self.free().filter(runs).find(named);
        let found = found.or_else(|| {
            let increases = |i: &usize| self.columns[*i].numbers.increase();
            self.free().filter(runs).find(increases)
        });
        if let Some(time) = found.or_else(|| self.free().find(runs)) {
            self.put(Role::Time, time);
        }
    }

    fn has_output(&self) -> bool {
        [POSITION, VELOCITY, OUTPUT]
            .iter()
            .any(|role| self.has(*role))
    }

    fn is_settled(&self, role: Role) -> bool {
        self.open.iter().all(|(r, _)| *r != role)
    }

    /// The one of two columns that goes in steps, where the other does not.
    fn the_one_that_steps(&self, two: &[usize]) -> Option<usize> {
        let mut steps = two.iter().filter(|i| self.columns[**i].numbers.step());
        steps.next().copied().filter(|_| steps.next().is_none())
    }

    /// The only column that has one value other than 0 throughout: the input of a single step.
    fn held(&self) -> Option<usize> {
        let mut all = self.free().filter(|i| is_held(&self.columns[*i]));
        all.next().filter(|_| all.next().is_none())
    }
}

/// Whether a column may have this role by its unit, where the file says one.
fn fits(role: Role, kind: Kind, column: &FoundColumn) -> bool {
    let unit = column.unit.as_deref();
    unit.is_none_or(|unit| is_bare_counts(unit) || role.takes(kind, unit))
}

/// Whether a column has one value other than 0 throughout.
fn is_held(column: &FoundColumn) -> bool {
    matches!(column.numbers.range, Some([least, largest]) if least == largest && least != 0.0)
}

/// Whether a column may be a signal by its values, and was not only wanted.
fn is_signal(column: &FoundColumn) -> bool {
    let time = column.numbers.increase() && resembles(Role::Time, &column.name);
    column.numbers.vary() && !column.numbers.dates && !is_wanted(&column.name) && !time
}

/// Whether a column is called as velocities are.
fn speeds(columns: &[FoundColumn]) -> bool {
    columns.iter().any(|c| resembles(VELOCITY, &c.name))
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
