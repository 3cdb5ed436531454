//! The page comes to the numbers of the native program.

use serde_json::Value;

use crate::run::{PROGRAM, cargo, output, root};

/// Largest relative difference of an error.
const EQUAL: f64 = 1e-9;

/// Compares the errors of the baseline and of every effect on top of it, as the page has `shown` them for a
/// measurement, with those of the command line; `path` is from the root.
pub fn check(shown: &Value, path: &str) -> Result<(), String> {
    // An old one would come to other numbers. The app's tests bring the program along, and have been built: by itself
    // it would be built anew, with fewer features.
    cargo(&["test", "--workspace", "--test", "app", "--no-run"], None)?;
    let program = root().join("target/debug").join(PROGRAM);
    let arguments = ["diagnose", "--format", "json", path];
    let said = output(&program.to_string_lossy(), &arguments).ok_or("the command line failed")?;
    let native: Value = serde_json::from_str(&said).map_err(|e| e.to_string())?;
    let native = &native["steps"][0];
    let mut largest = difference(&native["error"], &shown["error"])?;
    let tried = native["candidates"].as_array().ok_or("no candidates")?;
    let page = shown["candidates"].as_array().ok_or("no candidates")?;
    for candidate in tried {
        let same = page.iter().find(|c| c["effects"] == candidate["effects"]);
        let same = same.ok_or_else(|| format!("the page did not try {}", candidate["effects"]))?;
        largest = largest.max(difference(&candidate["error"], &same["error"])?);
    }
    println!(
        "{} errors on {path}, native and web: they differ by {largest:e} at most",
        1 + tried.len()
    );
    if largest > EQUAL {
        return Err(format!(
            "native and web differ by {largest:e}, more than {EQUAL:e}"
        ));
    }
    Ok(())
}

/// Relative difference of two numbers.
fn difference(a: &Value, b: &Value) -> Result<f64, String> {
    match (a.as_f64(), b.as_f64()) {
        (Some(a), Some(b)) => Ok((a - b).abs() / a.abs()),
        _ => Err(format!("no number: {a} or {b}")),
    }
}
