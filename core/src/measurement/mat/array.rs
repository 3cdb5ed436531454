//! The arrays of a file and what is in them: numbers, fields of structures, properties of objects.

use super::element::{Element, MATRIX, Reader, damaged};
use super::objects::{Subsystem, referred};
use crate::measurement::error::Problem;
use crate::measurement::series::Series;

/// Most properties of objects that are read; a timeseries has some forty.
const MOST_PROPERTIES: usize = 20_000;

/// Deepest nesting of structures; logs have three or four levels.
pub const DEEPEST: usize = 16;

// Classes of arrays.
const CELL: u32 = 1;
const STRUCT: u32 = 2;
/// An object as MATLAB kept them at first: a structure with the name of its class.
const OBJECT: u32 = 3;
const WORDS: u32 = 13;
const OPAQUE: u32 = 17;
const NUMERIC: std::ops::RangeInclusive<u32> = 6..=15;
/// Flag of an array with an imaginary part.
const COMPLEX: u32 = 0x0800;

/// What was found in a file.
pub struct Found<'a> {
    pub series: Vec<Series>,
    subsystem: Subsystem<'a>,
    /// How many properties of objects may still be read: some may refer to each other.
    left: usize,
}

impl<'a> Found<'a> {
    /// Nothing as yet.
    pub fn nothing(subsystem: Subsystem<'a>) -> Self {
        Self {
            series: Vec::new(),
            subsystem,
            left: MOST_PROPERTIES,
        }
    }

    /// Reads the content of an array: flags, size, name, and by its class numbers, fields or objects.
    pub fn read(&mut self, mut array: Reader<'_>, path: &str, depth: usize) -> Result<(), Problem> {
        if array.bytes.is_empty() || depth > DEEPEST {
            return Ok(());
        }
        let flags = array.element()?.inside().word("the flags of an array")?;
        let class = flags & 0xff;
        if class == OPAQUE {
            return self.object(array, path, depth);
        }
        if ![CELL, STRUCT, OBJECT].contains(&class) && !NUMERIC.contains(&class) {
            return Ok(());
        }
        let sizes = array
            .element()?
            .numbers()
            .ok_or_else(|| damaged(array.at, "the size of an array"))?;
        let sizes: Vec<usize> = sizes.iter().map(|n| *n as usize).collect();
        let name = array.element()?.data;
        let name = if path.is_empty() {
            text(name)
        } else {
            path.to_owned()
        };
        if class == CELL {
            return self.cells(array, &name, &sizes, depth);
        }
        if class == OBJECT {
            array.skip(1)?;
        }
        if !NUMERIC.contains(&class) {
            return self.fields(array, &name, &sizes, depth);
        }
        if flags & COMPLEX == 0 {
            let values = array
                .element()?
                .numbers()
                .ok_or_else(|| damaged(array.at, "the numbers of an array"))?;
            columns(&name, &sizes, values, &mut self.series);
        }
        Ok(())
    }

    /// What is in each cell.
    fn cells(
        &mut self,
        mut array: Reader<'_>,
        name: &str,
        sizes: &[usize],
        depth: usize,
    ) -> Result<(), Problem> {
        elements(name, sizes).try_for_each(|path| self.member(&mut array, &path, depth))
    }

    /// The next member of an array of arrays.
    fn member(&mut self, array: &mut Reader<'_>, path: &str, depth: usize) -> Result<(), Problem> {
        let element = array.element()?;
        if element.kind == MATRIX {
            self.read(element.inside(), path, depth + 1)?;
        }
        Ok(())
    }

    /// The fields of each element of an array of structures.
    fn fields(
        &mut self,
        mut array: Reader<'_>,
        name: &str,
        sizes: &[usize],
        depth: usize,
    ) -> Result<(), Problem> {
        let length = array
            .element()?
            .inside()
            .word("the length of a field name")? as usize;
        let names = array.element()?.data;
        if length == 0 || names.is_empty() {
            return Ok(());
        }
        let fields: Vec<String> = names.chunks(length).map(text).collect();
        for path in elements(name, sizes) {
            for field in &fields {
                self.member(&mut array, &format!("{path}.{field}"), depth)?;
            }
        }
        Ok(())
    }

