//! MATLAB's level 5 MAT-files (`save -v6` and `-v7`), after the "MAT-File Format" of `MathWorks` (2024).
//!
//! Real numeric arrays are read, also within structures (`log.signals(2).values`) and objects (`speed.Data` of a
//! timeseries, see [`super::matlab_objects`]); everything else is passed over. A matrix becomes one column for each of its
//! shorter side: `data(:,2)`.

use std::borrow::Cow;

use miniz_oxide::inflate::{TINFLStatus, decompress_to_vec_zlib_with_limit};

use super::error::Problem;
use super::matlab_objects::Objects;
use super::series::Series;

/// Length of the text and flags before the first element.
const HEADER: usize = 128;

/// Length of the five words at the begin of a file of level 4.
const LEVEL_4_HEADER: usize = 20;

/// Most bytes that all variables of a file may unpack to, so that a hostile one cannot fill the memory.
pub(super) const LARGEST: usize = 256 << 20;

/// Bytes of the tag of an element.
const TAG: usize = 8;

/// Most properties of objects that are read; a timeseries has some forty.
const MOST_PROPERTIES: usize = 20_000;

/// Deepest nesting of structures; logs have three or four levels.
pub(super) const DEEPEST: usize = 16;

/// What a file is, by its first bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Format {
    /// Level 5.
    Mat5,
    /// HDF5, as `save -v7.3` writes.
    Hdf5,
    /// Level 4, as `save -v4` writes.
    Mat4,
    /// None of these: text, as far as we know.
    Other,
}

/// Looks at the first bytes.
pub(super) fn format_of(bytes: &[u8]) -> Format {
    if bytes.starts_with(b"MATLAB 7.3") || bytes.starts_with(b"\x89HDF") {
        return Format::Hdf5;
    }
    match bytes.get(124..HEADER) {
        Some([0, 1, b'I', b'M'] | [1, 0, b'M', b'I']) => Format::Mat5,
        _ if bytes.starts_with(b"MATLAB 5.0") => Format::Mat5,
        _ if is_level_4(bytes) => Format::Mat4,
        _ => Format::Other,
    }
}

/// Whether a file begins as one of level 4 does: with five words for byte order and type, rows, columns, whether
/// there is an imaginary part, and the length of a name, which ends with a zero.
fn is_level_4(bytes: &[u8]) -> bool {
    let Some(words) = bytes.first_chunk::<LEVEL_4_HEADER>() else {
        return false;
    };
    let (words, _) = words.as_chunks::<4>();
    [
        (0, u32::from_le_bytes as fn([u8; 4]) -> u32),
        (1, u32::from_be_bytes),
    ]
    .into_iter()
    .any(|(order, word)| {
        let [kind, imaginary, length] = [0, 3, 4].map(|i| word(words[i]));
        // Thousands are the byte order, tens the type of the numbers, ones that of the matrix.
        let typed = kind / 1000 == order && kind % 1000 <= 52 && kind % 10 <= 2;
        let name = bytes
            .get(LEVEL_4_HEADER..)
            .and_then(|rest| rest.get(..length as usize));
        let named = name.is_some_and(|n| n.len() > 1 && n[0] != 0 && n.ends_with(&[0]));
        typed && imaginary <= 1 && named
    })
}

