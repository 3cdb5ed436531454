//! How far a long computation has come.

use crate::message::Message;

/// How far a job has come.
#[derive(Clone, Debug, PartialEq)]
pub enum Progress<T> {
    /// Not finished: share done, 0 to 1, and what it is doing, in plain words.
    Running {
        /// Share done, 0 to 1.
        fraction: f64,
        /// What it is doing, in plain words.
        text: Message,
    },
    /// Finished.
    Done(T),
}
