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

use crate::page::Page;

/// All pages, in the order of their tabs; the first is in front when the app starts.
pub fn registry() -> Vec<Page> {
    vec![
        start::page(),
        lessons::page(),
        explore::page(),
        maps::page(),
        tune::page(),
        compare::page(),
        backlash::page(),
        mystery::page(),
    ]
}