/// All series of numbers in a file.
pub(super) fn read(bytes: &[u8]) -> Result<Vec<Series>, Problem> {
    let big = match bytes.get(124..HEADER) {
        Some([0, 1, b'I', b'M']) => false,
        Some([1, 0, b'M', b'I']) => true,
        _ => return Err(damaged(124, "the version and the byte order")),
    };
    let mut left = LARGEST;
    let mut file = Reader {
        bytes,
        at: HEADER,
        big,
    };
    let mut subsystem = Vec::new();
    let begin = subsystem_begin(bytes, big).filter(|begin| *begin >= HEADER);
    if let Some(begin) = begin {
        // What is damaged in it is only missed by whom it describes.
        let mut at = Reader {
            bytes,
            at: begin,
            big,
        };
        let whole = at.element().ok().and_then(|e| unpacked(&e, &mut left).ok());
        subsystem = whole.map_or_else(Vec::new, Cow::into_owned);
    }
    let mut found = Found {
        series: Vec::new(),
        subsystem: Subsystem::of(&subsystem, big).unwrap_or_default(),
        left: MOST_PROPERTIES,
    };
    while file.at < bytes.len() {
        let place = file.at;
        // Places within a variable mean nothing to a user, least of all where it is compressed.
        let here = |problem| match problem {
            Problem::MatDamaged { expected, .. } => damaged(place, expected),
            other => other,
        };
        let element = file.element().map_err(here)?;
        if begin == Some(place) {
            continue;
        }
        let unpacked = unpacked(&element, &mut left).map_err(here)?;
        // Anything else at this level is MATLAB's own business.
        if !unpacked.is_empty() {
            let content = Reader {
                bytes: &unpacked,
                at: 0,
                big,
            };
            content.variable("", 0, &mut found).map_err(here)?;
        }
    }
    Ok(found.finish())
}

/// Where MATLAB keeps what describes its objects; the header says it in two words.
fn subsystem_begin(bytes: &[u8], big: bool) -> Option<usize> {
    let begin: [u8; 8] = bytes.get(116..124)?.try_into().ok()?;
    let begin = if big {
        u64::from_be_bytes(begin)
    } else {
        u64::from_le_bytes(begin)
    };
    usize::try_from(begin).ok()
}

/// The content of a variable, unpacked if it is compressed; nothing of an element that is no variable.
fn unpacked<'a>(element: &Element<'a>, left: &mut usize) -> Result<Cow<'a, [u8]>, Problem> {
    match element.kind {
        MATRIX => Ok(Cow::Borrowed(element.data)),
        COMPRESSED => {
            let mut unpacked = unpack(element.data, *left)?;
            *left = left.saturating_sub(unpacked.len());
            let mut inner = Reader {
                bytes: &unpacked,
                at: 0,
                big: element.big,
            };
            let element = inner.element()?;
            let length = if element.kind == MATRIX {
                element.data.len()
            } else {
                0
            };
            let from = unpacked.len().min(TAG);
            unpacked.drain(..from);
            unpacked.truncate(length);
            Ok(Cow::Owned(unpacked))
        }
        _ => Ok(Cow::Borrowed(&[])),
    }
}

/// What was found in a file.
struct Found<'a> {
    series: Vec<Series>,
    subsystem: Subsystem<'a>,
    /// How many properties of objects may still be read: some may refer to each other.
    left: usize,
}

impl Found<'_> {
    /// The series, with the times of a timeseries that has only their begin and distance.
    fn finish(mut self) -> Vec<Series> {
        let lengths = self
            .series
            .iter()
            .filter_map(|s| s.name.strip_suffix(".TimeInfo.Length"));
        let timeseries: Vec<String> = lengths.map(str::to_owned).collect();
        for path in timeseries {
            complete(&path, &mut self.series);
        }
        self.series
    }
}

/// Gives a timeseries its times where they stand apart from it, or are told by their begin and distance, and leaves out
/// what is only said about it.
fn complete(path: &str, all: &mut Vec<Series>) {
    let under = |name: &str, what: &str| {
        let rest = name.strip_prefix(path);
        rest.and_then(|r| r.strip_prefix('.'))
            .is_some_and(|r| r == what)
    };
    let values = |what: &str| {
        all.iter()
            .find(|s| under(&s.name, what))
            .map_or(&[][..], |s| &s.values)
    };
    let samples = values("Data").len();
    let times = match (values("Time"), values("TimeInfo.Time")) {
        ([_, _, ..], _) => None,
        (_, apart @ [_, _, ..]) => Some(apart.to_vec()),
        _ => {
            let first = |what: &str, other: f64| values(what).first().copied().unwrap_or(other);
            let (start, step) = (
                first("TimeInfo.Start", 0.0),
                first("TimeInfo.Increment", 0.0),
            );
            Some((0..samples).map(|i| start + i as f64 * step).collect()).filter(|_| step > 0.0)
        }
    };
    let said = |series: &Series| {
        let rest = series
            .name
            .strip_prefix(path)
            .and_then(|r| r.strip_prefix('.'));
        rest.is_some_and(|rest| {
            !rest.starts_with("Data") && rest != "Time" || rest.starts_with("DataInfo.")
        })
    };
    let place = all.iter().position(|s| under(&s.name, "Data"));
    let unit = Some("s".to_owned());
    if let (Some(place), Some(values)) = (place, times) {
        let name = format!("{path}.Time");
        all.insert(
            place,
            Series {
                name,
                unit,
                values,
                ..Series::default()
            },
        );
    } else if let Some(time) = all.iter_mut().find(|s| under(&s.name, "Time")) {
        time.unit = unit;
    }
    all.retain(|series| !said(series));
}

