//! How a measurement is read from a file.

use std::path::Path;

use hysteron_core::measurement::{ImportOptions, Measurement, import};

/// The measurement and the bytes that it was read from; else one line that says what is wrong with it.
pub fn read(path: &Path, options: &ImportOptions) -> Result<(Measurement, Vec<u8>), String> {
    let name = path
        .file_name()
        .unwrap_or(path.as_os_str())
        .to_string_lossy();
    let shown = path.display();
    if path.is_dir() {
        return Err(format!(
            "{shown} is a directory; expected a CSV or MATLAB file"
        ));
    }
    let bytes = std::fs::read(path).map_err(|e| format!("{shown} cannot be read: {e}"))?;
    let measurement = import(&name, &bytes, options).map_err(|e| e.to_string())?;
    Ok((measurement, bytes))
}
