//! A new step comes onto the screen part by part, a frame for each: what all of it takes at once, a browser feels.

use hysteron_core::effect::EffectId;

/// What follows the answer, in this order.
#[derive(Clone, Copy)]
pub(super) enum Part {
    Plots,
    /// What could be added.
    List,
    Parameters,
}

/// What each part shows.
#[derive(Default)]
pub(super) struct Parts {
    /// Effects of its step.
    pub(super) steps: [Option<Vec<EffectId>>; 3],
    /// Whether the measurement came in this frame, which has its job to start.
    pub fresh: bool,
}
