//! MATLAB's level 5 MAT-files (`save -v6` and `-v7`), after the "MAT-File Format" of `MathWorks` (2024).
//!
//! Real numeric arrays are read, also within structures (`log.signals(2).values`), cells and objects (`speed.Data` of a
//! timeseries, see [`objects`]; `data.InputData` of an `iddata`); everything else is passed over. A matrix becomes one
//! column for each of its shorter side: `data(:,2)`.

mod array;
mod element;
mod iddata;
mod objects;
mod timeseries;

use std::borrow::Cow;

use miniz_oxide::inflate::{TINFLStatus, decompress_to_vec_zlib_with_limit};

use super::error::Problem;
use super::series::Series;
use array::Found;
#[cfg(not(target_arch = "wasm32"))]
pub(super) use array::{DEEPEST, columns};
use element::{COMPRESSED, Element, MATRIX, Reader, TAG, damaged};
use objects::Subsystem;

/// Length of the text and flags before the first element.
const HEADER: usize = 128;

/// Length of the five words at the begin of a file of level 4.
const LEVEL_4_HEADER: usize = 20;

/// Most bytes that all variables of a file may unpack to, so that a hostile one cannot fill the memory.
pub(super) const LARGEST: usize = 256 << 20;

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
    let mut file = Reader::of(bytes, big);
    let mut subsystem = Vec::new();
    let begin = subsystem_begin(bytes, big).filter(|begin| *begin >= HEADER);
    if let Some(begin) = begin {
        // What is damaged in it is only missed by whom it describes.
        file.at = begin;
        let whole = file
            .element()
            .ok()
            .and_then(|e| unpacked(&e, &mut left).ok());
        subsystem = whole.map_or_else(Vec::new, Cow::into_owned);
    }
    let mut found = Found::nothing(Subsystem::of(&subsystem, big).unwrap_or_default());
    file.at = HEADER;
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
            let content = Reader::of(&unpacked, big);
            found.read(content, "", 0).map_err(here)?;
        }
    }
    timeseries::complete(&mut found.series);
    iddata::complete(&mut found.series);
    Ok(found.series)
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
            let mut inner = Reader::of(&unpacked, element.big);
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

/// Unpacks a compressed variable to at most so many bytes.
fn unpack(data: &[u8], most: usize) -> Result<Vec<u8>, Problem> {
    decompress_to_vec_zlib_with_limit(data, most).map_err(|e| match e.status {
        TINFLStatus::HasMoreOutput => Problem::MatTooLarge {
            mebibytes: LARGEST >> 20,
        },
        _ => damaged(0, "a zlib stream"),
    })
}
