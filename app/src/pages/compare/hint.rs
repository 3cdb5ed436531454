//! What to try next: it follows from what is open, and from what was found.

use hysteron_core::diagnosis::{Candidate, DiscoveryEnd, Reach, StepReport, Verdict};
use hysteron_core::effect::{EffectId, name_of};
use hysteron_core::message::{Message, fixed};
use hysteron_core::msg;

use super::experiment;
use super::look::Look;
use super::state::Compare;
use crate::command::Command;
use crate::page::Hint;

impl Compare {
    pub(super) fn next(&self) -> Hint {
        if self.form.is_some() {
            return Hint::say("Say which column is what, then open the file.");
        }
        if self.measurement.is_none() && self.opening.is_none() {
            let sentence = "Begin with a drive that loses momentum: one effect is missing.";
            return Hint::open(sentence, "v1;compare;compare.file=drive-02");
        }
        let report = self.report().filter(|_| self.job.is_none());
        let Some(report) = report else {
            return Hint::say("Every effect in the library is being tried.");
        };
        if self.is_guessing() {
            return Hint::say("Which fingerprint matches the residual? Add that effect.");
        }
        if let Some(effect) = report.suggestion {
            let candidates = &report.step.candidates;
            let card = candidates.iter().find(|c| c.effects == [effect]);
            let reach = card.map_or(Reach::Most, |c| report.reach_of(c));
            let left = card.map_or(0.0, |c| 100.0 * report.left_by(c));
            let sentence = helps(&either(effect, card), reach, left);
            if reach == Reach::Little && self.look != Look::Places {
                return set(sentence, "look", serde_json::json!(Look::Places));
            }
            let with = [self.effects.as_slice(), &[effect]].concat();
            return set_effects(sentence, &with);
        }
        if let Some(effect) = report.needless.first() {
            let mut without = self.effects.clone();
            without.retain(|e| e != effect);
            let name = name_of(*effect);
            return set_effects(msg!("{} is not needed: remove it.", name), &without);
        }
        match &report.verdict {
            Some(verdict) => self.after(verdict, report),
            None => self.where_it_fails(),
        }
    }

    /// Where nothing is to be added.
    fn after(&self, verdict: &Verdict, report: &StepReport) -> Hint {
        if let Some(known) = verdict.contradicted.first() {
            let name = &known.name;
            return Hint::say(msg!(
                "Correct the given value of {} in your model.",
                Message::name(name)
            ));
        }
        if verdict.missing.iter().any(|class| class.len() > 1) {
            let preview = verdict
                .experiments
                .iter()
                .find_map(|proposal| experiment::preview(self, proposal));
            return match preview {
                Some(commands) => Hint {
                    sentence:
                        "Only another experiment can tell them apart: see what it would show."
                            .into(),
                    commands,
                },
                None => Hint::say("Only another experiment can tell them apart."),
            };
        }
        if !verdict.complete {
            let explained = self.discovery().map(|d| d.end) == Some(DiscoveryEnd::Explained);
            if explained || self.unknown.is_busy() {
                return self.formula_hint().unwrap_or_else(|| self.where_it_fails());
            }
            // Two effects may hide each other: the second shows when the first is in the model.
            let perhaps = report.step.candidates.iter().find(|c| c.promising);
            if let Some(effect) = perhaps.and_then(|c| c.effects.first()) {
                let with = [self.effects.as_slice(), &[*effect]].concat();
                let name = name_of(*effect);
                return set_effects(
                    msg!("Perhaps {}: add it and see what is left.", name),
                    &with,
                );
            }
            return self.formula_hint().unwrap_or_else(|| self.where_it_fails());
        }
        if self.sealed.as_ref().is_some_and(|s| !s.is_revealed()) {
            if self.look == Look::Reveal {
                return Hint::say("The model is complete: type the password and reveal the truth.");
            }
            let sentence = "The model is complete: now see what was hidden.";
            return set(sentence, "look", serde_json::json!(Look::Reveal));
        }
        if report.step.effects.is_empty() || self.effects_before().is_none() || self.before {
            return self.another();
        }
        self.beside()
    }

