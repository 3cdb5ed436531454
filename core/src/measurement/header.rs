//! The header: which column is what, in which unit.

pub(super) use super::column::{Role, begin_of, role, shorten};
use super::error::Problem;
use super::mapping::ImportOptions;
use super::period::Period;
use super::unit::{self, Measures};
use super::{Kind, Quantity};
use crate::message::Message;
use crate::msg;

/// A column before it is understood.
#[derive(Clone, Debug)]
pub(super) struct Field {
    pub name: String,
    pub unit: Option<String>,
    pub role: Option<Role>,
    /// Another name that stands in the file; empty where it has none.
    pub also: String,
    /// -1 where its direction is the other one, else 1.
    pub sign: f64,
}

impl Field {
    /// A column that is known by its name. What cannot be shown of it is left out.
    pub fn named(name: String, unit: Option<String>) -> Self {
        let shown = |text: String| -> String { text.chars().filter(|c| !c.is_control()).collect() };
        let name = shown(name);
        let role = role(&name);
        Self {
            name,
            unit: unit.map(shown).filter(|u| !u.is_empty()),
            role,
            also: String::new(),
            sign: 1.0,
        }
    }
}

/// A column that is read.
#[derive(Clone, Debug)]
pub(super) struct Column {
    /// Place in a row, from 0.
    pub index: usize,
    pub role: Role,
    pub name: String,
    /// Factor to SI.
    pub factor: f64,
    pub measures: Measures,
    /// SI unit, or for a process the unit as written.
    pub unit: String,
}

impl Role {
    /// Whether a column in this role may have this unit.
    pub fn takes(self, kind: Kind, unit: &str) -> bool {
        convert(self, kind, "", unit).is_ok()
    }
}

/// The header, understood.
pub(super) struct Header {
    pub kind: Kind,
    pub columns: Vec<Column>,
    pub ignored: Vec<String>,
    /// What had to be assumed, for the user.
    pub notes: Vec<Message>,
    pub width: usize,
    /// The time from sample to sample, where no column has the times.
    pub period: Option<Period>,
    /// Whether the time has no unit and is taken as seconds.
    pub assumes_seconds: bool,
}

impl Header {
    /// What is wrong with taking these times as seconds: a clock that counts in large steps may count anything.
    pub fn doubt_seconds(&self, values: &[Vec<f64>]) -> Result<(), (Option<String>, Problem)> {
        let times = self.columns.iter().zip(values);
        let Some((column, [first, .., last])) = times
            .filter(|_| self.assumes_seconds)
            .find(|(column, _)| column.role == Role::Time)
            .map(|(column, times)| (column, times.as_slice()))
        else {
            return Ok(());
        };
        let steps = values.first().map_or(0, Vec::len).saturating_sub(1);
        if (last - first) / (steps as f64) < LONGEST_ASSUMED {
            return Ok(());
        }
        let here = format!("{} ({})", column.index + 1, column.name);
        let (name, example) = (column.name.clone(), example(Role::Time));
        Err((Some(here), Problem::NoUnit { name, example }))
    }
}

/// The step from which times without a unit are not taken as seconds: milliseconds are more likely then.
const LONGEST_ASSUMED: f64 = 10.0;

/// A problem and the column (from 1, with its name) that it concerns.
pub(super) type Located = (Option<(usize, String)>, Problem);

/// Names in one line of a sentence, as many as fit.
pub(super) fn listed<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    let names: Vec<&str> = names.into_iter().collect();
    names
        .join(", ")
        .chars()
        .filter(|c| !c.is_control())
        .take(200)
        .collect()
}

/// The place of what stands in brackets in a name, without them.
fn bracketed(field: &str) -> Option<(usize, usize)> {
    let marks = [('[', ']'), ('(', ')')].into_iter();
    let mut found =
        marks.filter_map(|(open, close)| Some((field.find(open)?, field.rfind(close)?)));
    found
        .find(|(start, end)| start < end)
        .map(|(start, end)| (start + 1, end))
}

