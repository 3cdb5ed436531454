//! The answer in one or two sentences: what stands first on the page and in the report.

use super::report::StepReport;
use super::step::{Candidate, Step};
use super::verdict::Verdict;
use crate::effect::{self, EffectId, name_of};
use crate::message::Message;
use crate::msg;
use crate::uncertain::{brief, with_error};

/// How far an effect brings a model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reach {
    /// It takes most of the error away.
    Most,
    /// It helps, but most of the error is left: it is not all that is missing, or not what is.
    Part,
    /// It leaves nearly all of it: nothing fits.
    Little,
}

/// Shares of the error beyond the noise that an effect may leave, for [`Reach::Most`] and for [`Reach::Part`].
const MOST: f64 = 0.5;
const PART: f64 = 0.9;

/// A share that is no longer said more finely, per cent.
const WHOLE: f64 = 10.0;

impl StepReport {
    /// Share of the error beyond the noise that a candidate leaves, 0 to 1.
    pub fn left_by(&self, candidate: &Candidate) -> f64 {
        let beyond = |error: f64| (error.powi(2) - self.noise_floor.powi(2)).max(0.0);
        let all = beyond(self.step.error);
        if all > 0.0 {
            (beyond(candidate.error) / all).sqrt().min(1.0)
        } else {
            0.0
        }
    }

    /// How far a candidate brings this model.
    pub fn reach_of(&self, candidate: &Candidate) -> Reach {
        match self.left_by(candidate) {
            left if left <= MOST => Reach::Most,
            left if left <= PART => Reach::Part,
            _ => Reach::Little,
        }
    }

    /// The answer in one or two sentences; `verdict` is what the data say in the end, if they have been heard so far,
    /// `present` are effects that the user knows of, and `noise` says that nothing is missing without what is needless.
    pub fn answer(&self, verdict: Option<&Verdict>, present: &[EffectId], noise: bool) -> Message {
        let added = added(&self.step, verdict, present);
        match verdict {
            Some(verdict) if !verdict.contradicted.is_empty() => {
                let names = verdict.contradicted.iter().map(|c| Message::name(&c.name));
                msg!(
                    "The data contradict the given value of {}.",
                    Message::list(" and ", names)
                )
            }
            Some(verdict) if verdict.complete && added.is_empty() => {
                "Nothing is missing: what the model leaves is measurement noise.".into()
            }
            Some(verdict) if verdict.complete => complete(verdict, &added),
            Some(_) => msg!(
                "No effect in the library explains the rest: {}",
                self.error_words(true)
            ),
            None => self.on_the_way(noise),
        }
    }

    /// Where something can still be added or removed.
    fn on_the_way(&self, noise: bool) -> Message {
        match self.needless.first() {
            Some(idle) if noise => {
                msg!("Only noise is left, with or without {}.", name_of(*idle))
            }
            Some(idle) if self.suggestion.is_none() => msg!(
                "The model's error is {} × the noise, with or without {}.",
                brief(self.step.error),
                name_of(*idle)
            ),
            _ if self.step.error <= self.noise_floor => {
                "The model matches the record to within the noise.".into()
            }
            _ => self.error_words(false),
        }
    }

    /// How large the error is, as a sentence or as the end of one.
    fn error_words(&self, ends: bool) -> Message {
        let error = brief(self.step.error);
        let share = (self.step.left > 0.0).then(|| share(self.step.left));
        match (share, ends) {
            (Some(share), true) => msg!(
                "the model's error is {} × the noise ({} % of the motion).",
                error,
                share
            ),
            (Some(share), false) => msg!(
                "The model's error is {} × the noise ({} % of the motion).",
                error,
                share
            ),
            (None, true) => msg!("the model's error is {} × the noise.", error),
            (None, false) => msg!("The model's error is {} × the noise.", error),
        }
    }
}

/// A share in per cent, two digits.
fn share(share: f64) -> String {
    let percent = 100.0 * share;
    if percent < WHOLE {
        crate::uncertain::digits(percent, 2)
    } else {
        format!("{percent:.0}")
    }
}

/// What was found to be in the machine, each with its main parameter.
fn added(step: &Step, verdict: Option<&Verdict>, present: &[EffectId]) -> Vec<Message> {
    let of_machine = |id: &EffectId| {
        verdict.is_none_or(|v| v.missing.iter().flatten().any(|missing| missing == id))
    };
    let found = step.effects.iter().filter(|id| {
        let known = **id == effect::VISCOUS_FRICTION || present.contains(id);
        !known && !effect::is_of_record(**id) && of_machine(id)
    });
    let words = |id: &EffectId| {
        let main = step.parameters.iter().find(|p| p.effect == Some(*id));
        match main {
            Some(p) => msg!(
                "{}: {}",
                name_of(*id),
                with_error(p.value, p.std_error, &p.unit)
            ),
            None => name_of(*id).into(),
        }
    };
    found.map(words).collect()
}

/// What was missing where nothing more is.
fn complete(verdict: &Verdict, added: &[Message]) -> Message {
    if verdict.missing.iter().all(|class| class.len() < 2) {
        let list = Message::list(" and ", added);
        let were = if added.len() > 1 {
            msg!("The missing effects were {}.", list)
        } else {
            msg!("The missing effect was {}.", list)
        };
        return were.and("Nothing more is missing.");
    }
    let classes = verdict
        .missing
        .iter()
        .map(|class| Message::list(" or ", class.iter().map(|id| name_of(*id))));
    let classes = Message::list(", and ", classes);
    if verdict.missing.len() > 1 {
        msg!(
            "The missing effects are {}: this record cannot tell which.",
            classes
        )
    } else {
        msg!(
            "The missing effect is {}: this record cannot tell which.",
            classes
        )
    }
}
