//! How large the page is, and whether that is small enough.

use std::fs;
use std::path::{Path, PathBuf};

use miniz_oxide::deflate::compress_to_vec;

/// The most that a first visit may download with gzip, bytes: some seconds in a lecture hall's network.
const MOST: usize = 4_000_000;

/// What gzip adds to deflate, bytes.
const GZIP_FRAME: usize = 18;

/// Effort of the compression, as most hosts make it.
const LEVEL: u8 = 6;

/// Prints the size of every file in `dist`, raw and compressed.
///
/// # Errors
/// Where they are too large together, or cannot be read.
pub fn report(dist: &Path) -> Result<(), String> {
    let mut files = files(dist)?;
    files.sort();
    let (mut raw, mut packed) = (0, 0);
    println!("{:>12} {:>12}  file", "bytes", "gzip");
    for file in files {
        let bytes = fs::read(&file).map_err(|e| format!("{}: {e}", file.display()))?;
        let size = compress_to_vec(&bytes, LEVEL).len() + GZIP_FRAME;
        let name = file.strip_prefix(dist).unwrap_or(&file).display();
        println!("{:>12} {size:>12}  {name}", bytes.len());
        raw += bytes.len();
        packed += size;
    }
    println!("{raw:>12} {packed:>12}  together");
    if packed > MOST {
        return Err(format!(
            "the page is {packed} bytes compressed: it must be {MOST} at most"
        ));
    }
    Ok(())
}

fn files(folder: &Path) -> Result<Vec<PathBuf>, String> {
    let entries = fs::read_dir(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let mut files = Vec::new();
    for entry in entries.flatten() {
        let path = entry.path();
        if path.is_dir() {
            files.extend(self::files(&path)?);
        } else {
            files.push(path);
        }
    }
    Ok(files)
}
