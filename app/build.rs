//! Packs the large built-in measurements, so that the page does not have to carry their text.

use std::path::Path;

/// Strongest compression of deflate.
const LEVEL: u8 = 9;

fn main() -> std::io::Result<()> {
    let out = std::env::var("OUT_DIR").map_err(std::io::Error::other)?;
    for name in ["drive-03", "drive-10"] {
        let csv = format!("../assets/measurements/{name}.csv");
        println!("cargo::rerun-if-changed={csv}");
        let packed = miniz_oxide::deflate::compress_to_vec(&std::fs::read(csv)?, LEVEL);
        std::fs::write(Path::new(&out).join(format!("{name}.deflate")), packed)?;
    }
    Ok(())
}
