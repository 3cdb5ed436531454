//! What the columns of a file look like, before it is known what they are.

use serde::{Deserialize, Serialize};

use super::header::{Field, Role, addresses};

/// First values that are kept of a column.
const FIRST: usize = 3;

/// A column of a file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FoundColumn {
    /// Its name in the file; empty where it has none.
    pub name: String,
    /// How a [`Mapping`](super::Mapping) calls it: by its name, or by its place as `column 3`.
    pub address: String,
    /// Its unit, where the file says one.
    pub unit: Option<String>,
    /// What it is by its name alone, if it is not mapped.
    pub known_as: Option<Role>,
    /// Its numbers, as they stand in the file.
    pub numbers: Numbers,
}

/// The numbers of a column.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Numbers {
    /// How many there are.
    pub count: usize,
    /// The first of them.
    pub first: Vec<f64>,
    /// The least and the largest of those that are finite.
    pub range: Option<[f64; 2]>,
    /// Whether they were dates or times of day, which count in s from the first.
    pub dates: bool,
    /// Whether one of them is not larger than the one before.
    turns: bool,
    last: Option<f64>,
}

impl Numbers {
    /// Whether each is larger than the one before, as times are.
    pub fn increase(&self) -> bool {
        !self.turns
    }

    pub(super) fn take(&mut self, value: f64) {
        self.count += 1;
        if self.first.len() < FIRST {
            self.first.push(value);
        }
        if value.is_finite() {
            let [least, largest] = self.range.unwrap_or([value; 2]);
            self.range = Some([least.min(value), largest.max(value)]);
        }
        self.turns |= !self.last.is_none_or(|last| value > last);
        self.last = Some(value);
    }
}

/// Columns with their addresses.
pub(super) fn addressed(seen: Vec<(Field, Numbers)>) -> Vec<FoundColumn> {
    let (fields, numbers): (Vec<Field>, Vec<Numbers>) = seen.into_iter().unzip();
    let addresses = addresses(&fields);
    let found = fields.into_iter().zip(addresses).zip(numbers);
    found
        .map(|((field, address), numbers)| FoundColumn {
            name: field.name,
            address,
            unit: field.unit,
            known_as: field.role,
            numbers,
        })
        .collect()
}
