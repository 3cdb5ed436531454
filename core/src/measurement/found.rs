//! What the columns of a file look like, before it is known what they are.

use serde::{Deserialize, Serialize};

use super::header::{Field, Role};
use super::mapped::addresses;

/// First values that are kept of a column, and stretches of which its course is kept, at most: an even number.
const FIRST: usize = 3;
const STRETCHES: usize = 64;

/// Samples for which a value stays at least, on the average, in a column that goes in steps.
const HELD: usize = 10;

/// Samples of a run at least, on the average, and the share of the whole way within which another begins.
const RUN: usize = 20;
const NEAR_BEGIN: f64 = 0.1;

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
    /// How they go: the least and the largest of stretches of equal length one after another, of which the last may be
    /// shorter; nothing where none of a stretch is finite.
    pub course: Vec<Option<[f64; 2]>>,
    /// How often the length of a stretch was doubled.
    doubled: u32,
    /// How often one is not larger than the one before, and how often it is another.
    falls: usize,
    changes: usize,
    /// The largest of those that are less than the one before.
    landed: Option<f64>,
    last: Option<f64>,
}

impl Numbers {
    /// Whether each is larger than the one before, as times are.
    pub fn increase(&self) -> bool {
        self.falls == 0
    }

    /// Whether they increase but for a few times at which they are back where they began, as the times of runs that
    /// follow one another are, or stand still.
    pub fn increase_in_runs(&self) -> bool {
        let Some([least, largest]) = self.range.filter(|_| self.falls > 0) else {
            return false;
        };
        let back = |landed: f64| landed - least <= NEAR_BEGIN * (largest - least);
        self.falls * RUN <= self.count && self.landed.is_none_or(back) && self.changes > 0
    }

    /// Whether they differ.
    pub fn vary(&self) -> bool {
        self.range.is_some_and(|[least, largest]| least < largest)
    }

    /// Whether they differ, and each stays for some samples as a rule, as an input does that goes in steps.
    pub fn step(&self) -> bool {
        self.vary() && self.changes * HELD <= self.count
    }

    pub(super) fn take(&mut self, value: f64) {
        self.follow(value);
        self.count += 1;
        if self.first.len() < FIRST {
            self.first.push(value);
        }
        if value.is_finite() {
            let [least, largest] = self.range.unwrap_or([value; 2]);
            self.range = Some([least.min(value), largest.max(value)]);
        }
        if let Some(last) = self.last {
            self.falls += usize::from(value.is_nan() || value <= last);
            self.changes += usize::from(value != last);
            if value < last {
                self.landed = Some(self.landed.map_or(value, |landed| landed.max(value)));
            }
        }
        self.last = Some(value);
    }

    /// Takes the next value into the course; where it is full, two stretches become one.
    fn follow(&mut self, value: f64) {
        if self.count.is_multiple_of(1 << self.doubled) {
            if self.course.len() == STRETCHES {
                let pairs = self.course.chunks(2);
                self.course = pairs
                    .map(|pair| both(pair[0], pair[pair.len() - 1]))
                    .collect();
                self.doubled += 1;
            }
            self.course.push(None);
        }
        let one = value.is_finite().then_some([value; 2]);
        if let Some(last) = self.course.last_mut() {
            *last = both(*last, one);
        }
    }
}

/// The least and the largest of two stretches.
fn both(one: Option<[f64; 2]>, other: Option<[f64; 2]>) -> Option<[f64; 2]> {
    match (one, other) {
        (Some([a, b]), Some([c, d])) => Some([a.min(c), b.max(d)]),
        (one, other) => one.or(other),
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

#[cfg(test)]
mod tests {
    use super::*;

    fn course(values: impl IntoIterator<Item = f64>) -> Vec<Option<[f64; 2]>> {
        let mut numbers = Numbers::default();
        values.into_iter().for_each(|v| numbers.take(v));
        numbers.course
    }

    #[test]
    fn steps_and_times_that_begin_anew_are_seen() {
        let seen = |value: fn(usize) -> f64| {
            let mut numbers = Numbers::default();
            (0..400).for_each(|k| numbers.take(value(k)));
            [
                numbers.increase(),
                numbers.increase_in_runs(),
                numbers.step(),
            ]
        };
        assert_eq!(seen(|k| 0.1 * k as f64), [true, false, false]);
        assert_eq!(seen(|k| (k % 50) as f64), [false, true, false]);
        assert_eq!(seen(|k| k.saturating_sub(2) as f64), [false, true, false]);
        assert_eq!(seen(|k| (k / 50) as f64), [false, false, true]);
        assert_eq!(seen(|k| (k / 50 % 2) as f64), [false, false, true]);
        assert_eq!(seen(|k| libm::sin(k as f64)), [false, false, false]);
        assert_eq!(seen(|_| 3.0), [false, false, false]);
    }

    #[test]
    fn the_course_keeps_what_is_least_and_largest_however_long_a_column_is() {
        assert_eq!(course([]), []);
        assert_eq!(course([2.0, f64::NAN]), [Some([2.0; 2]), None]);
        for count in [64_usize, 65, 1000, 12_345] {
            let course = course((0..count).map(|k| if k == 40 { -1.0 } else { k as f64 }));
            assert!(
                (STRETCHES / 2..=STRETCHES).contains(&course.len()),
                "{count}"
            );
            let all = course.iter().copied().fold(None, both);
            assert_eq!(all, Some([-1.0, (count - 1) as f64]), "{count}");
            // One after another, without a gap.
            let highs = course.iter().flatten().map(|[_, high]| *high);
            let begins = highs.filter(|high| *high >= 0.0);
            assert!(
                begins.clone().zip(begins.skip(1)).all(|(a, b)| a < b),
                "{count}"
            );
        }
    }
}
