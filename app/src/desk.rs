//! What the pages share.

use hysteron_core::explore::ExploreInput;

use crate::command::Command;
use crate::hook::Targets;
use crate::layout::Side;
use crate::lessons::Study;
use crate::purpose::Purpose;
use crate::recent::Recents;
use crate::zoom::AllZooms;

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
    /// Whether to play or to pause was asked for: the page in front takes it, if something moves on it.
    pub play: bool,
    /// What is to be done after this frame.
    pub commands: Vec<Command>,
}