    /// What is looked for, or was found, where no effect explains the rest.
    fn formula_hint(&self) -> Option<Hint> {
        if self.unknown.is_busy() {
            let sentence = "Nothing in the library fits: searching for a formula.";
            return Some(Hint::say(sentence));
        }
        let discovery = self.discovery()?;
        let found = discovery.found()?;
        let whole = discovery.end == DiscoveryEnd::Explained;
        let sentence = if whole {
            "A formula explains what is left: add it."
        } else {
            "A formula explains part of what is left: add it."
        };
        let Some(super::command::Command::AddOwn(typed)) = self.adding(found) else {
            let with = [self.effects.as_slice(), &[EffectId::own(&found.name)?]].concat();
            return Some(set_effects(sentence, &with));
        };
        let own = [self.own.as_slice(), &[typed.line()]].concat();
        let mut ids: Vec<String> = self.effects.iter().map(|e| e.as_str().to_owned()).collect();
        ids.push(typed.id());
        let set = |field, value| Command::Set("compare", field, value);
        Some(Hint {
            sentence: sentence.into(),
            commands: vec![
                set("own", serde_json::json!(own)),
                set("effects", serde_json::json!(ids)),
            ],
        })
    }

    /// The step before beside this one, in plots that can show both.
    fn beside(&self) -> Hint {
        let look = match self.look {
            Look::Places => Look::Places,
            _ => Look::Time,
        };
        let set = |field, value| Command::Set("compare", field, value);
        Hint {
            sentence: "Nothing more is missing: compare with what the previous step left.".into(),
            commands: vec![
                set("look", serde_json::json!(look)),
                set("before", true.into()),
            ],
        }
    }

    /// Where structure is left that no effect explains.
    fn where_it_fails(&self) -> Hint {
        if !self.forms().is_empty() {
            return Hint::say("Nothing fits: try one of the simplest forms of the missing force.");
        }
        if self.look == Look::Places {
            return Hint::say("No effect explains the rest: write one of your own.");
        }
        let sentence = "No effect explains the rest: see where it lies.";
        set(sentence, "look", serde_json::json!(Look::Places))
    }

    /// Another record than the one that is open.
    fn another(&self) -> Hint {
        let late = "drive-12";
        if self.measurement.as_ref().is_some_and(|m| m.name == late) {
            let sentence = "A slow heating process: find out why it overshoots.";
            return Hint::open(sentence, "v1;compare;compare.file=process-02");
        }
        let sentence = "A drive that responds late: there one effect is not enough.";
        Hint::open(sentence, "v1;compare;compare.file=drive-12")
    }
}

/// An effect, and what these data cannot tell apart from it.
enum Either {
    One(Message),
    Several(Message),
}

fn either(effect: EffectId, card: Option<&Candidate>) -> Either {
    let name = name_of(effect);
    match card.map_or(&[][..], |c| &c.equivalent_to) {
        [] => Either::One(name.into()),
        [other] => Either::Several(Message::list(" or ", [name, name_of(*other)])),
        others => Either::Several(msg!("{} or one of {} others", name, others.len())),
    }
}

/// What helps most, and how much that is; it leaves so many per cent of the error.
fn helps(what: &Either, reach: Reach, left: f64) -> Message {
    match (what, reach) {
        (Either::One(name), Reach::Most) => msg!("{} helps most: add it.", name),
        (Either::Several(names), Reach::Most) => {
            msg!("{} helps most; this record cannot tell which.", names)
        }
        (Either::One(name) | Either::Several(name), Reach::Part) => {
            msg!(
                "{} helps most, but leaves {} % of the error.",
                name,
                fixed(left, 0)
            )
        }
        (Either::One(name) | Either::Several(name), Reach::Little) => {
            msg!(
                "Nothing fits: even {} leaves {} % of the error.",
                name,
                fixed(left, 0)
            )
        }
    }
}

fn set_effects(sentence: impl Into<Message>, effects: &[EffectId]) -> Hint {
    let ids: Vec<&str> = effects.iter().map(|e| e.as_str()).collect();
    set(sentence, "effects", serde_json::json!(ids))
}

fn set(sentence: impl Into<Message>, field: &'static str, value: serde_json::Value) -> Hint {
    Hint {
        sentence: sentence.into(),
        commands: vec![Command::Set("compare", field, value)],
    }
}
