//! Packs the large built-in measurements, so that the page does not have to carry their text.
//!
//! Packed is a table by columns, an empty line between them: numbers of one column resemble each other more
//! than those of one row. A column of equal steps is written as `= step decimals rows`. `unpack` in
//! `pages/backlash/built_in.rs` is the way back, and its test holds that it gives the very file.

use std::path::Path;

/// Strongest compression of deflate.
const LEVEL: u8 = 9;

fn main() -> std::io::Result<()> {
    let out = std::env::var("OUT_DIR").map_err(std::io::Error::other)?;
    for name in ["drive-03", "drive-10"] {
        let csv = format!("../assets/measurements/{name}.csv");
        println!("cargo::rerun-if-changed={csv}");
        let text = std::fs::read_to_string(csv)?;
        let packed = miniz_oxide::deflate::compress_to_vec(by_columns(&text).as_bytes(), LEVEL);
        std::fs::write(Path::new(&out).join(format!("{name}.deflate")), packed)?;
    }
    Ok(())
}

fn by_columns(csv: &str) -> String {
    let mut lines = csv.lines();
    let head = lines.next().unwrap_or_default();
    let rows: Vec<Vec<&str>> = lines.map(|l| l.split(',').collect()).collect();
    let column = |i: usize| -> Vec<&str> { rows.iter().map(|r| r[i]).collect() };
    let columns = (0..head.split(',').count()).map(|i| packed(&column(i)));
    let parts: Vec<String> = std::iter::once(head.to_owned()).chain(columns).collect();
    parts.join("\n\n")
}

fn packed(column: &[&str]) -> String {
    equal_steps(column).unwrap_or_else(|| column.join("\n"))
}

/// A column of equal steps from 0, if it is one to the last character.
fn equal_steps(column: &[&str]) -> Option<String> {
    let second = column.get(1)?;
    let step: f64 = second.parse().ok()?;
    let decimals = second.split_once('.').map_or(0, |(_, d)| d.len());
    let same = |(i, text): (usize, &&str)| **text == format!("{:.decimals$}", i as f64 * step);
    let all = column.iter().enumerate().all(same);
    all.then(|| format!("= {step} {decimals} {}", column.len()))
}