/// Whether a name has a number in parentheses, as in `pos (5)`, and no plain number: that is `(1)`.
pub(super) fn has_number(field: &str) -> bool {
    let number =
        bracketed(field).and_then(|(start, end)| field[start..end].trim().parse::<u32>().ok());
    number.is_some_and(|number| number != 1)
}

/// Splits `x1 [rad]` into name and unit; parentheses serve as well. Where columns are `numbered`, a number in brackets
/// belongs to the name.
pub(super) fn name_and_unit(field: &str, numbered: bool) -> (String, Option<String>) {
    let unit = bracketed(field).map(|(start, end)| (&field[..start - 1], field[start..end].trim()));
    let unit = unit.filter(|(_, unit)| !numbered || unit.parse::<u32>().is_err());
    match unit {
        Some((name, unit)) => (name.trim().to_owned(), Some(unit.to_owned())),
        None => (field.trim().to_owned(), None),
    }
}

/// Understands the fields of a header.
pub(super) fn understand(fields: Vec<Field>, options: &ImportOptions) -> Result<Header, Located> {
    let width = fields.len();
    let roles: Vec<Option<Role>> = fields.iter().map(|f| f.role).collect();
    if roles.iter().all(Option::is_none) {
        let names: Vec<&str> = fields.iter().map(|f| f.name.as_str()).collect();
        let found = begin_of(&names.join(","));
        return Err((None, Problem::NoHeader { found }));
    }
    let kind = options.kind.unwrap_or_else(|| kind_of(&roles));
    present(&roles, kind, options.period.is_some())?;
    let mut columns: Vec<Column> = Vec::new();
    let mut ignored = Vec::new();
    let mut assumed = Assumed::default();
    for (index, field) in fields.into_iter().enumerate() {
        // A period that is given counts, whatever times there are.
        let counts = |r: &Role| belongs(*r, kind) && (*r != Role::Time || options.period.is_none());
        let Some(role) = field.role.filter(counts) else {
            if options.mapping.is_empty() {
                ignored.push(shorten(&field.name));
            }
            continue;
        };
        let name = field.name.clone();
        let here = Some((index + 1, name.clone()));
        if columns.iter().any(|c| c.role == role) {
            return Err((here, Problem::Twice { name }));
        }
        let column = column(index, field, role, kind, &mut assumed);
        columns.push(column.map_err(|p| (here, or_process(p, role, options)))?);
    }
    let mut header = Header {
        kind,
        columns,
        ignored,
        notes: assumed.notes(),
        width,
        period: options.period,
        assumes_seconds: assumed.clock.is_some(),
    };
    make_torque(&mut header, options)?;
    agree(&header)?;
    Ok(header)
}

/// What is measured where nobody says it: a drive, unless there is the output of a process and no motion.
fn kind_of(roles: &[Option<Role>]) -> Kind {
    let has = |q: Quantity| roles.contains(&Some(Role::Measured(q)));
    if has(Quantity::Output) && !has(Quantity::Position) && !has(Quantity::Velocity) {
        Kind::Process
    } else {
        Kind::Drive
    }
}

/// A field that is read in this role, in its own unit or in one that is assumed.
fn column(
    index: usize,
    field: Field,
    role: Role,
    kind: Kind,
    assumed: &mut Assumed,
) -> Result<Column, Problem> {
    let Field {
        name, unit, sign, ..
    } = field;
    let Some(unit) = unit.or_else(|| assumed.unit(&name, role, kind)) else {
        let example = example(role);
        return Err(Problem::NoUnit { name, example });
    };
    let (measures, factor, unit) = convert(role, kind, &name, &unit)?;
    Ok(Column {
        index,
        role,
        name,
        factor: factor * sign,
        measures,
        unit,
    })
}

/// The columns of a process whose unit is not given, by their names.
#[derive(Default)]
struct Assumed {
    /// The time, taken as seconds.
    clock: Option<String>,
    /// What is taken as plain numbers.
    plain: Vec<String>,
}

