//! What a step of the tuning experiment is.

use hysteron_core::message::Message;
use hysteron_core::tuning::{TuningInput, TuningReport};

/// What a step shows.
#[derive(Clone, Copy)]
pub struct Seen<'a> {
    pub input: &'a TuningInput,
    pub report: &'a TuningReport,
    /// Whether the plot of the step stands in view above the rest, so that it is not drawn again.
    pub pinned: bool,
}

/// A step of the experiment: one file each.
pub struct Stage {
    /// Its name in tests.
    pub id: &'static str,
    /// What its button says.
    pub title: &'static str,
    pub question: &'static str,
    pub answer: fn(Seen<'_>) -> Message,
    /// What the next step does.
    pub next: &'static str,
    /// The plot that stays in view in a narrow window.
    pub plot: fn(&mut egui::Ui, Seen<'_>, f32),
    /// Draws it in about this height; may choose another rule.
    pub ui: fn(&mut egui::Ui, Seen<'_>, f32, &mut String),
}
