//! Where an input goes in.

use hysteron_core::measurement::{ImportOptions, columns, guess, import};
use hysteron_core::scenario::Scenario;
use hysteron_core::user_model::UserModel;
use serde_json::json;

use hysteron_work::link;

/// What an input is meant to be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Door {
    Csv,
    Mat,
    Hdf5,
    Json,
    Log,
    Scenario,
    Model,
    Link,
}

impl Door {
    pub const ALL: [Self; 8] = [
        Self::Csv,
        Self::Mat,
        Self::Hdf5,
        Self::Json,
        Self::Log,
        Self::Scenario,
        Self::Model,
        Self::Link,
    ];

    /// Its name in sentences.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Csv => "CSV",
            Self::Mat => "MAT",
            Self::Hdf5 => "HDF5",
            Self::Json => "JSON",
            Self::Log => "logs",
            Self::Scenario => "scenarios",
            Self::Model => "model files",
            Self::Link => "links",
        }
    }
}

/// Reads an input; the words in which it was refused, if they are not one line.
pub fn read(door: Door, bytes: &[u8]) -> Option<String> {
    let text = String::from_utf8_lossy(bytes);
    let said = match door {
        Door::Csv | Door::Mat | Door::Hdf5 | Door::Json | Door::Log => measured(bytes),
        Door::Scenario => Scenario::from_toml(&text).err().map(|e| e.to_string()),
        Door::Model => UserModel::from_toml(&text).err().map(|e| e.to_string()),
        Door::Link => link::read(&text, &defaults()).err().map(|e| e.to_string()),
    }?;
    let wrong = said.trim().is_empty() || said.contains(char::is_control);
    wrong.then_some(said)
}

fn measured(bytes: &[u8]) -> Option<String> {
    if let Ok(found) = columns("input", bytes) {
        let _ = guess(&found);
    }
    let error = import("input", bytes, &ImportOptions::default()).err()?;
    Some(error.to_string())
}

/// Settings that a link may change.
fn defaults() -> serde_json::Value {
    json!({
        "loop": { "relay": { "gain": 1.0, "hysteresis": 0.1 }, "plant": { "denominator": [1.0, 3.0, 3.0, 1.0] } },
        "explore": { "margin": false, "view": "nyquist" },
    })
}
