//! The sealed truth of a mystery, and what was revealed of it.

use hysteron_core::effect::EffectId;
use hysteron_core::message::Message;
use hysteron_core::mystery::Reveal;
use hysteron_work::tasks::RevealTask;

use crate::jobs::{Job, ended};

/// A sealed truth that came with the measurement, and what was revealed of it.
#[derive(Default)]
pub(super) struct Sealed {
    pub(super) seal: Vec<u8>,
    /// The measurement as a text for a link, where it came in one.
    pub link: Option<String>,
    pub word: String,
    /// Whether the word can be read while it is typed.
    pub legible: bool,
    pub(super) job: Option<Job<RevealTask>>,
    pub(super) message: Option<Message>,
    /// The truth beside the model with these effects.
    pub(super) revealed: Option<(Vec<EffectId>, Reveal)>,
}

impl Sealed {
    pub fn new(seal: Vec<u8>) -> Self {
        Self {
            seal,
            ..Self::default()
        }
    }

    /// For tests.
    pub fn hook_state(&self, points: Option<f64>) -> serde_json::Value {
        serde_json::json!({
            "busy": self.job.is_some(),
            "message": self.message,
            "points": points,
        })
    }

    /// Whether the truth has been seen.
    pub fn is_revealed(&self) -> bool {
        self.revealed.is_some()
    }

    pub fn is_busy(&self) -> bool {
        self.job.is_some()
    }

    /// Takes what the job has found.
    pub fn update(&mut self, shown: &[EffectId]) {
        match ended(&mut self.job, |_, _| ()) {
            Some(Ok(reveal)) => self.revealed = Some((shown.to_vec(), reveal)),
            Some(Err(text)) => self.message = Some(text),
            None => {}
        }
    }
}
