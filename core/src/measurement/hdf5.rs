//! HDF5, as MATLAB's `save -v7.3` and others write it, read by the crate `hdf5-pure`.
//!
//! Groups are structures. MATLAB writes its arrays column by column with the sizes turned round, so that a matrix read
//! by the turned sizes is the one that was saved; arrays of structures are, field by field, references to their
//! elements.

use hdf5_pure::{AttrValue, DType, Dataset, Error, File, Group, Object};

use super::error::Problem;
use super::header::begin_of;
use super::mat::{DEEPEST, LARGEST, columns};
use super::series::Series;

/// Most datasets that are read: a hostile file has references in circles.
const MOST_DATASETS: usize = 10_000;

/// All series of numbers in a file.
pub(super) fn read(bytes: &[u8]) -> Result<Vec<Series>, Problem> {
    let damaged = |e: Error| Problem::Hdf5Damaged {
        what: begin_of(&e.to_string()),
    };
    let file = File::from_bytes(bytes.to_vec()).map_err(damaged)?;
    let mut walk = Walk {
        found: Vec::new(),
        left: LARGEST / size_of::<f64>(),
        datasets: MOST_DATASETS,
    };
    walk.group(&file.root(), "", 0).map_err(damaged)?;
    if walk.left == 0 {
        let mebibytes = LARGEST >> 20;
        return Err(Problem::MatTooLarge { mebibytes });
    }
    Ok(walk.found)
}

/// What was found on the way through a file.
struct Walk {
    found: Vec<Series>,
    /// How many numbers and datasets more may be read.
    left: usize,
    datasets: usize,
}

impl Walk {
    fn group(&mut self, group: &Group, path: &str, depth: usize) -> Result<(), Error> {
        if depth > DEEPEST {
            return Ok(());
        }
        let below = |name: &str| match path {
            "" => name.to_owned(),
            path => format!("{path}.{name}"),
        };
        // What MATLAB keeps to itself begins with a hash.
        let own = |name: &String| path.is_empty() && name.starts_with('#');
        let mut datasets = group.datasets()?;
        datasets.sort();
        for name in datasets.iter().filter(|n| !own(n)) {
            let dataset = group.dataset(name)?;
            self.dataset(&dataset, &below(name), Some((path, name)), depth)?;
        }
        let mut groups = group.groups()?;
        groups.sort();
        for name in groups.iter().filter(|n| !own(n)) {
            self.group(&group.group(name)?, &below(name), depth + 1)?;
        }
        Ok(())
    }

    /// A dataset: numbers, or where it is a field of an array of structures references to them.
    fn dataset(
        &mut self,
        dataset: &Dataset,
        path: &str,
        field: Option<(&str, &str)>,
        depth: usize,
    ) -> Result<(), Error> {
        let Some(datasets) = self.datasets.checked_sub(1) else {
            return Ok(());
        };
        self.datasets = datasets;
        let sizes: Vec<usize> = dataset.shape()?.iter().rev().map(|n| *n as usize).collect();
        let count = sizes
            .iter()
            .try_fold(1_usize, |n, size| n.checked_mul(*size));
        let attributes = dataset.attrs()?;
        let class = attributes.get("MATLAB_class").and_then(written);
        let passed = |class: &str| matches!(class, "char" | "cell" | "function_handle");
        if attributes.contains_key("MATLAB_empty") || class.is_some_and(passed) {
            return Ok(());
        }
        match dataset.dtype()? {
            DType::ObjectReference => {
                let (Some((parent, name)), true) = (field, depth < DEEPEST) else {
                    return Ok(());
                };
                if count.is_none_or(|count| count > self.datasets) {
                    return Ok(());
                }
                for (i, object) in dataset.dereference()?.iter().enumerate() {
                    let path = format!("{parent}({}).{name}", i + 1);
                    match object {
                        Object::Group(group) => self.group(group, &path, depth + 1)?,
                        Object::Dataset(inner) => self.dataset(inner, &path, None, depth + 1)?,
                        _ => {}
                    }
                }
            }
            kind if is_number(&kind) => {
                let Some(left) = count.and_then(|count| self.left.checked_sub(count)) else {
                    self.left = 0;
                    return Ok(());
                };
                self.left = left;
                let first = self.found.len();
                columns(path, &sizes, dataset.read_f64()?, &mut self.found);
                let unit = ["units", "unit", "Units"]
                    .iter()
                    .find_map(|a| attributes.get(*a).and_then(written));
                for series in self.found.iter_mut().skip(first) {
                    series.unit = unit.map(str::to_owned);
                }
            }
            _ => {}
        }
        Ok(())
    }
}

fn is_number(kind: &DType) -> bool {
    use DType::{F32, F64, I8, I16, I32, I64, U8, U16, U32, U64};
    matches!(
        kind,
        F32 | F64 | I8 | I16 | I32 | I64 | U8 | U16 | U32 | U64
    )
}

/// The text of an attribute.
fn written(value: &AttrValue) -> Option<&str> {
    match value {
        AttrValue::String(text) | AttrValue::AsciiString(text) => Some(text.trim_end_matches('\0')),
        _ => None,
    }
}
