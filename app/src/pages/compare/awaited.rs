//! What is set on the page, as a plain value, and what it names.

use hysteron_core::effect::{self, EffectId};
use hysteron_core::measurement::Kind;
use hysteron_core::message::Message;
use hysteron_core::user_model::UserModel;
use serde::{Deserialize, Serialize};

use super::look::Look;

#[derive(Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Settings {
    /// Name of the measurement that is open, unless it is the next.
    pub(super) file: Option<String>,
    /// The measurement itself: a mystery that came in a link.
    pub(super) mystery: Option<String>,
    /// Name of the file with the user's model.
    pub(super) model: Option<String>,
    /// Effects of the user's own, as the command line takes them.
    pub(super) own: Vec<String>,
    /// Effects on top of the baseline, in the order in which they were added.
    pub(super) effects: Vec<String>,
    /// The finding that is shaded.
    pub(super) finding: usize,
    /// What the plots show, and whether beside the step before.
    pub(super) look: Look,
    pub(super) before: bool,
    /// Whether what helps most is hidden until it is found; if nothing is said, it is in a mystery only.
    #[serde(default)]
    pub(super) guess: Option<bool>,
    /// The effect whose fingerprint is shown, if someone chose one.
    pub(super) fingerprint: Option<String>,
}

/// What a link sets as soon as its measurement is open.
#[derive(Clone)]
pub(super) struct Awaited {
    pub(super) settings: Settings,
    pub(super) meant: Meant,
    pub(super) kind: Kind,
}

/// What settings name.
#[derive(Clone)]
pub(super) struct Meant {
    pub(super) model: Option<UserModel>,
    pub(super) effects: Vec<EffectId>,
    pub(super) fingerprint: Option<EffectId>,
}

impl Settings {
    /// What it names, where the user's `model` is this.
    pub(super) fn meant(&self, model: Option<UserModel>) -> Result<Meant, Message> {
        let effect = |id: &String| effect_of(id, model.as_ref());
        Ok(Meant {
            effects: self.effects.iter().map(effect).collect::<Result<_, _>>()?,
            fingerprint: self.fingerprint.as_ref().map(effect).transpose()?,
            model,
        })
    }
}

/// An effect of the library, or of the user's own.
pub(super) fn effect_of(id: &str, model: Option<&UserModel>) -> Result<EffectId, Message> {
    let own = model.iter().flat_map(|m| &m.candidates).map(|c| c.id);
    let library = effect::registry().iter().map(|e| e.id());
    library
        .chain(own)
        .find(|e| e.as_str() == id)
        .ok_or_else(|| "This link adds an effect that does not exist.".into())
}
