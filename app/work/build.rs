//! Packs the built-in measurements, so that the page does not have to carry their text: see `src/packed.rs`, whose
//! `unpack` is the way back. What it gives is compared with the file here, to the last byte.

use std::f64::consts::TAU;
use std::io::{Error, Result};
use std::path::Path;

#[path = "src/packed.rs"]
mod packed;

use packed::{Kind, PLANES, more_digits, put_count, put_digits, unpack};

/// Strongest compression of deflate.
const LEVEL: u8 = 10;

/// Resolutions of encoders, as powers of two in a turn.
const TURNS: std::ops::RangeInclusive<i32> = 8..=26;

/// Significant digits of what was measured.
const DIGITS: std::ops::RangeInclusive<usize> = 3..=9;

const NAMES: [&str; 6] = [
    "drive-02",
    "drive-03",
    "drive-10",
    "drive-12",
    "drive-15",
    "process-02",
];

fn main() -> Result<()> {
    println!("cargo::rerun-if-changed=src/packed.rs");
    let out = std::env::var("OUT_DIR").map_err(Error::other)?;
    for name in NAMES {
        let csv = format!("../../assets/measurements/{name}.csv");
        println!("cargo::rerun-if-changed={csv}");
        let text = std::fs::read_to_string(csv)?;
        let packed = miniz_oxide::deflate::compress_to_vec(&table(&text)?, LEVEL);
        if unpack(&packed).as_deref() != Some(text.as_bytes()) {
            return Err(Error::other(format!("{name} does not come out as it was")));
        }
        std::fs::write(Path::new(&out).join(format!("{name}.packed")), packed)?;
    }
    Ok(())
}

/// A table by columns.
fn table(csv: &str) -> Result<Vec<u8>> {
    let mut lines = csv.lines();
    let head = lines.next().unwrap_or_default();
    let rows: Vec<Vec<&str>> = lines.map(|l| l.split(',').collect()).collect();
    let mut bytes = Vec::new();
    put_text(&mut bytes, head)?;
    put_number(&mut bytes, rows.len())?;
    for i in 0..head.split(',').count() {
        let fields: Option<Vec<&str>> = rows.iter().map(|r| r.get(i).copied()).collect();
        let fields = fields.ok_or_else(|| Error::other("a row is too short"))?;
        bytes.extend(column(&fields)?);
    }
    Ok(bytes)
}

/// A column in the way that takes the least room.
fn column(fields: &[&str]) -> Result<Vec<u8>> {
    let mut kinds = vec![Kind::Text];
    kinds.extend(equal_steps(fields));
    kinds.extend(DIGITS.map(Kind::Digits));
    kinds.extend(TURNS.map(|bits| Kind::Counts {
        resolution: TAU / 2_f64.powi(bits),
    }));
    let mut best: Option<(usize, Vec<u8>)> = None;
    for kind in kinds {
        let Some(bytes) = column_as(fields, kind)? else {
            continue;
        };
        let size = miniz_oxide::deflate::compress_to_vec(&bytes, 1).len();
        if best.as_ref().is_none_or(|(least, _)| size < *least) {
            best = Some((size, bytes));
        }
    }
    best.map(|(_, bytes)| bytes)
        .ok_or_else(|| Error::other("a column cannot be packed"))
}

/// Equal steps from 0, if the column has them to the last character.
fn equal_steps(fields: &[&str]) -> Option<Kind> {
    let second = fields.get(1)?;
    let step: f64 = second.parse().ok()?;
    let decimals = second.split_once('.').map_or(0, |(_, d)| d.len());
    let same = |(i, text): (usize, &&str)| **text == format!("{:.decimals$}", i as f64 * step);
    let all = fields.iter().enumerate().all(same);
    all.then_some(Kind::Steps { step, decimals })
}