/// Where the objects of a file are described, and the values of their properties.
#[derive(Default)]
struct Subsystem<'a> {
    objects: Option<Objects>,
    cells: Vec<Element<'a>>,
}

impl<'a> Subsystem<'a> {
    /// Reads the content of the variable in which it stands: bytes that are a small file of their own, with a structure
    /// that has one field, the wrapper of the cells.
    fn of(bytes: &'a [u8], big: bool) -> Option<Self> {
        let reader = |bytes| Reader { bytes, at: 0, big };
        let mut outer = reader(bytes);
        // Flags, sizes and name.
        for _ in 0..3 {
            outer.element().ok()?;
        }
        let mut file = reader(outer.element().ok()?.data);
        file.at = TAG;
        let mut structure = reader(file.element().ok()?.data);
        // Flags, sizes, name, length and names of fields.
        for _ in 0..5 {
            structure.element().ok()?;
        }
        let mut wrapper = reader(structure.element().ok()?.data);
        // Flags, name, type and class.
        for _ in 0..4 {
            wrapper.element().ok()?;
        }
        let mut array = reader(wrapper.element().ok()?.data);
        for _ in 0..3 {
            array.element().ok()?;
        }
        let mut cells = Vec::new();
        while array.at < array.bytes.len() {
            cells.push(array.element().ok()?);
        }
        let mut first = cells.first()?.inside(big);
        for _ in 0..3 {
            first.element().ok()?;
        }
        let objects = Objects::read(first.element().ok()?.data, big);
        Some(Self { objects, cells })
    }
}

/// Unpacks a compressed variable to at most so many bytes.
fn unpack(data: &[u8], most: usize) -> Result<Vec<u8>, Problem> {
    decompress_to_vec_zlib_with_limit(data, most).map_err(|e| match e.status {
        TINFLStatus::HasMoreOutput => Problem::MatTooLarge {
            mebibytes: LARGEST >> 20,
        },
        _ => damaged(0, "a zlib stream"),
    })
}

fn damaged(byte: usize, expected: &'static str) -> Problem {
    Problem::MatDamaged { byte, expected }
}

// Types of data elements.
const MATRIX: u32 = 14;
const COMPRESSED: u32 = 15;

// Classes of arrays.
const STRUCT: u32 = 2;
const WORDS: u32 = 13;
const OPAQUE: u32 = 17;
const NUMERIC: std::ops::RangeInclusive<u32> = 6..=15;
/// Flag of an array with an imaginary part.
const COMPLEX: u32 = 0x0800;

/// A tagged piece of the file.
#[derive(Clone, Copy)]
struct Element<'a> {
    kind: u32,
    big: bool,
    data: &'a [u8],
}

