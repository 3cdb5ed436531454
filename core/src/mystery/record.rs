//! A record in the counts of the bench, as a file and as a text that fits into a link.
//!
//! In a link every column is its second differences - a drive accelerates evenly between two switches, so that
//! these are small - as variable-length integers, deflated, in the letters of an address.

use std::fmt::Write as _;

use base64::Engine as _;
use base64::prelude::BASE64_URL_SAFE_NO_PAD as LETTERS;
use serde::{Deserialize, Serialize};
use sha2::{Digest as _, Sha256};

use super::MysteryError;
use crate::measurement::{Kind, MIN_SAMPLES, Quantity};

/// First byte of the text in a link.
const DRIVE: u8 = 1;
const PROCESS: u8 = 2;

/// Counts of the encoder in a turn.
const COUNTS: f64 = 1_048_576.0;
/// Step of the commanded torque, N m.
pub(super) const INPUT_STEP: f64 = 1e-3;
/// Step of the velocity, rad/s.
pub(super) const VELOCITY_STEP: f64 = 1e-3;

/// Step of the input and of the output of a process, in their units.
const PROCESS_STEP: f64 = 1e-3;

/// What is counted.
#[derive(Debug)]
pub struct Column {
    /// Name and unit in a file.
    pub title: &'static str,
    /// Counts in one of that unit.
    pub counts: f64,
    /// One count, SI.
    pub step: f64,
    /// What was measured.
    pub quantity: Quantity,
}

const fn column(title: &'static str, counts: f64, step: f64, quantity: Quantity) -> Column {
    Column {
        title,
        counts,
        step,
        quantity,
    }
}

const DRIVE_COLUMNS: [Column; 3] = [
    column("u [mN m]", 1.0, INPUT_STEP, Quantity::Input),
    column(
        "x1 [counts, 1048576/rev]",
        1.0,
        std::f64::consts::TAU / COUNTS,
        Quantity::Position,
    ),
    column("v1 [mrad/s]", 1.0, VELOCITY_STEP, Quantity::Velocity),
];

const PROCESS_COLUMNS: [Column; 2] = [
    column("u [1]", 1e3, PROCESS_STEP, Quantity::Input),
    column("y [1]", 1e3, PROCESS_STEP, Quantity::Output),
];

/// The columns of a record beside its time.
pub const fn columns(kind: Kind) -> &'static [Column] {
    match kind {
        Kind::Drive => &DRIVE_COLUMNS,
        Kind::Process => &PROCESS_COLUMNS,
    }
}

/// What stands before the sealed truth in a file.
const SEAL: &str = "# sealed truth 1: ";

/// Most samples that are read from a link.
const MOST_SAMPLES: usize = 100_000;

/// Most bytes that a link may inflate to.
const MOST_BYTES: usize = 2_000_000;

/// Effort of the compression.
const LEVEL: u8 = 9;

/// A record with the truth about it, sealed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Mystery {
    /// What was measured.
    pub kind: Kind,
    /// Sampling time, us.
    pub step: u32,
    /// Counts of [`columns`], equally many of each.
    pub columns: Vec<Vec<i32>>,
    /// The truth, sealed.
    pub seal: Vec<u8>,
}

impl Mystery {
    /// A name for its file, which tells nothing.
    pub fn name(&self) -> String {
        let digest = Sha256::digest(&self.seal);
        let mut name = "mystery-".to_owned();
        for byte in digest.iter().take(3) {
            let _ = write!(name, "{byte:02x}");
        }
        name
    }

    /// The file: an ordinary measurement, with the seal in a comment.
    pub fn csv(&self) -> String {
        let columns = columns(self.kind);
        let titles: Vec<&str> = columns.iter().map(|c| c.title).collect();
        let mut text = format!(
            "# A mystery of Hysteron. Open this file in Compare, find what is missing, then reveal the truth.\n\
             {SEAL}{}\nt [us],{}\n",
            LETTERS.encode(&self.seal),
            titles.join(",")
        );
        for i in 0..self.len() {
            // Writing into a string cannot fail.
            let _ = write!(text, "{}", i as u64 * u64::from(self.step));
            for (column, counts) in columns.iter().zip(&self.columns) {
                let count = counts.get(i).copied().map_or(0.0, f64::from);
                let _ = write!(text, ",{}", count / column.counts);
            }
            text.push('\n');
        }
        text
    }