    /// Objects: their name, that they are of MATLAB's classes, which, and a reference to where they are described.
    fn object(&mut self, mut array: Reader<'_>, path: &str, depth: usize) -> Result<(), Problem> {
        let name = text(array.element()?.data);
        let path = if path.is_empty() { &name } else { path };
        array.skip(2)?;
        let mut reference = array.element()?.inside();
        reference.skip(3)?;
        let reference = reference.element()?;
        self.properties(path, &words(&reference), depth)
    }

    /// The properties of the objects that are referred to.
    fn properties(&mut self, path: &str, reference: &[u32], depth: usize) -> Result<(), Problem> {
        let Some(objects) = referred(reference) else {
            return Ok(());
        };
        for (i, object) in objects.iter().enumerate() {
            let path = numbered(path, i + 1, objects.len());
            for (name, value) in self.subsystem.properties(*object) {
                let Some(left) = self.left.checked_sub(1) else {
                    return Ok(());
                };
                self.left = left;
                let path = format!("{path}.{name}");
                match reference_in(value.inside()) {
                    Some(reference) if depth < DEEPEST => {
                        self.properties(&path, &reference, depth + 1)?;
                    }
                    Some(_) => {}
                    None => self.read(value.inside(), &path, depth + 1)?,
                }
            }
        }
        Ok(())
    }
}

/// The names of the elements of an array. Each takes bytes of the file, so that a count that lies ends in an error, not
/// in a hang.
fn elements(name: &str, sizes: &[usize]) -> impl Iterator<Item = String> {
    let sizes = sizes.iter();
    let count = sizes.fold(1_usize, |n, size| n.saturating_mul(*size));
    (1..=count).map(move |i| numbered(name, i, count))
}

/// The name of one of so many, as MATLAB writes it.
fn numbered(name: &str, i: usize, count: usize) -> String {
    if count == 1 {
        name.to_owned()
    } else {
        format!("{name}({i})")
    }
}

/// A reference to objects, where the array is one.
fn reference_in(mut array: Reader<'_>) -> Option<Vec<u32>> {
    let element = array.element().ok()?;
    let flags = element.inside().word("the flags of an array").ok()?;
    if flags & 0xff != WORDS {
        return None;
    }
    array.skip(2).ok()?;
    let words = words(&array.element().ok()?);
    referred(&words).is_some().then_some(words)
}

/// The numbers of an element as words.
fn words(element: &Element<'_>) -> Vec<u32> {
    let numbers = element.numbers().unwrap_or_default();
    numbers.into_iter().map(|n| n as u32).collect()
}

/// Text up to the first zero.
fn text(bytes: &[u8]) -> String {
    let end = bytes.iter().position(|b| *b == 0).unwrap_or(bytes.len());
    String::from_utf8_lossy(bytes.get(..end).unwrap_or_default()).into_owned()
}

/// A vector is one series; of a matrix each column, or each row where the rows are longer.
pub fn columns(name: &str, sizes: &[usize], values: Vec<f64>, found: &mut Vec<Series>) {
    if values.is_empty()
        || sizes.iter().try_fold(1_usize, |n, s| n.checked_mul(*s)) != Some(values.len())
    {
        return;
    }
    let mut long = sizes.iter().filter(|n| **n > 1);
    match (long.next(), long.next(), sizes) {
        (_, None, _) => found.push(Series {
            name: name.to_owned(),
            values,
            ..Series::default()
        }),
        (_, _, &[rows, columns]) if rows >= columns => {
            let all = values.chunks(rows).enumerate();
            found.extend(all.map(|(j, column)| Series {
                name: format!("{name}(:,{})", j + 1),
                values: column.to_vec(),
                ..Series::default()
            }));
        }
        (_, _, &[rows, _]) => found.extend((0..rows).map(|i| Series {
            name: format!("{name}({},:)", i + 1),
            values: values.iter().skip(i).step_by(rows).copied().collect(),
            ..Series::default()
        })),
        _ => {}
    }
}
