//! What follows from what is set, computed anew while that changes.

use hysteron_core::message::Message;
use hysteron_work::tasks::Task;

use crate::jobs::{Job, Runs, ended};

/// The last result for an input, and the job for the next: one that is dragged shows every result that could be
/// computed meanwhile.
pub struct Live<I, T: Task> {
    /// Input of the job that runs or ran last.
    asked: Option<I>,
    job: Option<Job<T>>,
    /// The last result; it stays while the next is computed.
    shown: Option<(I, Box<T::Report>)>,
    /// Why the last job came to none.
    message: Option<Message>,
}

impl<I, T: Task> Default for Live<I, T> {
    fn default() -> Self {
        Self {
            asked: None,
            job: None,
            shown: None,
            message: None,
        }
    }
}

impl<I: Clone + PartialEq, T: Runs> Live<I, T> {
    /// Takes what the job has brought.
    pub fn update(&mut self) {
        match (ended(&mut self.job, |_, _| ()), &self.asked) {
            (Some(Ok(report)), Some(asked)) => {
                self.shown = Some((asked.clone(), Box::new(report)));
                self.message = None;
            }
            (Some(Err(text)), _) => self.message = Some(text),
            _ => {}
        }
    }

    /// Computes anew where the input is another one and nothing is computed.
    pub fn ask(&mut self, ctx: &egui::Context, input: &I, task: impl FnOnce(I) -> T) {
        if self.job.is_none() && self.asked.as_ref() != Some(input) {
            self.asked = Some(input.clone());
            self.job = Some(Job::run(ctx, task(input.clone())));
        }
    }

    /// The last result, and what it is of.
    pub fn shown(&self) -> Option<(&I, &T::Report)> {
        self.shown
            .as_ref()
            .map(|(input, report)| (input, &**report))
    }

    pub fn is_busy(&self) -> bool {
        self.job.is_some()
    }

    /// Whether another result than the one that is shown is being computed.
    pub fn is_of_before(&self) -> bool {
        let shown = self.shown.as_ref().map(|(input, _)| input);
        self.is_busy() && self.asked.as_ref() != shown
    }

    pub fn message(&self) -> Option<&Message> {
        self.message.as_ref()
    }
}
