//! How a measurement is read from a file.

use std::path::Path;

use hysteron_core::measurement::{ImportOptions, Measurement, import};
use hysteron_core::message::Message;
use hysteron_core::msg;

/// The measurement and the bytes that it was read from; else one line that says what is wrong with it.
pub fn read(path: &Path, options: &ImportOptions) -> Result<(Measurement, Vec<u8>), Message> {
    let name = path
        .file_name()
        .unwrap_or(path.as_os_str())
        .to_string_lossy();
    let shown = path.display();
    if path.is_dir() {
        return Err(msg!(
            "{} is a directory; expected a CSV or MATLAB file",
            Message::name(shown.to_string())
        ));
    }
    let bytes = std::fs::read(path).map_err(|e| {
        msg!(
            "{} cannot be read: {}",
            Message::name(shown.to_string()),
            Message::name(e.to_string())
        )
    })?;
    let measurement = import(&name, &bytes, options).map_err(Message::from)?;
    Ok((measurement, bytes))
}
