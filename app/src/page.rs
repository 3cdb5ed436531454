//! What a page is to the app around it.

use crate::command::Command;
use crate::desk::Desk;
use crate::export::Table;
use crate::recent::Recent;

/// A page.
pub trait View {
    /// Its name in links and tests.
    fn id(&self) -> &'static str;
    /// What its tab says.
    fn title(&self) -> &'static str;
    /// Takes in what its jobs have found; also called while another page is in front.
    fn update(&mut self, _ctx: &egui::Context) {}
    /// Draws it.
    fn ui(&mut self, ui: &mut egui::Ui, desk: &mut Desk);
    /// What is set on it, as a plain value: what links, undo and the autosave keep.
    fn settings(&self) -> serde_json::Value;
    /// Sets it; what cannot be is refused in one sentence.
    fn set(
        &mut self,
        ctx: &egui::Context,
        settings: &serde_json::Value,
        desk: &Desk,
    ) -> Result<(), String>;
    /// What it shows, for tests: an object, with `busy` while a job runs.
    fn hook_state(&self) -> serde_json::Value;
    /// The numbers behind what it shows, one table for each of [`Self::table_names`].
    fn tables(&self) -> Vec<Table> {
        Vec::new()
    }
    /// Names of the tables that it can give now.
    fn table_names(&self) -> Vec<&'static str> {
        Vec::new()
    }
    /// What to try next on it.
    fn hint(&self) -> Option<Hint> {
        None
    }
    /// Plays or pauses, if something moves on it.
    fn toggle_play(&mut self, _ctx: &egui::Context) {}
    /// Whether files can be opened on it.
    fn takes_files(&self) -> bool {
        false
    }
    /// What it does with a file that is held over the window.
    fn drop_hint(&self) -> &'static str {
        "Drop the measurement to compare it"
    }
    /// Files that the user has opened on it since the last call.
    fn opened(&mut self) -> Vec<Recent> {
        Vec::new()
    }
    /// Opens the bytes of a file.
    fn open(&mut self, _ctx: &egui::Context, _name: &str, _bytes: &[u8]) {}
    /// Asks for a file to open on it.
    fn open_dialog(&self, _ctx: &egui::Context) {}
    /// Opens a file that was dropped on the window.
    fn open_dropped(&mut self, _ctx: &egui::Context, _file: &egui::DroppedFileHandle) {}
}

/// What to try next: a sentence, and what does it at a press; some things only the user can do.
pub struct Hint {
    pub sentence: String,
    pub commands: Vec<Command>,
}

impl Hint {
    /// One that a link shows.
    pub fn open(sentence: &str, link: &str) -> Self {
        Self {
            sentence: sentence.to_owned(),
            commands: vec![Command::OpenLink(link.to_owned())],
        }
    }

    /// One that the app cannot do.
    pub fn say(sentence: impl Into<String>) -> Self {
        Self {
            sentence: sentence.into(),
            commands: Vec::new(),
        }
    }
}
