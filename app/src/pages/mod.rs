//! One file (or folder) per page. A new page is its file, its `mod` line and its line in [`registry`]:
//! tabs, links, tests and the state for tests follow from there.

mod backlash;
mod chart;
mod chart_axes;
mod chart_caption;
pub mod chart_cursor;
mod chart_keys;
pub mod chart_menu;
mod chart_reading;
pub mod chart_zoom;
mod compare;
mod controls;
mod explore;
mod lessons;
mod maps;
mod mystery;
mod playback;
mod start;
mod tune;
pub mod typed;

use hysteron_core::explore::ExploreInput;

use crate::export::Table;
use crate::hook::Targets;
use crate::language::Language;
use crate::layout::Side;
use crate::lessons::Study;
use crate::purpose::Purpose;
use crate::recent::{Recent, Recents};
use crate::save::Document;
use crate::theme::Look;
use crate::zoom::AllZooms;

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

/// All pages, in the order of their tabs; the first is in front when the app starts.
pub fn registry() -> Vec<Box<dyn View>> {
    vec![
        Box::<start::Start>::default(),
        Box::<lessons::Lessons>::default(),
        Box::<explore::Explore>::default(),
        Box::<maps::Maps>::default(),
        Box::<tune::Tune>::default(),
        Box::<compare::Compare>::default(),
        Box::<backlash::Backlash>::default(),
        Box::<mystery::Bench>::default(),
    ]
}

/// Whether a measurement of this name comes with the app.
pub fn is_built_in(name: &str) -> bool {
    compare::is_built_in(name) || backlash::is_built_in(name)
}

/// What the pages share.
#[derive(Default)]
pub struct Desk {
    /// The relay loop that they are about.
    pub relay_loop: ExploreInput,
    /// The lesson that stands beside them.
    pub study: Study,
    /// Files that were opened before.
    pub recent: Recents,
    /// What the experiment is for that one of them shows.
    pub purpose: Option<Box<Purpose>>,
    /// What of the plots is in view.
    pub zooms: AllZooms,
    /// How wide someone has made the panel beside the plots.
    pub side: Side,
    /// Where the buttons are.
    pub targets: Targets,
    /// What is to be done after this frame.
    pub commands: Vec<Command>,
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