    /// How many samples there are.
    pub fn len(&self) -> usize {
        self.columns.iter().map(Vec::len).min().unwrap_or(0)
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The text for a link.
    pub fn link(&self) -> String {
        let mut bytes = Vec::new();
        let length = self.len();
        for number in [u64::from(self.step), length as u64, self.seal.len() as u64] {
            push(number, &mut bytes);
        }
        bytes.extend(&self.seal);
        for column in &self.columns {
            let (mut last, mut slope) = (0, 0);
            for value in column.iter().take(length).map(|v| i64::from(*v)) {
                let difference = value - last - slope;
                push(zigzag(difference), &mut bytes);
                slope = value - last;
                last = value;
            }
        }
        let mut packed = vec![match self.kind {
            Kind::Drive => DRIVE,
            Kind::Process => PROCESS,
        }];
        packed.extend(miniz_oxide::deflate::compress_to_vec(&bytes, LEVEL));
        LETTERS.encode(packed)
    }

    /// Reads the text of a link, which may come from anybody.
    ///
    /// # Errors
    /// One sentence.
    pub fn from_link(text: &str) -> Result<Self, MysteryError> {
        let bad = MysteryError::BadLink;
        let packed = LETTERS
            .decode(text)
            .map_err(|_| bad("it has characters that do not belong there"))?;
        let (kind, packed) = match packed.split_first() {
            Some((&DRIVE, packed)) => (Kind::Drive, packed),
            Some((&PROCESS, packed)) => (Kind::Process, packed),
            _ => return Err(bad("it is of another version")),
        };
        let bytes = miniz_oxide::inflate::decompress_to_vec_with_limit(packed, MOST_BYTES)
            .map_err(|_| bad("it is cut off or changed"))?;
        let mut rest = bytes.as_slice();
        let cut = || bad("it ends too early");
        let step = pull(&mut rest).ok_or_else(cut)?;
        let length = pull(&mut rest).ok_or_else(cut)?;
        let sealed = pull(&mut rest).ok_or_else(cut)?;
        let length = usize::try_from(length).unwrap_or(usize::MAX);
        if !(MIN_SAMPLES..=MOST_SAMPLES).contains(&length) {
            return Err(bad("it has too few or too many samples"));
        }
        let step = u32::try_from(step).ok().filter(|s| *s > 0);
        let step = step.ok_or(bad("its sampling time is impossible"))?;
        let sealed = usize::try_from(sealed).unwrap_or(usize::MAX);
        let (seal, after) = rest.split_at_checked(sealed).ok_or_else(cut)?;
        rest = after;
        let mut columns = vec![Vec::new(); columns(kind).len()];
        for column in &mut columns {
            let (mut last, mut slope) = (0_i64, 0_i64);
            for _ in 0..length {
                let difference = unzigzag(pull(&mut rest).ok_or_else(cut)?);
                // Both others are differences of 32-bit numbers.
                let value = difference.checked_add(last + slope);
                let value = value.and_then(|v| i32::try_from(v).ok());
                let value = value.ok_or(bad("its numbers are impossible"))?;
                slope = i64::from(value) - last;
                last = i64::from(value);
                column.push(value);
            }
        }
        if !rest.is_empty() {
            return Err(bad("it goes on beyond its end"));
        }
        Ok(Self {
            kind,
            step,
            columns,
            seal: seal.to_vec(),
        })
    }
}

/// The sealed truth in a file, if there is one.
pub fn seal_of(file: &[u8]) -> Option<Vec<u8>> {
    let line = file
        .split(|b| *b == b'\n')
        .find_map(|line| line.strip_prefix(SEAL.as_bytes()))?;
    LETTERS.decode(line.trim_ascii()).ok()
}

/// Small numbers of either sign as small numbers without.
fn zigzag(value: i64) -> u64 {
    (value.wrapping_shl(1) ^ (value >> 63)).cast_unsigned()
}

fn unzigzag(value: u64) -> i64 {
    (value >> 1).cast_signed() ^ -(value & 1).cast_signed()
}

/// Appends a number, seven bits a byte, the lowest first; the highest bit says that there are more.
fn push(mut number: u64, bytes: &mut Vec<u8>) {
    while number >= 0x80 {
        bytes.push((number & 0x7f) as u8 | 0x80);
        number >>= 7;
    }
    bytes.push(number as u8);
}

/// Takes a number off the front; `None` where there is none.
fn pull(bytes: &mut &[u8]) -> Option<u64> {
    let mut number = 0;
    for shift in (0..63).step_by(7) {
        let (&byte, rest) = bytes.split_first()?;
        *bytes = rest;
        number |= u64::from(byte & 0x7f) << shift;
        if byte < 0x80 {
            return Some(number);
        }
    }
    None
}
