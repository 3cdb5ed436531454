//! One file (or folder) per page. A new page is its file, a line in [`Page`] and a line in the app's match.

mod compare;
mod explore;
mod maps;

use hysteron_core::explore::ExploreInput;

pub use compare::Compare;
pub use explore::Explore;
pub use maps::Maps;

/// The pages.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Page {
    /// A relay loop, live.
    #[default]
    Explore,
    /// Its cycles over two parameters.
    Maps,
    /// A model against a measurement.
    Compare,
}

impl Page {
    /// All of them, in the order of their tabs.
    pub const ALL: [Self; 3] = [Self::Explore, Self::Maps, Self::Compare];

    /// Its name in links and tests.
    pub fn id(self) -> &'static str {
        match self {
            Self::Explore => "explore",
            Self::Maps => "maps",
            Self::Compare => "compare",
        }
    }

    /// What its tab says.
    pub fn title(self) -> &'static str {
        match self {
            Self::Explore => "Explore a relay loop",
            Self::Maps => "Parameter maps",
            Self::Compare => "Compare a measurement",
        }
    }
}

/// What a page asks of the app; carried out once, after drawing.
#[derive(Clone, Debug, PartialEq)]
pub enum Command {
    /// Brings a page to the front.
    Go(Page),
    /// Sets the loop that *Explore* shows.
    SetLoop(Box<ExploreInput>),
}
