//! One file (or folder) per page. A new page is its file, its `mod` line and its line in [`registry`]:
//! tabs, links, tests and the state for tests follow from there.

mod backlash;
mod chart;
mod compare;
mod controls;
mod explore;
mod maps;
mod tune;

use hysteron_core::explore::ExploreInput;

use crate::hook::Targets;

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
    /// What it shows, for tests: an object, with `busy` while a job runs.
    fn hook_state(&self) -> serde_json::Value;
    /// Whether files can be opened on it.
    fn takes_files(&self) -> bool {
        false
    }
    /// Opens the bytes of a file.
    fn open(&mut self, _ctx: &egui::Context, _name: &str, _bytes: &[u8]) {}
    /// Opens a file that was dropped on the window.
    fn open_dropped(&mut self, _ctx: &egui::Context, _file: &egui::DroppedFileHandle) {}
}

/// All pages, in the order of their tabs; the first is in front when the app starts.
pub fn registry() -> Vec<Box<dyn View>> {
    vec![
        Box::<explore::Explore>::default(),
        Box::<maps::Maps>::default(),
        Box::<tune::Tune>::default(),
        Box::<compare::Compare>::default(),
        Box::<backlash::Backlash>::default(),
    ]
}

/// What the pages share.
#[derive(Default)]
pub struct Desk {
    /// The relay loop that they are about.
    pub relay_loop: ExploreInput,
    /// Where the buttons are.
    pub targets: Targets,
    /// What is to be done after this frame.
    pub commands: Vec<Command>,
}

/// What a page asks of the app; carried out once, after drawing.
#[derive(Clone, Debug, PartialEq)]
pub enum Command {
    /// Brings the page with this id to the front.
    Go(&'static str),
    /// Sets the loop that the pages are about.
    SetLoop(Box<ExploreInput>),
}
