//! A whole diagnosis, and everything about one of its models.

use serde::{Deserialize, Serialize};

use super::fingerprint::Fingerprint;
use super::missing::MissingPart;
use super::noise::ChannelNoise;
use super::profile::Profile;
use super::replay::Replay;
use super::screening::InputCheck;
use super::step::Step;
use super::verdict::Verdict;
use crate::effect::EffectId;
use crate::measurement::Kind;
use crate::message::Message;

/// Error of a perfect model, in units of the noise.
pub(crate) const NOISE_FLOOR: f64 = 1.0;

/// A whole diagnosis.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Diagnosis {
    /// Version of this layout, 1.
    pub schema: u32,
    /// Drive or process.
    pub kind: Kind,
    /// Number of samples.
    pub samples: usize,
    /// Error of a perfect model, in the unit of [`Step::error`].
    pub noise_floor: f64,
    /// The unit of the errors: the noise of each measured channel.
    #[serde(default)]
    pub noise: Vec<ChannelNoise>,
    /// Whether the input explains the motion at all.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub input_check: Option<InputCheck>,
    /// From the baseline to the last model.
    pub steps: Vec<Step>,
    /// What is missing.
    pub verdict: Verdict,
    /// Time taken in s; the caller's clock, since this crate has none.
    pub seconds: f64,
}

/// Everything about one model on one measurement: what the Compare page shows.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StepReport {
    /// Error, parameters, where it fails and what could be added.
    pub step: Step,
    /// Error of a perfect model.
    pub noise_floor: f64,
    /// The unit of the errors: the noise of each measured channel.
    #[serde(default)]
    pub noise: Vec<ChannelNoise>,
    /// Curves for the plots.
    pub replay: Replay,
    /// The residual over every axis.
    pub atlas: Vec<Profile>,
    /// What the best of the effects that were tried would leave.
    #[serde(default)]
    pub fingerprints: Vec<Fingerprint>,
    /// The effect that data say should be added next, if any.
    pub suggestion: Option<EffectId>,
    /// Effects in the model that data say are not needed.
    pub needless: Vec<EffectId>,
    /// Where the verdict is unknown: what is missing, estimated without a model, the likeliest first.
    #[serde(default)]
    pub missing: Vec<MissingPart>,
    /// Present when nothing should be added: what is missing from the baseline, and how sure.
    pub verdict: Option<Verdict>,
}

impl Diagnosis {
    /// A diagnosis of which nothing is known yet.
    pub(crate) fn begun(kind: Kind, samples: usize, input_check: InputCheck) -> Self {
        Self {
            schema: 1,
            kind,
            samples,
            noise_floor: NOISE_FLOOR,
            noise: Vec::new(),
            input_check: Some(input_check),
            steps: Vec::new(),
            verdict: Verdict {
                missing: Vec::new(),
                complete: false,
                unknown: true,
                next_experiment: None,
                part_of_the_way: Vec::new(),
                experiments: Vec::new(),
                contradicted: Vec::new(),
                overruled: Vec::new(),
                text: Message::default(),
            },
            seconds: 0.0,
        }
    }
}

impl StepReport {
    /// The same without what is as long as the measurement.
    pub(crate) fn without_curves(&self) -> Self {
        Self {
            step: self.step.clone(),
            replay: Replay {
                channels: Vec::new(),
                window_starts: Vec::new(),
            },
            atlas: self.atlas.clone(),
            fingerprints: Vec::new(),
            verdict: self.verdict.clone(),
            needless: self.needless.clone(),
            missing: self.missing.clone(),
            noise: self.noise.clone(),
            ..*self
        }
    }
}
