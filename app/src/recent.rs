//! Files that were opened before. Natively their paths are kept; a browser gives none, so that there the text
//! of small files is kept instead.

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD_NO_PAD as LETTERS;
use serde::{Deserialize, Serialize};

use crate::hook::Targets;
use crate::language::tr;
use hysteron_work::reading::Reading;

/// Files that are remembered.
const MOST: usize = 8;

/// Bytes of all texts that are kept: a browser has room for some five million. Where paths are kept there are hardly
/// any.
const MOST_BYTES: usize = 1_000_000;

/// A file that was opened before.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Recent {
    /// Its name.
    pub name: String,
    /// Where it is; empty in a browser.
    pub path: String,
    /// What was in it; empty where it can be read again.
    text: String,
    /// Whether it is no text, but stands there in base64.
    #[serde(default)]
    binary: bool,
    /// What it does not say itself.
    #[serde(default)]
    pub reading: Reading,
}

impl Recent {
    /// A file that was read.
    pub fn new(name: &str, path: &str, bytes: &[u8]) -> Self {
        let again = cfg!(not(target_arch = "wasm32")) && !path.is_empty();
        let (path, text, binary) = match str::from_utf8(bytes) {
            _ if again => (path, String::new(), false),
            Ok(text) => ("", text.to_owned(), false),
            Err(_) => ("", LETTERS.encode(bytes), true),
        };
        Self {
            name: name.to_owned(),
            path: path.to_owned(),
            text,
            binary,
            reading: Reading::default(),
        }
    }

    /// The same file, which is read so.
    pub fn read_as(self, reading: &Reading) -> Self {
        Self {
            reading: reading.clone(),
            ..self
        }
    }

    /// Its bytes.
    ///
    /// # Errors
    /// Why it cannot be read any more.
    pub fn read(&self) -> Result<Vec<u8>, String> {
        if self.binary {
            return LETTERS.decode(&self.text).map_err(|e| e.to_string());
        }
        if self.path.is_empty() {
            return Ok(self.text.clone().into_bytes());
        }
        std::fs::read(&self.path).map_err(|e| e.to_string())
    }
}

/// The files that were opened, the last one first.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Recents(Vec<Recent>);

impl Recents {
    /// Notes a file that was opened.
    pub fn note(&mut self, recent: Recent) {
        self.0
            .retain(|r| (&r.name, &r.path) != (&recent.name, &recent.path));
        self.0.insert(0, recent);
        self.0.truncate(MOST);
        // What is too large for the rest of the room makes way for what is not.
        let mut room = MOST_BYTES;
        self.0.retain(|r| {
            let left = room.checked_sub(r.text.len());
            room = left.unwrap_or(room);
            left.is_some()
        });
    }

    /// Draws a button for each whose name ends so; the one that was clicked.
    pub fn ui(
        &self,
        ui: &mut egui::Ui,
        ending: fn(&str) -> bool,
        targets: &mut Targets,
    ) -> Option<Recent> {
        let mut chosen = None;
        let shown: Vec<&Recent> = self.0.iter().filter(|r| ending(&r.name)).collect();
        if shown.is_empty() {
            return None;
        }
        ui.horizontal_wrapped(|ui| {
            ui.label(tr("Recent files:"));
            for recent in shown {
                let button = ui.button(&recent.name);
                targets.note(format!("recent:{}", recent.name), ui, &button);
                let button = if recent.path.is_empty() {
                    button
                } else {
                    button.on_hover_text(&recent.path)
                };
                if button.clicked() {
                    chosen = Some(recent.clone());
                }
            }
        });
        chosen
    }
}

/// Whether a file of this name may be a measurement.
pub fn measurement(name: &str) -> bool {
    !name.to_ascii_lowercase().ends_with(".toml")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_file_comes_first_and_once() {
        let mut recents = Recents::default();
        for name in ["a.csv", "b.csv", "a.csv"] {
            recents.note(Recent::new(name, "", b"t [s]"));
        }
        let names: Vec<&str> = recents.0.iter().map(|r| r.name.as_str()).collect();
        assert_eq!(names, ["a.csv", "b.csv"]);
        assert_eq!(recents.0[0].read(), Ok(b"t [s]".to_vec()));
        for i in 0..20 {
            recents.note(Recent::new(&i.to_string(), "", b""));
        }
        assert_eq!(recents.0.len(), MOST);
    }

    #[test]
    fn a_file_too_large_to_be_kept_drops_no_other() {
        let mut recents = Recents::default();
        let large = vec![b'0'; MOST_BYTES + 1];
        for (name, bytes) in [
            ("a.csv", b"t [s]".as_slice()),
            ("large.csv", &large),
            ("b.csv", b"t [s]"),
        ] {
            recents.note(Recent::new(name, "", bytes));
        }
        let names: Vec<&str> = recents.0.iter().map(|r| r.name.as_str()).collect();
        assert_eq!(names, ["b.csv", "a.csv"]);
    }

    #[test]
    fn what_is_no_text_comes_back_as_it_was() {
        let bytes = [b"MATLAB 5.0".as_slice(), &[0, 255, 128]].concat();
        let reading = Reading {
            map: "t=time [s]".to_owned(),
            ..Reading::default()
        };
        let recent = Recent::new("x.mat", "", &bytes).read_as(&reading);
        let kept = serde_json::to_string(&recent).expect("JSON");
        let again: Recent = serde_json::from_str(&kept).expect("the same");
        assert_eq!((again.read(), &again.reading), (Ok(bytes), &reading));
        // As it was kept before there was a mapping.
        let old = r#"{"name":"a.csv","path":"","text":"t [s]"}"#;
        let old: Recent = serde_json::from_str(old).expect("a file");
        assert_eq!(old, Recent::new("a.csv", "", b"t [s]"));
    }

    #[test]
    fn a_file_with_a_path_is_read_again_from_there() {
        let recent = Recent::new("x.csv", "/nowhere/x.csv", b"t [s]");
        assert!(recent.text.is_empty());
        assert!(recent.read().is_err(), "it is not there");
    }
}
