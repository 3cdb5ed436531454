//! A file that is being read.

use hysteron_work::content::Content;
use hysteron_work::reading::Reading;
use hysteron_work::tasks::ReadTask;

use super::awaited::Awaited;
use crate::files::Held;
use crate::jobs::Job;
use crate::recent::Recent;

/// A file that is being read.
pub(super) struct Opening {
    pub file: String,
    pub(super) content: Content,
    pub(super) reading: Reading,
    /// Where it is, if it can be opened again.
    pub(super) origin: Option<Recent>,
    /// What a link sets as soon as it is open.
    pub then: Option<Awaited>,
    /// Whether the form says what its columns are.
    pub(super) from_form: bool,
    pub(super) job: Job<ReadTask>,
}

impl Opening {
    /// A file that says itself what its columns are.
    pub fn new(ctx: &egui::Context, file: &str, content: Content) -> Self {
        Self::read_as(ctx, file, content, Reading::default())
    }

    /// The same, with what a link sets as soon as it is open.
    pub fn with(self, awaited: Awaited) -> Self {
        Self {
            then: Some(awaited),
            ..self
        }
    }

    /// A file that was open before.
    pub fn again(ctx: &egui::Context, file: Held) -> Self {
        Self::read_as(ctx, &file.name, file.content, file.reading)
    }

    pub(super) fn read_as(
        ctx: &egui::Context,
        file: &str,
        content: Content,
        reading: Reading,
    ) -> Self {
        let task = ReadTask {
            file: file.to_owned(),
            content: content.clone(),
            reading: reading.clone(),
        };
        Self {
            file: file.to_owned(),
            content,
            reading,
            origin: None,
            then: None,
            from_form: false,
            job: Job::run(ctx, task),
        }
    }
}
