//! The experiment that tells apart what a record could not.

use serde::{Deserialize, Serialize};

use super::limits::Limits;
use super::parameter::Parameter;
use super::program::{Program, short};
use crate::effect::EffectId;
use crate::message::Message;

/// A model that explains the record, fitted to it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FittedModel {
    /// The effect for which others could stand.
    pub effect: EffectId,
    /// Every effect on top of the baseline, in order.
    pub effects: Vec<EffectId>,
    /// Every parameter with the fit's value.
    pub parameters: Vec<Parameter>,
}

/// A program with how well it tells the models apart.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Trial {
    /// What drives the experiment.
    pub program: Program,
    /// Root mean square of what the wrong model would leave, in noise units: of the pair that is closest.
    pub separation: f64,
    /// The program in words.
    pub text: Message,
}

impl Trial {
    /// The separation with as many digits as count, such as `3.81` or `less than 0.01`.
    pub fn times_noise(&self) -> Message {
        times(self.separation)
    }
}

/// The experiment that tells the members of a class apart.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct NextExperiment {
    /// What it tells apart.
    pub class: Vec<EffectId>,
    /// What drives it.
    pub program: Program,
    /// Unit of the input.
    pub input_unit: String,
    /// Unit of the velocity, or of the output of a process.
    pub output_unit: String,
    /// Sampling time, s.
    pub step: f64,
    /// Length of record that is enough to tell them apart, s.
    pub needed: f64,
    /// Length of record that is advised, s: all other effects are to be judged as well.
    pub duration: f64,
    /// Root mean square of what the wrong model would leave, in noise units: of the pair that is closest.
    pub separation: f64,
    /// The same of the record at hand.
    pub today: f64,
    /// Whether it decides within the limits; else it is only the best that there is.
    pub sufficient: bool,
    /// Largest velocity of the drive, or output of the process, that is expected.
    pub speed: f64,
    /// Travel of the drive that is expected, rad or m; 0 for a process.
    pub travel: f64,
    /// What it keeps to.
    pub limits: Limits,
    /// The best of the other kinds, best first.
    pub others: Vec<Trial>,
    /// The models that it tells apart, in the order of `class`.
    pub models: Vec<FittedModel>,
    /// In words with numbers.
    pub text: Message,
}

impl NextExperiment {
    /// The proposal beside the others.
    pub fn trial(&self) -> Trial {
        Trial {
            program: self.program.clone(),
            separation: self.separation,
            text: self.program.words(&self.input_unit, &self.output_unit),
        }
    }
}

/// A separation below this is as good as none, in times of the noise.
pub(crate) const LEAST: f64 = 0.01;

/// Times the noise, with as many digits as count.
pub(crate) fn times(separation: f64) -> Message {
    if separation < LEAST {
        "less than 0.01".into()
    } else {
        short(separation).into()
    }
}
