//! What a mapping says of the columns of a file: which of them it means, and what they are.

use super::Quantity;
use super::column::{Role, shorten};
use super::error::Problem;
use super::header::{Field, listed};
use super::mapping::Mapping;
use crate::message::Message;
use crate::msg;

/// What a mapping calls a column that has no name of its own, before its place from 1.
const PLACE: &str = "column ";

/// How a mapping calls each column: by its name where no other has it and a mapping can say it, else by its place.
pub(super) fn addresses(fields: &[Field]) -> Vec<String> {
    let address = |(i, field): (usize, &Field)| {
        let name = &field.name;
        let alone = fields.iter().filter(|f| f.name == *name).count() == 1;
        if alone && Mapping::can_say(name) {
            name.clone()
        } else {
            format!("{PLACE}{}", i + 1)
        }
    };
    fields.iter().enumerate().map(address).collect()
}

/// The column of this name or at this place.
fn addressed(fields: &[Field], source: &str) -> Option<usize> {
    let called = |name: fn(&Field) -> &String| fields.iter().position(|f| name(f) == source);
    let named = called(|f| &f.name).or_else(|| called(|f| &f.also));
    let place = || {
        source
            .strip_prefix(PLACE)?
            .parse::<usize>()
            .ok()?
            .checked_sub(1)
    };
    named.or_else(place).filter(|i| *i < fields.len())
}

/// Gives the columns that a mapping names their meaning; what it takes, no other column can be. Says what is used
/// besides by its name where the mapping names what was measured.
pub(super) fn map(fields: &mut [Field], mapping: &Mapping) -> Result<Vec<Message>, Problem> {
    for field in fields.iter_mut() {
        if mapping.entries.iter().any(|e| field.role == Some(e.role)) {
            field.role = None;
        }
    }
    for entry in &mapping.entries {
        let Some(source) = &entry.source else {
            continue;
        };
        let Some(i) = addressed(fields, source) else {
            return Err(Problem::NoSuchColumn {
                wanted: shorten(source),
                found: listed(addresses(fields).iter().map(String::as_str)),
            });
        };
        if let Some(field) = fields.get_mut(i) {
            if field.name.is_empty() {
                field.name.clone_from(source);
            }
            field.role = Some(entry.role);
            field.sign = if entry.negative { -1.0 } else { 1.0 };
            if entry.unit.is_some() {
                field.unit.clone_from(&entry.unit);
            }
        }
    }
    let output = |role: Role| {
        use Quantity::{Output, Position, Velocity};
        matches!(role, Role::Measured(Position | Velocity | Output))
    };
    let mut named = mapping.entries.iter().filter(|e| e.source.is_some());
    if !named.any(|entry| output(entry.role)) {
        return Ok(Vec::new());
    }
    let besides = fields.iter().filter_map(|field| {
        let role = field
            .role
            .filter(|role| output(*role) && !mapping.speaks_of(*role))?;
        Some(msg!(
            "The column '{}' is used as well, because of its name: {}=- in the mapping leaves it out.",
            Message::name(shorten(&field.name)),
            role.name()
        ))
    });
    Ok(besides.collect())
}