impl Assumed {
    /// The unit that a column without one is taken to have, if any may be.
    fn unit(&mut self, name: &str, role: Role, kind: Kind) -> Option<String> {
        if kind != Kind::Process {
            return None;
        }
        let unit = if role != Role::Time {
            self.plain.push(shorten(name));
            "1"
        } else if is_time(name) {
            self.clock = Some(shorten(name));
            "s"
        } else {
            return None;
        };
        Some(unit.to_owned())
    }

    /// What was assumed, for the user.
    fn notes(&self) -> Vec<Message> {
        let clock = self.clock.as_ref();
        let clock = clock.map(|clock| {
            msg!(
                "No unit is given for {}: taken as seconds.",
                Message::name(clock)
            )
        });
        let plain = (!self.plain.is_empty()).then(|| {
            let plain = self.plain.join(", ");
            msg!(
                "No unit is given for {}: taken as plain numbers.",
                Message::name(plain)
            )
        });
        clock.into_iter().chain(plain).collect()
    }
}

/// Whether a column of this name can be nothing but the time.
fn is_time(name: &str) -> bool {
    role(name) == Some(Role::Time)
}

/// Says of a unit that no drive has that a process may, where it was not said which of the two it is.
fn or_process(problem: Problem, role: Role, options: &ImportOptions) -> Problem {
    match problem {
        Problem::WrongUnit { unit, expected }
            if options.kind.is_none()
                && role != Role::Time
                && unit::parse_input(&unit).is_none() =>
        {
            let expected = msg!("{}; the output of a process is y, in any unit", *expected);
            let expected = Box::new(expected);
            Problem::WrongUnit { unit, expected }
        }
        other => other,
    }
}

/// A unit that a column in this role may have.
fn example(role: Role) -> &'static str {
    match role {
        Role::Time => "s",
        Role::Measured(Quantity::Input) => "N m",
        Role::Measured(Quantity::Position | Quantity::LoadPosition) => "rad",
        Role::Measured(Quantity::Velocity | Quantity::LoadVelocity) => "rad/s",
        Role::Measured(Quantity::Output) => "1",
    }
}

fn belongs(role: Role, kind: Kind) -> bool {
    match role {
        Role::Time | Role::Measured(Quantity::Input) => true,
        Role::Measured(Quantity::Output) => kind == Kind::Process,
        Role::Measured(_) => kind == Kind::Drive,
    }
}

fn convert(
    role: Role,
    kind: Kind,
    name: &str,
    unit: &str,
) -> Result<(Measures, f64, String), Problem> {
    use Measures::{Angle, AngularVelocity, Force, Length, Speed, Time, Torque};
    let expected: (&[Measures], &'static str) = match (role, kind) {
        (Role::Time, _) => (&[Time], "a time: s, ms, us, ns, min, h"),
        (_, Kind::Process) => return Ok((Measures::Other, 1.0, unit.to_owned())),
        (Role::Measured(Quantity::Input), _) => (
            &[Torque, Force],
            "a torque or force: N m, mN m, N, kN, the current or voltage of the motor: A, V, or a command: %, PWM, \
             counts, 1",
        ),
        (Role::Measured(Quantity::Position | Quantity::LoadPosition), _) => (
            &[Angle, Length],
            "an angle or length: rad, deg, rev, m, mm, or counts with a resolution",
        ),
        (Role::Measured(_), _) => (
            &[AngularVelocity, Speed],
            "a velocity: rad/s, deg/s, rpm, m/s, mm/s",
        ),
    };
    let position = matches!(
        role,
        Role::Measured(Quantity::Position | Quantity::LoadPosition)
    );
    if position && unit::is_bare_counts(unit) {
        return Err(Problem::BareCounts {
            name: name.to_owned(),
        });
    }
    let input = role == Role::Measured(Quantity::Input);
    let parsed = if input {
        unit::parse_input(unit)
    } else {
        unit::parse(unit)
    };
    let fits = |m: Measures| expected.0.contains(&m) || (input && m.needs_torque_constant());
    match parsed {
        Some((measures, factor)) if fits(measures) => {
            Ok((measures, factor, measures.si().to_owned()))
        }
        _ => Err(Problem::WrongUnit {
            unit: shorten(unit),
            expected: Box::new(expected.1.into()),
        }),
    }
}

