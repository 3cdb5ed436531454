//! Objects in files of MATLAB, such as timeseries: which properties an object has, and where their values stand.
//!
//! The format is not published. A file keeps its objects in a subsystem of its own: a list of cells, of which the first
//! describes all objects and the others are values of properties. The description is, in 32-bit words: a version, the
//! number of names, the begins of its regions; then the names, each ended by a zero. Of the regions the first has the
//! classes, the third six words for each object (the fourth and the fifth say which lists of properties are its own, in
//! the second and the fourth region). A list of properties is
//! their number and three words for each: its name, how its value is told (1: by a cell), and which it is.

use super::element::{Element, Reader, TAG};

/// First word of a reference to objects.
const REFERENCE: u32 = 0xdd00_0000;

/// Cells before the first value.
const CELLS_BEFORE: usize = 2;

/// How the value of a property is told that stands in a cell.
const IN_A_CELL: u32 = 1;

/// Words of an object and of a property.
const WORDS_OF_OBJECT: usize = 6;
const WORDS_OF_PROPERTY: usize = 3;

/// Places of the regions that are read, among the begins of all.
const SAVED: usize = 1;
const OBJECTS: usize = 2;
const OWN: usize = 3;

/// Where the objects of a file are described, and the values of their properties.
#[derive(Default)]
pub struct Subsystem<'a> {
    objects: Option<Objects>,
    cells: Vec<Element<'a>>,
}

impl<'a> Subsystem<'a> {
    /// Reads the content of the variable in which it stands: bytes that are a small file of their own, with a structure
    /// that has one field, the wrapper of the cells.
    pub fn of(bytes: &'a [u8], big: bool) -> Option<Self> {
        let reader = |bytes| Reader::of(bytes, big);
        let mut outer = reader(bytes);
        // Flags, sizes and name.
        outer.skip(3).ok()?;
        let mut file = reader(outer.element().ok()?.data);
        file.at = TAG;
        let mut structure = file.element().ok()?.inside();
        // Flags, sizes, name, length and names of fields.
        structure.skip(5).ok()?;
        let mut wrapper = structure.element().ok()?.inside();
        // Flags, name, type and class.
        wrapper.skip(4).ok()?;
        let mut array = wrapper.element().ok()?.inside();
        array.skip(3).ok()?;
        let mut cells = Vec::new();
        while array.at < array.bytes.len() {
            cells.push(array.element().ok()?);
        }
        let mut first = cells.first()?.inside();
        first.skip(3).ok()?;
        let objects = Objects::read(first.element().ok()?.data, big);
        Some(Self { objects, cells })
    }

    /// The properties of an object: their names and values.
    pub fn properties(&self, object: u32) -> Vec<(String, Element<'a>)> {
        let objects = self.objects.as_ref().into_iter();
        let all = objects.flat_map(|o| o.properties(object));
        all.filter_map(|(name, cell)| Some((name.to_owned(), *self.cells.get(cell)?)))
            .collect()
    }
}

/// What is known of all objects.
#[derive(Debug)]
struct Objects {
    names: Vec<String>,
    /// The names of the properties of each object, by their places from 1, and the cells of their values.
    objects: Vec<Vec<(usize, usize)>>,
}

impl Objects {
    /// Reads the description of all objects; `None` where it is none.
    fn read(bytes: &[u8], big: bool) -> Option<Self> {
        let words: Vec<u32> = words(bytes, big);
        let count = *words.get(1)? as usize;
        // From version 4 on there are two regions more, of which nothing is needed.
        let regions = if *words.first()? >= 4 { 8 } else { 6 };
        let begins: Vec<usize> = words
            .get(2..2 + regions)?
            .iter()
            .map(|b| *b as usize)
            .collect();
        let region = |which: usize| {
            let (from, to) = (begins.get(which)? / 4, begins.get(which + 1)? / 4);
            words.get(from..to)
        };
        let names = bytes.get(4 * (2 + regions)..*begins.first()?)?;
        let names = names.split(|b| *b == 0).take(count);
        let names: Vec<String> = names
            .map(|n| String::from_utf8_lossy(n).into_owned())
            .collect();
        let [saved, own] = [lists(region(SAVED)?), lists(region(OWN)?)];
        let object = |words: &[u32]| {
            let list = |lists: &[Vec<(usize, usize)>], place: usize| {
                let which = words.get(place).map_or(0, |w| *w as usize);
                lists.get(which).cloned().unwrap_or_default()
            };
            [list(&saved, 3), list(&own, 4)].concat()
        };
        let objects = region(OBJECTS)?
            .chunks(WORDS_OF_OBJECT)
            .map(object)
            .collect();
        Some(Self { names, objects })
    }

    /// The properties of an object: their names, and the cells in which their values stand.
    fn properties(&self, object: u32) -> impl Iterator<Item = (&str, usize)> {
        let properties = self
            .objects
            .get(object as usize)
            .map_or(&[][..], Vec::as_slice);
        properties.iter().filter_map(|(name, cell)| {
            let name = self.names.get(name.checked_sub(1)?)?;
            // How MATLAB calls what it keeps to itself of what it shows.
            let name = name.strip_suffix('_').unwrap_or(name);
            Some((name, cell.checked_add(CELLS_BEFORE)?))
        })
    }
}

/// The objects that these words refer to; `None` where they refer to none.
pub fn referred(words: &[u32]) -> Option<&[u32]> {
    let (first, rest) = words.split_first()?;
    let (dimensions, rest) = rest.split_first()?;
    let counts = rest.get(..*dimensions as usize)?;
    let count = counts
        .iter()
        .try_fold(1_usize, |n, c| n.checked_mul(*c as usize))?;
    (*first == REFERENCE)
        .then(|| rest.get(counts.len()..)?.get(..count))
        .flatten()
}

/// The lists of properties of a region, as names and cells; each is filled up to 8 bytes.
fn lists(words: &[u32]) -> Vec<Vec<(usize, usize)>> {
    let mut lists = Vec::new();
    let mut rest = words;
    while let Some((count, after)) = rest.split_first() {
        let length = (*count as usize).saturating_mul(WORDS_OF_PROPERTY);
        let Some(properties) = after.get(..length) else {
            break;
        };
        let in_cells = properties
            .chunks(WORDS_OF_PROPERTY)
            .filter_map(|p| match p {
                [name, IN_A_CELL, cell] => Some((*name as usize, *cell as usize)),
                _ => None,
            });
        lists.push(in_cells.collect());
        // The count is a word too.
        rest = after.get(length + (1 + length) % 2..).unwrap_or_default();
    }
    lists
}

fn words(bytes: &[u8], big: bool) -> Vec<u32> {
    let (words, _) = bytes.as_chunks::<4>();
    let word = |bytes: &[u8; 4]| {
        if big {
            u32::from_be_bytes(*bytes)
        } else {
            u32::from_le_bytes(*bytes)
        }
    };
    words.iter().map(word).collect()
}
