//! The elements of which a file and each of its arrays are made: a tag of type and size, then numbers or other
//! elements.

use crate::measurement::error::Problem;

/// Type of an element that is an array.
pub const MATRIX: u32 = 14;
/// Type of an element that has another one in it, compressed.
pub const COMPRESSED: u32 = 15;

/// Bytes of the tag of an element.
pub const TAG: usize = 8;

/// What stands at a byte is not what was expected there.
pub fn damaged(byte: usize, expected: &'static str) -> Problem {
    Problem::MatDamaged { byte, expected }
}

/// A tagged piece of the file.
#[derive(Clone, Copy)]
pub struct Element<'a> {
    pub kind: u32,
    pub big: bool,
    pub data: &'a [u8],
}

impl<'a> Element<'a> {
    pub fn inside(&self) -> Reader<'a> {
        Reader::of(self.data, self.big)
    }

    /// Its numbers; `None` where they are none.
    pub fn numbers(&self) -> Option<Vec<f64>> {
        macro_rules! all {
            ($number:ty, $convert:expr) => {{
                let (whole, rest) = self.data.as_chunks::<{ size_of::<$number>() }>();
                let one = |b: &[u8; size_of::<$number>()]| {
                    $convert(if self.big {
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
pub struct Reader<'a> {
    pub bytes: &'a [u8],
    pub at: usize,
    pub big: bool,
}

impl<'a> Reader<'a> {
    pub fn of(bytes: &'a [u8], big: bool) -> Self {
        Self { bytes, at: 0, big }
    }

    fn take(&mut self, count: usize, expected: &'static str) -> Result<&'a [u8], Problem> {
        let end = self.at.saturating_add(count);
        let taken = self
            .bytes
            .get(self.at..end)
            .ok_or_else(|| damaged(self.at, expected))?;
        self.at = end;
        Ok(taken)
    }

    pub fn word(&mut self, expected: &'static str) -> Result<u32, Problem> {
        let bytes = self.take(4, expected)?;
        let bytes = bytes.try_into().unwrap_or_default();
        Ok(if self.big {
            u32::from_be_bytes(bytes)
        } else {
            u32::from_le_bytes(bytes)
        })
    }

    /// The next element, past its padding to 8 bytes. Up to four bytes stand within the tag itself.
    pub fn element(&mut self) -> Result<Element<'a>, Problem> {
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

    /// Passes over so many elements.
    pub fn skip(&mut self, count: usize) -> Result<(), Problem> {
        (0..count).try_for_each(|_| self.element().map(|_| ()))
    }
}
