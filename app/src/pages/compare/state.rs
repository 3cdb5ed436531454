//! What is set on the page, what is known of it, and what runs.

use std::collections::{HashMap, HashSet};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};

use hysteron_core::diagnosis::{Limits, StepReport};
use hysteron_core::effect::EffectId;
use hysteron_core::measurement::Measurement;
use hysteron_core::message::Message;
use hysteron_core::user_model::UserModel;
use hysteron_work::reading::Reading;
use hysteron_work::tasks::{ExperimentTask, Source};

use super::by_hand::Hand;
use super::formula::Typed;
use super::hints::Guess;
use super::look::Look;
use super::opening::Opening;
use super::parts::{Part, Parts};
use super::sealed::Sealed;
use super::unknown::Unknown;
use crate::files::Files;
use crate::jobs::Job;
use crate::widgets::columns::Form;

/// The page.
pub struct Compare {
    pub(super) measurement: Option<Arc<Measurement>>,
    /// What its file does not say itself.
    pub(super) reading: Reading,
    /// The form for a file that is not open yet.
    pub(super) form: Option<Form>,
    pub(super) source: Source,
    /// The file that is being read.
    pub(super) opening: Option<Opening>,
    /// What the user knows of the model.
    pub(super) model: Option<UserModel>,
    /// The file that says it.
    pub(super) model_file: Option<String>,
    /// Effects of the user's own that were added here, as the command line takes them.
    pub(super) own: Vec<String>,
    /// The formula in the editor.
    pub(super) typed: Option<Typed>,
    /// Effects on top of the baseline, in the order in which they were added.
    pub(super) effects: Vec<EffectId>,
    /// Finished steps by their effects, so that undo is instant.
    pub(super) reports: HashMap<Vec<EffectId>, StepReport>,
    /// Effects of the step on screen: the last one finished.
    pub(super) shown: Option<Vec<EffectId>>,
    /// How much of it is there.
    pub(super) parts: Parts,
    pub(super) job: Option<Job>,
    pub(super) progress: (f64, Message),
    pub(super) message: Option<Message>,
    /// Effects that were taken back, the next one to come again first.
    pub(super) undone: Vec<EffectId>,
    /// What the plots show, and whether beside the step before.
    pub(super) look: Look,
    pub(super) before: bool,
    /// The effect whose fingerprint is shown; the likeliest if it is none of those.
    pub(super) fingerprint: Option<EffectId>,
    /// Limits of the next experiment that are being set.
    pub(super) limits: Option<Limits>,
    /// A search within other limits: for which model, and the number of the proposal.
    pub(super) search: Option<(Vec<EffectId>, usize, Job<ExperimentTask>)>,
    /// Formulas of what no effect explains.
    pub(super) unknown: Unknown,
    /// A step of the way that is computed beside: a link brings the last one alone.
    pub(super) earlier: Option<(Vec<EffectId>, Job)>,
    /// Steps of the way that cannot be computed.
    pub(super) lost: HashSet<Vec<EffectId>>,
    /// Whether the student guesses before anything is told, and what has been told.
    pub(super) guess_first: bool,
    pub(super) guess: Guess,
    /// Values that are set by hand.
    pub(super) hand: Option<Hand>,
    /// The finding that is shaded.
    pub(super) finding: usize,
    /// The truth that came with the measurement, sealed.
    pub(super) sealed: Option<Sealed>,
    pub(super) files: Files,
    /// What saving a file has to say.
    pub(super) saved: (Sender<Message>, Receiver<Message>),
}

impl Default for Compare {
    fn default() -> Self {
        Self {
            measurement: None,
            reading: Reading::default(),
            form: None,
            source: Source::default(),
            opening: None,
            model: None,
            model_file: None,
            own: Vec::new(),
            typed: None,
            effects: Vec::new(),
            reports: HashMap::new(),
            shown: None,
            parts: Parts::default(),
            job: None,
            progress: (0.0, Message::default()),
            message: None,
            undone: Vec::new(),
            look: Look::default(),
            before: false,
            fingerprint: None,
            limits: None,
            search: None,
            unknown: Unknown::default(),
            earlier: None,
            lost: HashSet::new(),
            guess_first: false,
            guess: Guess::default(),
            hand: None,
            finding: 0,
            sealed: None,
            files: Files::default(),
            saved: channel(),
        }
    }
}

impl Compare {
    /// The step on screen.
    pub(super) fn report(&self) -> Option<&StepReport> {
        self.reports.get(self.shown.as_ref()?)
    }

    /// Closes the measurement; what was open before can be gone back to.
    pub(super) fn close(&mut self) {
        let files = std::mem::take(&mut self.files);
        *self = Self {
            files,
            ..Self::default()
        };
    }

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
