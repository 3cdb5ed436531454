//! What an experiment that a page was opened with is for.

use hysteron_core::message::Message;

/// An experiment on a page.
#[derive(Clone, Debug, PartialEq)]
pub struct Purpose {
    /// Id of the page that shows it.
    pub page: &'static str,
    /// What it is for.
    pub sentence: Message,
    /// Id of the page that it comes from, and what goes there.
    pub from: (&'static str, &'static str),
}
