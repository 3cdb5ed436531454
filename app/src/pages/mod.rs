//! One folder per page. A new page is its folder, its `mod` line and its line in [`registry`]:
//! tabs, links, tests and the state for tests follow from there.

mod backlash;
mod compare;
mod explore;
mod lessons;
mod maps;
mod mystery;
mod start;
mod tune;

use crate::page::View;

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
