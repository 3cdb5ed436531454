//! The formula of what no effect explains: the search beside a page, and what it found.

use hysteron_core::diagnosis::Discovery;
use hysteron_core::effect::{EffectId, find};
use hysteron_core::message::Message;
use hysteron_work::tasks::DiscoveryTask;

use crate::jobs::Job;

/// A search beside the model with these effects, and how far it is.
pub(super) struct Searching {
    pub(super) effects: Vec<EffectId>,
    pub(super) job: Job<DiscoveryTask>,
    pub(super) progress: (f64, Message),
}

/// What is looked for, and what was found.
#[derive(Default)]
pub(super) struct Unknown {
    pub(super) searching: Option<Searching>,
    pub(super) found: Vec<(Vec<EffectId>, Discovery)>,
    /// Models beside which nothing is looked for unless it is asked for: someone cancelled it, or it failed.
    pub(super) left: Vec<Vec<EffectId>>,
}

impl Unknown {
    /// Whether it looks for a formula.
    pub fn is_busy(&self) -> bool {
        self.searching.is_some()
    }

    /// Stops looking beside another model than this: its own work goes first.
    pub fn follow(&mut self, effects: &[EffectId]) {
        self.searching.take_if(|s| s.effects != effects);
    }

    /// Forgets what was found beside effects of the user's own: their formulas have changed.
    pub fn forget_own(&mut self) {
        let library = |effects: &[EffectId]| effects.iter().all(|e| find(*e).is_some());
        self.searching.take_if(|s| !library(&s.effects));
        self.found.retain(|(effects, _)| library(effects));
        self.left.retain(|effects| library(effects));
    }

    /// What was found beside the model with these effects.
    pub fn beside(&self, effects: &[EffectId]) -> Option<&Discovery> {
        let found = self.found.iter().find(|(e, _)| e == effects);
        found.map(|(_, discovery)| discovery)
    }
}
