//! A table of numbers in little room: the measurements that come with the app are packed so by `build.rs`.
//!
//! Packed is a table by columns, deflated. A position is what an encoder counted, and a velocity follows a line from
//! sample to sample: a column becomes whole numbers, of which the second differences are kept. What would not come
//! out to the last character is kept as text, so that unpacking gives the very file.

use std::fmt::Write as _;

/// Strings of digits in a column of whole numbers, one for each byte of them.
pub const PLANES: usize = 4;

/// Significant digits of a counted position.
pub const COUNT_DIGITS: i32 = 9;

/// Largest power of ten that a double has exactly.
const LARGEST_POWER: i32 = 22;

/// How a column is kept.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// Each field as it stands.
    Text,
    /// Equal steps from 0, with so many decimals.
    Steps { step: f64, decimals: usize },
    /// Multiples of the resolution of an encoder.
    Counts { resolution: f64 },
    /// Decimal numbers of so many significant digits.
    Digits(usize),
}

/// The file of a packed table.
pub fn unpack(deflated: &[u8]) -> Option<Vec<u8>> {
    unpack_rows(deflated, usize::MAX)
}

/// Its head, and at most so many rows.
pub fn unpack_rows(deflated: &[u8], most: usize) -> Option<Vec<u8>> {
    let bytes = miniz_oxide::inflate::decompress_to_vec(deflated).ok()?;
    let mut reader = Reader(&bytes);
    let head = reader.text()?.to_owned();
    let rows = reader.number()?;
    let columns = (0..head.split(',').count()).map(|_| Column::read(&mut reader, rows));
    let mut columns: Vec<Column> = columns.collect::<Option<_>>()?;
    let mut csv = head;
    csv.push('\n');
    for row in 0..rows.min(most) {
        for (i, column) in columns.iter_mut().enumerate() {
            if i > 0 {
                csv.push(',');
            }
            column.put(&mut csv, row)?;
        }
        csv.push('\n');
    }
    Some(csv.into_bytes())
}

/// A column that is being unpacked.
struct Column<'a> {
    kind: Kind,
    fields: std::str::Lines<'a>,
    numbers: Vec<i64>,
    more: std::vec::IntoIter<i64>,
    exceptions: std::iter::Peekable<std::vec::IntoIter<(usize, &'a str)>>,
}

impl<'a> Column<'a> {
    fn read(reader: &mut Reader<'a>, rows: usize) -> Option<Self> {
        let mut column = Self {
            kind: Kind::Text,
            fields: "".lines(),
            numbers: Vec::new(),
            more: Vec::new().into_iter(),
            exceptions: Vec::new().into_iter().peekable(),
        };
        match reader.number()? {
            0 => {
                column.fields = reader.text()?.lines();
                return Some(column);
            }
            1 => {
                let (step, decimals) = (reader.float()?, reader.number()?);
                column.kind = Kind::Steps { step, decimals };
                return Some(column);
            }
            2 => {
                let resolution = reader.float()?;
                column.kind = Kind::Counts { resolution };
            }
            _ => {
                column.kind = Kind::Digits(reader.number()?);
                let count = reader.number()?;
                column.more = reader.planes(count)?.into_iter();
            }
        }
        column.numbers = twice_summed(&reader.planes(rows)?);
        let exceptions = (0..reader.number()?).map(|_| Some((reader.number()?, reader.text()?)));
        column.exceptions = exceptions
            .collect::<Option<Vec<_>>>()?
            .into_iter()
            .peekable();
        Some(column)
    }

    /// Writes the next field.
    fn put(&mut self, out: &mut String, row: usize) -> Option<()> {
        match self.kind {
            Kind::Text => out.push_str(self.fields.next()?),
            Kind::Steps { step, decimals } => {
                write!(out, "{:.decimals$}", row as f64 * step).ok()?;
            }
            Kind::Counts { resolution } => {
                let number = self.numbers[row];
                match self.exceptions.next_if(|e| e.0 == row) {
                    Some((_, text)) => out.push_str(text),
                    None => put_count(out, number, resolution),
                }
            }
            Kind::Digits(digits) => {
                let number = self.numbers[row];
                let more = more_digits(number, digits);
                let rest = if more > 0 { self.more.next()? } else { 0 };
                match self.exceptions.next_if(|e| e.0 == row) {
                    Some((_, text)) => out.push_str(text),
                    None => put_digits(out, number, rest, digits),
                }
            }
        }
        Some(())
    }
}

