//! How a measurement is read from a file.

use std::path::Path;

use hysteron_core::measurement::{ImportOptions, Measurement, import};
use hysteron_core::message::Message;
use hysteron_core::msg;

/// A path as it is said.
pub fn shown(path: &Path) -> Message {
    Message::name(path.display().to_string())
}

/// What is in a file; else one line that says why it cannot be read.
pub fn bytes_of(path: &Path) -> Result<Vec<u8>, Message> {
    std::fs::read(path).map_err(|e| {
        msg!(
            "{} cannot be read: {}",
            shown(path),
            Message::name(e.to_string())
        )
    })
}

/// The measurement and the bytes that it was read from; else one line that says what is wrong with it.
pub fn read(path: &Path, options: &ImportOptions) -> Result<(Measurement, Vec<u8>), Message> {
    let name = path
        .file_name()
        .unwrap_or(path.as_os_str())
        .to_string_lossy();
    if path.is_dir() {
        return Err(msg!(
            "{} is a directory; expected a CSV or MATLAB file",
            shown(path)
        ));
    }
    let bytes = bytes_of(path)?;
    let measurement = import(&name, &bytes, options).map_err(Message::from)?;
    Ok((measurement, bytes))
}
