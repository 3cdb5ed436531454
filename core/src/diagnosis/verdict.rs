//! What the data say in the end.

use serde::{Deserialize, Serialize};

use super::experiment::NextExperiment;
use crate::effect::EffectId;
use crate::message::Message;
use crate::msg;
use crate::uncertain::{brief, with_error, written_like};

/// A known value that the data contradict.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Contradiction {
    /// The effect that it belongs to; `None` for the baseline model.
    pub effect: Option<EffectId>,
    /// Its symbol.
    pub name: String,
    /// The value that the user's model holds, in `unit`.
    pub held: f64,
    /// The value that the data want, in `unit`.
    pub wanted: f64,
    /// Standard error of the latter.
    pub std_error: f64,
    /// SI unit.
    pub unit: String,
    /// Held-back error with the known values released, in noise units.
    pub error: f64,
}

/// A value that the user knew about, and that the data have moved by more than three of its tolerances.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Overruled {
    /// The effect that it belongs to; `None` for the baseline model.
    pub effect: Option<EffectId>,
    /// Its symbol.
    pub name: String,
    /// The value that was given, in `unit`.
    pub given: f64,
    /// Its tolerance, in `unit`.
    pub tolerance: f64,
    /// The value that was found, in `unit`.
    pub found: f64,
    /// SI unit.
    pub unit: String,
}

impl Overruled {
    /// In words with numbers.
    pub fn words(&self) -> Message {
        let Self {
            name,
            given,
            tolerance,
            found,
            unit,
            ..
        } = self;
        msg!(
            "The data contradict what was given: {} is {}, while the model has {}, {} tolerances away.",
            Message::name(name),
            written_like(*found, (*given, *tolerance), unit),
            with_error(*given, *tolerance, unit),
            brief((found - given).abs() / tolerance)
        )
    }
}

/// What the data say in the end.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Verdict {
    /// The missing effects in the order found; each a class that this data cannot tell apart. What tells how the record
    /// was made ([`is_of_record`](crate::effect::is_of_record)) is not among them.
    pub missing: Vec<Vec<EffectId>>,
    /// Effects, of which one would explain a part for certain: named as no cause, since more than that would be left,
    /// or since what is missing may look like them. This data cannot tell them apart.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub part_of_the_way: Vec<EffectId>,
    /// The residual that is left is noise.
    pub complete: bool,
    /// Structure is left that no effect explains.
    pub unknown: bool,
    /// The experiment that would separate the classes, in words.
    pub next_experiment: Option<Message>,
    /// The same with numbers: one for each class of more than one.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub experiments: Vec<NextExperiment>,
    /// Known values that the data contradict; nothing is added before they are right.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub contradicted: Vec<Contradiction>,
    /// Values with a tolerance that the data have overruled: said first and last.
    #[serde(default)]
    pub overruled: Vec<Overruled>,
    /// The verdict in plain words.
    pub text: Message,
}

impl Verdict {
    /// Puts the experiments into words.
    pub(crate) fn say_experiments(&mut self) {
        let texts = self.experiments.iter().map(|e| &e.text);
        self.next_experiment = Some(texts.fold(Message::default(), Message::and));
    }

    /// Puts a proposal in the place of another, in words too; one that is not there changes nothing.
    pub fn replace_experiment(&mut self, index: usize, proposal: NextExperiment) {
        if let Some(place) = self.experiments.get_mut(index) {
            *place = proposal;
            self.say_experiments();
        }
    }
}