/// Numbers whose second differences are these.
fn twice_summed(differences: &[i64]) -> Vec<i64> {
    let (mut slope, mut number) = (0_i64, 0_i64);
    let sum = |difference: &i64| {
        slope = slope.wrapping_add(*difference);
        number = number.wrapping_add(slope);
        number
    };
    differences.iter().map(sum).collect()
}

/// Digits that a decimal number has beyond its first `digits` decimals: none at or above 0.1.
pub fn more_digits(number: i64, digits: usize) -> usize {
    let length = number.unsigned_abs().checked_ilog10().map_or(0, |l| l + 1);
    if number == 0 {
        0
    } else {
        digits.saturating_sub(length as usize)
    }
}

/// Writes a multiple of a resolution.
pub fn put_count(out: &mut String, count: i64, resolution: f64) {
    let value = (count as f64 * resolution).abs();
    // Decimals that leave so many significant digits.
    let mut decimals = COUNT_DIGITS;
    while decimals < LARGEST_POWER && value < 10_f64.powi(COUNT_DIGITS - 1 - decimals) {
        decimals += 1;
    }
    let mantissa = (value * 10_f64.powi(decimals)).round() as u64;
    put_decimal(out, count < 0, mantissa, decimals as usize);
}

/// Writes a decimal number: `number` in units of its last of `digits` decimals, and what stands behind it.
pub fn put_digits(out: &mut String, number: i64, rest: i64, digits: usize) {
    let more = more_digits(number, digits);
    let mantissa = number.unsigned_abs() * 10_u64.pow(more as u32) + rest.unsigned_abs();
    put_decimal(out, number < 0, mantissa, digits + more);
}

/// Writes `mantissa` times ten to the power of -`decimals` as C's `%g` does: without zeros at its end, and with an
/// exponent below 0.0001.
fn put_decimal(out: &mut String, negative: bool, mut mantissa: u64, mut decimals: usize) {
    while decimals > 0 && mantissa.is_multiple_of(10) && mantissa > 0 {
        (mantissa, decimals) = (mantissa / 10, decimals - 1);
    }
    if negative {
        out.push('-');
    }
    let text = mantissa.to_string();
    if mantissa == 0 || decimals == 0 {
        out.push_str(&text);
    } else if text.len() > decimals {
        let (whole, part) = text.split_at(text.len() - decimals);
        out.extend([whole, ".", part]);
    } else if decimals - text.len() > 3 {
        let (first, part) = text.split_at(1);
        out.push_str(first);
        if !part.is_empty() {
            out.extend([".", part]);
        }
        // Writing into a text does not fail.
        let _ = write!(out, "e-{:02}", decimals - text.len() + 1);
    } else {
        out.push_str("0.");
        out.extend(std::iter::repeat_n('0', decimals - text.len()));
        out.push_str(&text);
    }
}

/// What is left to be read.
struct Reader<'a>(&'a [u8]);

impl<'a> Reader<'a> {
    fn take(&mut self, count: usize) -> Option<&'a [u8]> {
        let (taken, rest) = self.0.split_at_checked(count)?;
        self.0 = rest;
        Some(taken)
    }

    fn number(&mut self) -> Option<usize> {
        let bytes = self.take(4)?.try_into().ok()?;
        Some(u32::from_le_bytes(bytes) as usize)
    }

    fn float(&mut self) -> Option<f64> {
        Some(f64::from_le_bytes(self.take(8)?.try_into().ok()?))
    }

    fn text(&mut self) -> Option<&'a str> {
        let length = self.number()?;
        std::str::from_utf8(self.take(length)?).ok()
    }

    /// Whole numbers: first the lowest bytes of all, then the next; the lowest bit is the sign.
    fn planes(&mut self, count: usize) -> Option<Vec<i64>> {
        let mut numbers = vec![0_u64; count];
        for plane in 0..PLANES {
            let bytes = self.take(count)?;
            for (number, byte) in numbers.iter_mut().zip(bytes) {
                *number |= u64::from(*byte) << (8 * plane);
            }
        }
        let signed = |n: u64| (n >> 1).cast_signed() ^ -(n & 1).cast_signed();
        Some(numbers.into_iter().map(signed).collect())
    }
}
