//! A file that does not say what its columns are, and what was chosen for them.

use hysteron_core::measurement::{FoundColumn, Kind};
use hysteron_core::message::Message;
use hysteron_work::content::Content;
use hysteron_work::reading::Reading;

use super::choice::Choice;
use crate::recent::Recent;

/// A file whose columns are to be understood.
pub struct Form {
    /// Its name.
    pub file: String,
    /// What is in it.
    pub content: Content,
    /// Where the file is, if it can be opened again.
    pub origin: Option<Recent>,
    /// Why it is asked.
    pub(super) reason: Message,
    pub(super) columns: Vec<FoundColumn>,
    /// What was chosen.
    pub choice: Choice,
    /// Why it cannot be read as was chosen, or why another file was refused meanwhile.
    pub error: Option<Message>,
}

impl Form {
    /// The form for a file that was refused for this `reason`, with these columns in it.
    pub fn new(
        file: String,
        content: Content,
        origin: Option<Recent>,
        reason: Message,
        columns: Vec<FoundColumn>,
    ) -> Self {
        Self {
            file,
            content,
            origin,
            reason,
            choice: Choice::likeliest(&columns),
            columns,
            error: None,
        }
    }

    /// The same with this kind of system chosen.
    pub fn of_kind(mut self, kind: Kind) -> Self {
        self.choice.kind = kind;
        self.choice.suit(&self.columns);
        self
    }

    /// The file as it was chosen to be read.
    pub fn reading(&self) -> Reading {
        self.choice.reading(&self.columns)
    }

    /// For tests.
    pub fn hook_state(&self) -> serde_json::Value {
        serde_json::json!({
            "file": self.file,
            "reason": self.reason,
            "missing": self.choice.missing(),
            "reading": self.reading(),
            "error": self.error,
        })
    }
}
