//! What is found of a gap.

use serde::{Deserialize, Serialize};

use crate::message::{Message, says};

/// An end of the gap.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Side {
    /// The motor pushes the load towards positive positions.
    Positive,
    /// The motor pushes the load towards negative positions.
    Negative,
}

impl Side {
    /// 1 or -1.
    pub fn sign(self) -> f64 {
        match self {
            Self::Positive => 1.0,
            Self::Negative => -1.0,
        }
    }
}

/// The motor met the load.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Contact {
    /// When it began, s.
    pub time: f64,
    /// Position of the motor then, rad or m.
    pub position: f64,
    /// At which end of the gap.
    pub side: Side,
    /// Velocity that the motor lost to the load (negative where pushed the other way), rad/s or m/s.
    pub velocity_loss: f64,
}

/// From the last contact at one end of the gap to the first at the other.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Traverse {
    /// The contact that it leaves.
    pub from: Contact,
    /// The contact that it reaches.
    pub to: Contact,
    /// The gap by this traverse: the motor's travel less that of the load meanwhile, rad or m.
    pub gap: f64,
    /// Standard deviation of `gap`, mostly from the load's motion.
    pub std_error: f64,
}

/// One cycle of the relay, for a plot of the drift.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CycleDrift {
    /// Middle of the cycle, s.
    pub time: f64,
    /// Mean position of the motor in it, rad or m.
    pub position: f64,
    /// Drift velocity about it (mean of five cycles), rad/s or m/s.
    pub rate: f64,
    /// Change of velocity in the cycle that the motor alone does not explain, rad/s or m/s.
    pub unexplained: f64,
    /// Whether the pattern of drift differs from that of the free motor.
    pub engaged: bool,
}

/// How the load moves when it is free, in units of the motor's inertia.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LoadMotion {
    /// Load inertia over motor inertia.
    pub inertia_ratio: f64,
    /// Viscous friction over inertia, 1/s.
    pub viscous: f64,
    /// Dry friction over inertia, rad/s^2 or m/s^2.
    pub dry: f64,
}

/// How far an estimate can be trusted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Quality {
    /// Three traverses or more, standard error at most 3 %.
    Good,
    /// Two traverses or more, standard error at most 8 %.
    Fair,
    /// A gap is stated, by one traverse that nothing checks or with a standard error of up to 25 %.
    Poor,
    /// Only one end of the gap was met: the gap rests on a motor that started in the middle of it.
    AssumedCentre,
    /// Only one end was met and nothing else tells; no gap stated.
    OneSide,
    /// Both ends were met, but the load moved too much in between; no gap stated.
    Undecided,
    /// A force that is no contact acts all through the cycle, such as cogging; no gap stated.
    Disturbed,
    /// The motor never met a load; no gap stated.
    NoEngagement,
    /// Too few samples in a cycle of the relay to say that no load was met; no gap stated.
    TooFewSamples,
    /// Not a velocity relay's limit cycle; no gap stated.
    NoDriftingTest,
}

/// What the motor's columns tell about the gap.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct GapEstimate {
    /// The whole gap `2 beta` in `unit`; `None` where none is seen.
    pub gap: Option<f64>,
    /// Standard error of `gap`.
    pub std_error: Option<f64>,
    /// 95 % confidence interval of the gap.
    pub interval: Option<[f64; 2]>,
    /// `rad` or `m`.
    pub unit: String,
    /// Crossings of the gap.
    pub traverses: Vec<Traverse>,
    /// Every contact found.
    pub contacts: Vec<Contact>,
    /// Every cycle, for a plot.
    pub cycles: Vec<CycleDrift>,
    /// The load's motion, where both ends were met.
    pub load: Option<LoadMotion>,
    /// Longest travel of the cycle's middle, in `unit`.
    pub travel: f64,
    /// The verdict in a word.
    pub quality: Quality,
    /// The verdict in a sentence.
    pub text: Message,
}

/// Length below which it reads better in thousandths of its unit.
const SHORT: f64 = 0.1;

impl GapEstimate {
    /// The unit in which its lengths read well (`mrad` or `mm`, if they are short), and how many of that are in one of
    /// `unit`.
    pub fn written_in(&self) -> (f64, String) {
        if self.gap.unwrap_or(self.travel).abs() < SHORT {
            (1e3, format!("m{}", self.unit))
        } else {
            (1.0, self.unit.clone())
        }
    }
}

/// Why a measurement cannot be looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, thiserror::Error)]
pub enum GapError {
    /// A process has no gap.
    NotADrive,
    /// Nothing of the motor's motion was recorded.
    NoMotorColumn,
    /// Values that no checked measurement has.
    Damaged,
    /// Samples so uneven that most of an even grid would be invented.
    UnevenTime,
}

impl GapError {
    /// In words.
    pub fn message(&self) -> Message {
        match self {
            Self::NotADrive => {
                "a process has no gap; expected a drive with columns u [N m] or u [N] and x1 or v1"
                    .into()
            }
            Self::NoMotorColumn => {
                "no motor column; expected x1 (position) and/or v1 (velocity)"
                    .into()
            }
            Self::Damaged => {
                "the columns differ in length, are not finite, or time does not increase"
                    .into()
            }
            Self::UnevenTime => {
                "the samples are too uneven in time; expected an even sampling time without long pauses"
                    .into()
            }
        }
    }
}

says!(GapError);