impl<'a> Element<'a> {
    fn inside(&self, big: bool) -> Reader<'a> {
        Reader {
            bytes: self.data,
            at: 0,
            big,
        }
    }

    /// Its numbers; `None` where they are none.
    fn numbers(&self, big: bool) -> Option<Vec<f64>> {
        macro_rules! all {
            ($number:ty, $convert:expr) => {{
                let (whole, rest) = self.data.as_chunks::<{ size_of::<$number>() }>();
                let one = |b: &[u8; size_of::<$number>()]| {
                    $convert(if big {
                        <$number>::from_be_bytes(*b)
                    } else {
                        <$number>::from_le_bytes(*b)
                    })
                };
                rest.is_empty().then(|| whole.iter().map(one).collect())
            }};
        }
        match self.kind {
            1 => all!(i8, f64::from),
            2 => all!(u8, f64::from),
            3 => all!(i16, f64::from),
            4 => all!(u16, f64::from),
            5 => all!(i32, f64::from),
            6 => all!(u32, f64::from),
            7 => all!(f32, f64::from),
            9 => all!(f64, f64::from),
            12 => all!(i64, |n| n as f64),
            13 => all!(u64, |n| n as f64),
            _ => None,
        }
    }
}

/// Walks over the elements of a file or of one of its arrays.
struct Reader<'a> {
    bytes: &'a [u8],
    at: usize,
    big: bool,
}

impl<'a> Reader<'a> {
    fn take(&mut self, count: usize, expected: &'static str) -> Result<&'a [u8], Problem> {
        let end = self.at.saturating_add(count);
        let taken = self
            .bytes
            .get(self.at..end)
            .ok_or_else(|| damaged(self.at, expected))?;
        self.at = end;
        Ok(taken)
    }

    fn word(&mut self, expected: &'static str) -> Result<u32, Problem> {
        let bytes = self.take(4, expected)?;
        let bytes = bytes.try_into().unwrap_or_default();
        Ok(if self.big {
            u32::from_be_bytes(bytes)
        } else {
            u32::from_le_bytes(bytes)
        })
    }

    /// The next element, past its padding to 8 bytes. Up to four bytes stand within the tag itself.
    fn element(&mut self) -> Result<Element<'a>, Problem> {
        let start = self.at;
        let first = self.word("a data element")?;
        let (kind, small) = (first & 0xffff, (first >> 16) as usize);
        if small > 0 {
            let field = self.take(4, "a small data element")?;
            let data = field
                .get(..small)
                .ok_or_else(|| damaged(start, "a small data element of at most 4 bytes"))?;
            return Ok(Element {
                kind,
                big: self.big,
                data,
            });
        }
        let size = self.word("the size of a data element")? as usize;
        let data = self.take(size, "as many bytes as the data element says")?;
        if kind != COMPRESSED {
            // The last padding may be missing.
            self.at = self
                .at
                .saturating_add(size.wrapping_neg() % 8)
                .min(self.bytes.len());
        }
        Ok(Element {
            kind,
            big: self.big,
            data,
        })
    }

    /// The content of an array: flags, size, name, and by its class numbers or fields.
    fn variable(mut self, path: &str, depth: usize, found: &mut Found<'_>) -> Result<(), Problem> {
        if self.bytes.is_empty() || depth > DEEPEST {
            return Ok(());
        }
        let big = self.big;
        let flags = self.element()?.inside(big).word("the flags of an array")?;
        let class = flags & 0xff;
        if class == OPAQUE {
            return self.object(path, depth, found);
        }
        if class != STRUCT && !NUMERIC.contains(&class) {
            return Ok(());
        }
        let sizes = self
            .element()?
            .numbers(big)
            .ok_or_else(|| damaged(self.at, "the size of an array"))?;
        let sizes: Vec<usize> = sizes.iter().map(|n| *n as usize).collect();
        let name = self.element()?.data;
        let name = if path.is_empty() {
            text(name)
        } else {
            path.to_owned()
        };
        if class == STRUCT {
            return self.fields(&name, &sizes, depth, found);
        }
        if flags & COMPLEX == 0 {
            let values = self
                .element()?
                .numbers(big)
                .ok_or_else(|| damaged(self.at, "the numbers of an array"))?;
            columns(&name, &sizes, values, &mut found.series);
        }
        Ok(())
    }

