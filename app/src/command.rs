//! What is asked of the app as a whole.

use hysteron_core::explore::ExploreInput;

use crate::language::Language;
use crate::purpose::Purpose;
use crate::save::Document;
use crate::theme::Look;

/// What a page asks of the app; carried out once, after drawing.
#[derive(Clone, Debug, PartialEq)]
pub enum Command {
    /// Brings the page with this id to the front.
    Go(&'static str),
    /// Sets the loop that the pages are about.
    SetLoop(Box<ExploreInput>),
    /// Says what the experiment that was just set is for, or no more.
    SetPurpose(Option<Box<Purpose>>),
    /// Sets one field of what is set on the page with this id.
    Set(&'static str, &'static str, serde_json::Value),
    /// Puts the link to what is on the screen on the clipboard.
    CopyLink,
    /// Puts another link on the clipboard, and says so.
    CopyOther {
        /// What stands behind `#`.
        link: String,
        /// What is said.
        saying: &'static str,
    },
    /// Lets the user save a file.
    Save(Box<Document>),
    /// Opens the bytes of a file on the page with this id, and brings it to the front.
    OpenFile(&'static str, String, Vec<u8>),
    /// Asks for a file, on the page in front if it takes one.
    AskForFile,
    /// Takes the last change back, or does it again.
    Undo,
    Redo,
    /// Puts this page back to what it is when nothing was touched.
    Reset,
    /// Plays or pauses.
    Play,
    /// Opens the lesson with this id, or closes the one that is open.
    Lesson(Option<String>),
    /// Checks the question of the lesson.
    Check,
    /// Saves the page as a picture of lines or of pixels, or a table of its numbers.
    SaveSvg,
    SavePng,
    SaveTable(&'static str),
    /// Changes how the app looks.
    NextLook,
    SetLook(Look),
    /// Speaks this language.
    Speak(Language),
    /// Lets nothing move by itself, or lets it.
    Calm(bool),
    /// Shows or hides the sheet with the keys.
    Sheet,
    /// Closes what lies over the page.
    Close,
    /// Shows what a link says.
    OpenLink(String),
}
