//! What a screen says of a record.

use serde::{Deserialize, Serialize};

use super::parameter::Parameter;
use crate::effect::EffectId;
use crate::measurement::Kind;
use crate::message::Message;

/// Whether the input explains the motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum InputVerdict {
    /// It does, as far as a regression can tell.
    Ok,
    /// It does with its sign turned.
    Sign,
    /// It does not.
    DoesNotExplain,
    /// It follows the output: a controller made it.
    ClosedLoop,
    /// It may, but how heavy the body is, or what the input does to a process, cannot be told.
    InertiaNotTold,
}

/// The input questioned before the physics.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct InputCheck {
    /// In a word.
    pub verdict: InputVerdict,
    /// In a sentence, with numbers.
    pub text: Message,
    /// Whether what is said of the plant holds: in a closed loop, whether the record tells the plant from the
    /// controller.
    #[serde(default)]
    pub plant_told: bool,
}

impl InputCheck {
    /// Whether the record is not of what the input does to this plant: its sign is turned, or it shows the controller
    /// alone. No physics is named there.
    pub fn is_of_another_plant(&self) -> bool {
        let closed = self.verdict == InputVerdict::ClosedLoop;
        self.verdict == InputVerdict::Sign || closed && !self.plant_told
    }
}

/// Effects that together explain the motion.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Subset {
    /// Their ids, in the order of the library; none for the body alone.
    pub effects: Vec<EffectId>,
    /// Share of the motion that they leave, root mean square on blocks that were held back.
    pub left: f64,
    /// The body and the effects with these values.
    pub parameters: Vec<Parameter>,
}

/// What could explain a record, by regression on its weak form and without a simulation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Screening {
    /// Version of this layout, 1.
    pub schema: u32,
    /// Drive or process.
    pub kind: Kind,
    /// Number of samples.
    pub samples: usize,
    /// The body of the first subset.
    pub body: Vec<Parameter>,
    /// Share of the motion that the body alone leaves; none where it cannot be told.
    pub left_by_body: Option<f64>,
    /// The smallest subsets that are the same as the best, which this record cannot tell apart; the best first.
    pub subsets: Vec<Subset>,
    /// Whether the input explains the motion.
    pub input_check: InputCheck,
    /// Time taken in s; the caller's clock, since this crate has none.
    pub seconds: f64,
}