/// The column in one way; nothing where that fits too few fields.
fn column_as(fields: &[&str], kind: Kind) -> Result<Option<Vec<u8>>> {
    let mut bytes = Vec::new();
    let (mut numbers, mut more, mut exceptions) = (Vec::new(), Vec::new(), Vec::new());
    match kind {
        Kind::Text => {
            put_number(&mut bytes, 0)?;
            put_text(&mut bytes, &fields.join("\n"))?;
            return Ok(Some(bytes));
        }
        Kind::Steps { step, decimals } => {
            put_number(&mut bytes, 1)?;
            bytes.extend(step.to_le_bytes());
            put_number(&mut bytes, decimals)?;
            return Ok(Some(bytes));
        }
        Kind::Counts { .. } | Kind::Digits(_) => {}
    }
    for (row, field) in fields.iter().enumerate() {
        let Ok(value) = field.parse::<f64>() else {
            return Ok(None);
        };
        let mut text = String::new();
        match kind {
            Kind::Counts { resolution } => {
                let count = (value / resolution).round() as i64;
                put_count(&mut text, count, resolution);
                numbers.push(count);
            }
            Kind::Digits(digits) => {
                let (number, rest) = split(value, digits);
                put_digits(&mut text, number, rest, digits);
                numbers.push(number);
                if more_digits(number, digits) > 0 {
                    more.push(rest);
                }
            }
            Kind::Text | Kind::Steps { .. } => {}
        }
        if text != *field {
            exceptions.push((row, *field));
        }
    }
    if exceptions.len() > fields.len() / 50 {
        return Ok(None);
    }
    match kind {
        Kind::Counts { resolution } => {
            put_number(&mut bytes, 2)?;
            bytes.extend(resolution.to_le_bytes());
        }
        Kind::Digits(digits) => {
            put_number(&mut bytes, 3)?;
            put_number(&mut bytes, digits)?;
            put_number(&mut bytes, more.len())?;
            put_planes(&mut bytes, &more);
        }
        Kind::Text | Kind::Steps { .. } => {}
    }
    put_planes(&mut bytes, &twice_differenced(&numbers));
    put_number(&mut bytes, exceptions.len())?;
    for (row, field) in exceptions {
        put_number(&mut bytes, row)?;
        put_text(&mut bytes, field)?;
    }
    Ok(Some(bytes))
}

/// A number in units of its last of `digits` decimals, and what stands behind it.
fn split(value: f64, digits: usize) -> (i64, i64) {
    // The least that is not lost by rounding, of a number of any size.
    let scaled = value.abs() * ten(digits);
    let whole = (scaled * (1.0 + 2.0 * f64::EPSILON) + 1e-9).floor();
    let number = whole as i64 * value.signum() as i64;
    let more = more_digits(number, digits);
    if more == 0 {
        // Nothing is kept behind it.
        return (number, 0);
    }
    let all = (value.abs() * ten(digits + more)).round();
    (number, (all - whole * ten(more)) as i64)
}

/// A power of ten.
fn ten(power: usize) -> f64 {
    (0..power).fold(1.0, |product, _| 10.0 * product)
}

fn twice_differenced(numbers: &[i64]) -> Vec<i64> {
    let at = |i: usize, back: usize| i.checked_sub(back).map_or(0, |i| numbers[i]);
    let second = |i: usize| at(i, 0) - 2 * at(i, 1) + at(i, 2);
    (0..numbers.len()).map(second).collect()
}

fn put_number(bytes: &mut Vec<u8>, number: usize) -> Result<()> {
    bytes.extend(u32::try_from(number).map_err(Error::other)?.to_le_bytes());
    Ok(())
}

fn put_text(bytes: &mut Vec<u8>, text: &str) -> Result<()> {
    put_number(bytes, text.len())?;
    bytes.extend(text.as_bytes());
    Ok(())
}

fn put_planes(bytes: &mut Vec<u8>, numbers: &[i64]) {
    let unsigned = |n: &i64| (n << 1 ^ (n >> 63)) as u64;
    for plane in 0..PLANES {
        bytes.extend(numbers.iter().map(|n| (unsigned(n) >> (8 * plane)) as u8));
    }
}
