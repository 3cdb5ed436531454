//! A model whose values someone sets, and what it says.

use hysteron_core::by_hand::{ByHand, HandReplay};
use hysteron_core::effect::EffectId;
use hysteron_work::tasks::HandTask;

use crate::jobs::Job;

/// A model with values that someone sets.
pub(super) struct Hand {
    /// Effects of the step whose values they are.
    pub effects: Vec<EffectId>,
    /// In the order of its parameters.
    pub values: Vec<f64>,
    /// Whether a slider is held.
    pub held: bool,
    /// The model on the samples in view, from the first to before the last; none where it cannot be set by hand.
    pub near: Option<(ByHand, (usize, usize))>,
    /// What it says there, or of the whole record once that is there.
    pub replay: Option<HandReplay>,
    /// The samples that have it.
    pub samples: (usize, usize),
    /// Whether it is of the whole record, with states that suit the values.
    pub exact: bool,
    /// The replay of the whole record, while it is under way.
    pub job: Option<Job<HandTask>>,
}

impl Hand {
    /// Whether the whole record is being replayed.
    pub fn is_busy(&self) -> bool {
        self.job.is_some()
    }
}
