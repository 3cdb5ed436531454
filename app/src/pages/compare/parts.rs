//! A new step comes onto the screen part by part, a frame for each: what all of it takes at once, a browser feels.

use hysteron_core::diagnosis::StepReport;
use hysteron_core::effect::EffectId;

use super::Compare;

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
    steps: [Option<Vec<EffectId>>; 3],
    /// Whether the measurement came in this frame, which has its job to start.
    pub fresh: bool,
}

impl Compare {
    /// The step that a part shows.
    pub(super) fn report_in(&self, part: Part) -> Option<&StepReport> {
        self.reports.get(self.parts.steps[part as usize].as_ref()?)
    }

    /// Whether a part is still to follow the step on screen.
    pub(super) fn is_behind(&self) -> bool {
        self.parts.fresh || self.parts.steps.iter().any(|part| *part != self.shown)
    }

    /// Lets all parts follow: the step was on the screen before.
    pub(super) fn follow_at_once(&mut self) {
        self.parts.steps.fill(self.shown.clone());
    }

    /// Lets the next part follow.
    pub(super) fn follow(&mut self, ctx: &egui::Context) {
        if ctx.current_pass_index() > 0 {
            // The same frame is laid out again.
            return;
        }
        self.parts.fresh = false;
        let shown = &self.shown;
        if let Some(part) = self.parts.steps.iter_mut().find(|part| *part != shown) {
            part.clone_from(shown);
        }
    }
}