/// Turns a current, voltage or command into torque or force: by the constant that is given, or by one.
fn make_torque(header: &mut Header, options: &ImportOptions) -> Result<(), Located> {
    use Measures::{Command, Force, Length, Speed, Torque, Voltage};
    let turns = !header
        .columns
        .iter()
        .any(|c| matches!(c.measures, Length | Speed));
    let input = Role::Measured(Quantity::Input);
    let Some(column) = header.columns.iter_mut().find(|c| c.role == input) else {
        return Ok(());
    };
    let before = column.measures;
    let turned = before.needs_torque_constant();
    let wrong = |given: Measures| {
        let problem = Problem::NeedlessTorqueConstant {
            unit: column.unit.clone(),
            given: given.si(),
        };
        Err((Some((column.index + 1, column.name.clone())), problem))
    };
    let (factor, gives) = match options.torque_constant {
        Some(constant) if !turned || constant.per != before => return wrong(constant.per),
        Some(constant) => (constant.value(), constant.gives),
        None if !turned => return Ok(()),
        None => (1.0, if turns { Torque } else { Force }),
    };
    column.factor *= factor;
    column.measures = gives;
    gives.si().clone_into(&mut column.unit);
    if options.torque_constant.is_none() {
        header.notes.push(msg!(
            "The torque constant is not known: 1 {}/{} is assumed. Inertias, frictions and loads below are therefore \
             multiples of it: multiply them by the true one. Times, gaps and which effects are found do not depend on \
             it.",
            gives.si(),
            before.si()
        ));
    }
    let note = match before {
        Voltage => {
            "The input is a voltage: the back-EMF acts as viscous friction and is part of it here."
        }
        Command(_) => {
            "The input is a command: where it sets the voltage of the motor, the back-EMF acts as viscous \
             friction and is part of it here."
        }
        _ => return Ok(()),
    };
    header.notes.push(note.into());
    Ok(())
}

/// Checks that what a measurement needs is there.
fn present(roles: &[Option<Role>], kind: Kind, timed: bool) -> Result<(), Located> {
    let has = |role: Role| roles.contains(&Some(role));
    let measured = |q: Quantity| has(Role::Measured(q));
    let missing = |wanted, hint| Err((None, Problem::NoColumn { wanted, hint }));
    if !has(Role::Time) && !timed {
        return missing(
            "t",
            "add the time, such as t [s], or give the sampling period",
        );
    }
    if !measured(Quantity::Input) {
        return missing(
            "u",
            "add the input, such as u [N m], u [N] or for a process u [1]",
        );
    }
    match kind {
        Kind::Drive if !measured(Quantity::Position) && !measured(Quantity::Velocity) => missing(
            "x1",
            "a drive needs its position x1 [rad] or its velocity v1 [rad/s], or both; a process needs y [1]",
        ),
        Kind::Process if !measured(Quantity::Output) => {
            missing("y", "a process needs its output, such as y [1]")
        }
        _ => Ok(()),
    }
}

/// Checks that the units belong together.
fn agree(header: &Header) -> Result<(), Located> {
    let rotational = |m: Measures| match m {
        Measures::Torque | Measures::Angle | Measures::AngularVelocity => Some(true),
        Measures::Force | Measures::Length | Measures::Speed => Some(false),
        _ => None,
    };
    let mut first: Option<&Column> = None;
    for column in header
        .columns
        .iter()
        .filter(|c| rotational(c.measures).is_some())
    {
        match first {
            Some(one) if rotational(one.measures) != rotational(column.measures) => {
                let problem = Problem::Mixed {
                    one: one.unit.clone(),
                    other: column.unit.clone(),
                };
                return Err((Some((column.index + 1, column.name.clone())), problem));
            }
            Some(_) => {}
            None => first = Some(column),
        }
    }
    Ok(())
}
