//! What a diagnosis says: plain values, the same in JSON, on the command line and on screen.

use serde::{Deserialize, Serialize};

use super::{CriticismError, Fingerprint, MissingPart, NextExperiment, Profile, ResidualTest};
use crate::effect::{EffectId, shown_unit};
use crate::measurement::{Kind, Quantity};
use crate::user_model::Status;

/// A fitted parameter.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Parameter {
    /// The effect that it belongs to; `None` for the baseline model.
    pub effect: Option<EffectId>,
    /// Symbol, such as `J1`.
    pub name: String,
    /// Plain words, such as `motor inertia`.
    pub label: String,
    /// Fitted value in `unit`.
    pub value: f64,
    /// Standard error in `unit`, widened for autocorrelated residuals.
    pub std_error: f64,
    /// SI unit.
    pub unit: String,
    /// Whether it was fitted freely, with a prior, or not at all.
    #[serde(default, skip_serializing_if = "Status::is_free")]
    pub status: Status,
}

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

/// A region in which the error concentrates.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Finding {
    /// `time`, `relay_phase`, `velocity`, `position`, `time_since_reversal`, `frequency`, ...
    pub axis: String,
    /// Lower end of the region, in the unit of the axis.
    pub from: f64,
    /// Upper end of the region, in the unit of the axis.
    pub to: f64,
    /// Share of the squared error in the region, 0 to 1.
    pub share_of_error: f64,
    /// Share of the samples in the region, or of the frequencies in a band, 0 to 1.
    pub share_of_samples: f64,
    /// The finding as a sentence with numbers.
    pub text: String,
    /// Time spans (s) that lie in the region, merged and limited in number, for shading a plot.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub spans: Vec<(f64, f64)>,
}

/// An effect that was tried on top of the present model.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Candidate {
    /// The effect or effects added together.
    pub effects: Vec<EffectId>,
    /// Held-back error after the refit, in noise units.
    pub error: f64,
    /// Change of the Bayesian information criterion against the present model; negative is better.
    pub delta_bic: f64,
    /// Whether held-back data say that it helps, beyond chance over all candidates tried.
    pub significant: bool,
    /// Whether it lowers the error of both parts of the record much, though chance is not ruled out.
    #[serde(default)]
    pub promising: bool,
    /// The parameters of the added effect after the refit.
    pub parameters: Vec<Parameter>,
    /// Other candidates that leave the same error within noise.
    pub equivalent_to: Vec<EffectId>,
}

/// The noise of a measured channel, in its own unit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ChannelNoise {
    /// Name of the channel in the file.
    pub channel: String,
    /// What it measures.
    pub quantity: Quantity,
    /// Standard deviation of the noise in `unit`.
    pub value: f64,
    /// SI unit.
    pub unit: String,
    /// Step of the lattice on which its values lie, in `unit`; absent where none is seen.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub step: Option<f64>,
}

/// Share of the noise from which on a step is worth a word.
const COARSE: f64 = 0.3;

impl ChannelNoise {
    /// `velocity noise 0.0037 rad/s, steps of 0.0132 rad/s`: steps far below the noise are not said.
    pub fn words(&self) -> String {
        let quantity = match self.quantity {
            Quantity::Input => "input",
            Quantity::Position | Quantity::LoadPosition => "position",
            Quantity::Velocity | Quantity::LoadVelocity => "velocity",
            Quantity::Output => "output",
        };
        let size = |value: f64| match shown_unit(&self.unit).as_str() {
            "1" => three_digits(value),
            unit => format!("{} {unit}", three_digits(value)),
        };
        let noise = format!("{quantity} noise {}", size(self.value));
        match self.step.filter(|step| *step > COARSE * self.value) {
            Some(step) => format!("{noise}, steps of {}", size(step)),
            None => noise,
        }
    }
}

/// A size with three digits that count.
fn three_digits(value: f64) -> String {
    let written = format!("{value:.2e}");
    let rounded: f64 = written.parse().unwrap_or(value);
    if (1e-4..1e5).contains(&rounded.abs()) {
        format!("{rounded}")
    } else {
        written
    }
}

/// One model in the sequence from the baseline to the last one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Step {
    /// Effects in the model, in the order in which they were added.
    pub effects: Vec<EffectId>,
    /// Root mean square of the held-back residuals, each channel in units of its own noise.
    pub error: f64,
    /// The same on the data used for the fit.
    pub error_fit: f64,
    /// Share of the motion that the model misses on held-back data, noise included: root mean square of the residuals over
    /// that of the motion.
    #[serde(default)]
    pub left: f64,
    /// Every parameter of the model.
    pub parameters: Vec<Parameter>,
    /// Where it fails, strongest first.
    #[serde(rename = "where")]
    pub findings: Vec<Finding>,
    /// Whether what it leaves is white and no longer follows the input.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub tests: Vec<ResidualTest>,
    /// What could be added, best first.
    pub candidates: Vec<Candidate>,
}

impl Step {
    /// Itself, if there is an error that can be said.
    ///
    /// # Errors
    /// [`CriticismError::NotFinite`]: what was calculated with is too large or too small for an `f64`.
    pub fn checked(&self) -> Result<&Self, CriticismError> {
        if self.error.is_finite() && self.error_fit.is_finite() {
            Ok(self)
        } else {
            Err(CriticismError::NotFinite)
        }
    }
}

/// What the data say in the end.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Verdict {
    /// The missing effects in the order found; each a class that this data cannot tell apart. What tells how the record
    /// was made ([`is_of_record`](crate::effect::is_of_record)) is not among them.
    pub missing: Vec<Vec<EffectId>>,
    /// The residual that is left is noise.
    pub complete: bool,
    /// Structure is left that no effect explains.
    pub unknown: bool,
    /// The experiment that would separate the classes, in words.
    pub next_experiment: Option<String>,
    /// The same with numbers: one for each class of more than one.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub experiments: Vec<NextExperiment>,
    /// Known values that the data contradict; nothing is added before they are right.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub contradicted: Vec<Contradiction>,
    /// The verdict in plain words.
    pub text: String,
}

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
    /// From the baseline to the last model.
    pub steps: Vec<Step>,
    /// What is missing.
    pub verdict: Verdict,
    /// Time taken in s; the caller's clock, since this crate has none.
    pub seconds: f64,
}

/// One output, measured and replayed, for drawing.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ReplayChannel {
    /// What it is.
    pub quantity: Quantity,
    /// Name in the file.
    pub name: String,
    /// SI unit.
    pub unit: String,
    /// Standard deviation of the measurement noise, in `unit`.
    pub noise: f64,
    /// Model output at every sample, in `unit`; as long as the measurement.
    #[serde(with = "crate::packed")]
    pub modelled: Vec<f64>,
}

/// The model driven by the measured input, restarted from estimated states in windows.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Replay {
    /// One entry per measured output, in the same order.
    pub channels: Vec<ReplayChannel>,
    /// First sample of each window.
    pub window_starts: Vec<usize>,
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
