//! What a header leaves open, given to the columns that can be nothing else.

use super::error::Problem;
use super::found::FoundColumn;
use super::header::{Field, Role, listed, shorten};
use super::mapping::ImportOptions;
use super::resembling::{RESEMBLING, Resembling, is_wanted};
use super::{Kind, Quantity};
use crate::message::Message;
use crate::msg;

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
) -> Result<Vec<Message>, Problem> {
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
    let mut found: Vec<Candidates> = wanted
        .map(|r| (r, candidates(r)))
        .filter(|(_, candidates)| !candidates.is_empty())
        .collect();
    // A drive or a process?
    let output = |f: &&Candidates| f.0.role == Role::Measured(Quantity::Output);
    let outputs: Vec<_> = found.iter().filter(|f| output(f) || f.0.moves()).collect();
    if outputs.iter().any(output) && outputs.len() > 1 {
        return Err(unclear(&outputs, &columns));
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
            return Err(unclear(&[one], &columns));
        }
    }
    Ok(give(fields, &columns, &found))
}

/// What columns resemble, and which.
type Candidates = (&'static Resembling, Vec<usize>);

/// That more columns than one can be it.
fn unclear(of: &[&Candidates], columns: &[FoundColumn]) -> Problem {
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
}

/// Gives columns their roles, and says which.
fn give(fields: &mut [Field], columns: &[FoundColumn], found: &[Candidates]) -> Vec<Message> {
    let mut notes = Vec::new();
    for (resembling, candidates) in found {
        for i in candidates {
            let (field, role) = (&mut fields[*i], resembling.role);
            if role == Role::Time && field.unit.is_none() {
                field.unit = columns[*i].unit_as(role, Kind::Drive);
            }
            field.role = Some(role);
            let name = shorten(&field.name);
            notes.push(taken(Message::name(name), role));
        }
    }
    notes
}

const INPUT: Role = Role::Measured(Quantity::Input);

fn is_output(role: Role) -> bool {
    use Quantity::{Output, Position, Velocity};
    matches!(role, Role::Measured(Output | Position | Velocity))
}

/// The only column that can still be the input when time and outputs have theirs: one that goes up and down, and was
/// not only wanted.
fn only_left(columns: &[FoundColumn], free: &[usize], found: &[Candidates]) -> Option<usize> {
    let taken = |i: usize| {
        found
            .iter()
            .any(|(r, all)| r.role != INPUT && all.contains(&i))
    };
    let moves = |i: usize| {
        let numbers = &columns[i].numbers;
        let varies = numbers
            .range
            .is_some_and(|[least, largest]| least < largest);
        varies && !numbers.increase() && !numbers.dates && !is_wanted(&columns[i].name)
    };
    let mut left = free.iter().copied().filter(|i| !taken(*i) && moves(*i));
    left.next().filter(|_| left.next().is_none())
}

/// That a column has a role.
fn taken(column: Message, role: Role) -> Message {
    match role {
        Role::Time => msg!("The column '{}' is taken as the time.", column),
        Role::Measured(Quantity::Input) => {
            msg!("The column '{}' is taken as the input.", column)
        }
        Role::Measured(Quantity::Position | Quantity::LoadPosition) => {
            msg!("The column '{}' is taken as the position.", column)
        }
        Role::Measured(Quantity::Velocity | Quantity::LoadVelocity) => {
            msg!("The column '{}' is taken as the velocity.", column)
        }
        Role::Measured(Quantity::Output) => {
            msg!("The column '{}' is taken as the output.", column)
        }
    }
}