    /// A reference to objects, where the array is one.
    fn reference(mut self) -> Option<Vec<u32>> {
        let big = self.big;
        let flags = self
            .element()
            .ok()?
            .inside(big)
            .word("the flags of an array")
            .ok()?;
        if flags & 0xff != WORDS {
            return None;
        }
        for _ in 0..2 {
            self.element().ok()?;
        }
        let words = words(&self.element().ok()?);
        Objects::referred(&words).is_some().then_some(words)
    }

    /// Objects: their name, that they are of MATLAB's classes, which, and a reference to where they are described.
    fn object(mut self, path: &str, depth: usize, found: &mut Found<'_>) -> Result<(), Problem> {
        let big = self.big;
        let name = text(self.element()?.data);
        let path = if path.is_empty() { &name } else { path };
        for _ in 0..2 {
            self.element()?;
        }
        let mut reference = self.element()?.inside(big);
        for _ in 0..3 {
            reference.element()?;
        }
        let reference = reference.element()?;
        properties(path, &words(&reference), depth, found)
    }

    /// The fields of each element of an array of structures.
    fn fields(
        mut self,
        name: &str,
        sizes: &[usize],
        depth: usize,
        found: &mut Found<'_>,
    ) -> Result<(), Problem> {
        let big = self.big;
        let length = self
            .element()?
            .inside(big)
            .word("the length of a field name")? as usize;
        let names = self.element()?.data;
        if length == 0 || names.is_empty() {
            return Ok(());
        }
        let fields: Vec<String> = names.chunks(length).map(text).collect();
        let count = sizes
            .iter()
            .fold(1_usize, |n, size| n.saturating_mul(*size));
        // Each turn takes bytes of the file, so a count that lies ends in an error, not in a hang.
        for i in 1..=count {
            for field in &fields {
                let element = self.element()?;
                let path = if count == 1 {
                    format!("{name}.{field}")
                } else {
                    format!("{name}({i}).{field}")
                };
                if element.kind == MATRIX {
                    element.inside(big).variable(&path, depth + 1, found)?;
                }
            }
        }
        Ok(())
    }
}

/// The numbers of an element as words.
fn words(element: &Element<'_>) -> Vec<u32> {
    let numbers = element.numbers(element.big).unwrap_or_default();
    numbers.into_iter().map(|n| n as u32).collect()
}

/// The properties of the objects that are referred to.
fn properties(
    path: &str,
    reference: &[u32],
    depth: usize,
    found: &mut Found<'_>,
) -> Result<(), Problem> {
    let Some(referred) = Objects::referred(reference) else {
        return Ok(());
    };
    for (i, object) in referred.iter().enumerate() {
        let path = if referred.len() == 1 {
            path.to_owned()
        } else {
            format!("{path}({})", i + 1)
        };
        let objects = found.subsystem.objects.as_ref();
        let all = objects.into_iter().flat_map(|o| o.properties(*object));
        let all: Vec<(String, usize)> = all.map(|(name, cell)| (name.to_owned(), cell)).collect();
        for (name, cell) in all {
            let Some(cell) = found.subsystem.cells.get(cell).copied() else {
                continue;
            };
            let Some(left) = found.left.checked_sub(1) else {
                return Ok(());
            };
            found.left = left;
            let path = format!("{path}.{name}");
            let content = cell.inside(cell.big);
            match content.reference() {
                Some(reference) if depth < DEEPEST => {
                    properties(&path, &reference, depth + 1, found)?;
                }
                Some(_) => {}
                None => cell.inside(cell.big).variable(&path, depth + 1, found)?,
            }
        }
    }
    Ok(())
}

/// Text up to the first zero.
fn text(bytes: &[u8]) -> String {
    let end = bytes.iter().position(|b| *b == 0).unwrap_or(bytes.len());
    String::from_utf8_lossy(bytes.get(..end).unwrap_or_default()).into_owned()
}

/// A vector is one series; of a matrix each column, or each row where the rows are longer.
pub(super) fn columns(name: &str, sizes: &[usize], values: Vec<f64>, found: &mut Vec<Series>) {
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
