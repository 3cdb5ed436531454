//! Equation (8): the gain adaptation `K(n+1)`, run as an experiment.
//!
//! The relay of equation (7) stands in series with the gain `K`, and `K` is changed after each run
//! until the measured amplitude is the wanted one. Two iterations, both without any model:
//!
//! - *secant* (Åström and Hägglund 1984): `K(n+1) = K(n) - (a(n) - a) (K(n) - K(n-1))/(a(n) - a(n-1))`,
//!   one run a step, order 1.618;
//! - *Steffensen*: each step takes a second run at the proportional correction `K a/a(n)` (which would
//!   be the answer if there were no hysteresis) and draws the secant through both. Since the two runs
//!   come together as the error falls, the secant becomes the tangent and the order is 2: quadratic.

use serde::{Deserialize, Serialize};

use super::error::TuningError;
use super::experiment::RelayTest;
use super::phase_margin::RelayDesign;
use crate::plant::TransferFunction;

/// How the next gain is found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum AdaptationMethod {
    /// Through the last two runs.
    Secant,
    /// Through a run and its proportional correction.
    #[default]
    Steffensen,
}

/// Relative error of the amplitude at which the adaptation ends.
const CONVERGED: f64 = 1e-10;

/// Errors below this are rounding and say nothing about the order.
const ROUNDING: f64 = 1e-11;

/// Most steps.
const STEPS: usize = 12;

/// Doublings of the first gain in search of an oscillation.
const DOUBLINGS: usize = 8;

/// Most by which one step may change the gain.
const LARGEST_CHANGE: f64 = 4.0;

/// A gain that was tried, and what the loop did.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AdaptationStep {
    /// Gain `K(n)`.
    pub gain: f64,
    /// Error of the amplitude, `a(n)/a - 1`.
    pub error: f64,
    /// The run.
    pub test: RelayTest,
    /// Gain and amplitude error of the second run, where there was one.
    pub trial: Option<[f64; 2]>,
}

/// A finished adaptation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Adaptation {
    /// The relay's design, equation (7).
    pub design: RelayDesign,
    /// The iteration.
    pub method: AdaptationMethod,
    /// Its steps; the last one has the answer.
    pub steps: Vec<AdaptationStep>,
    /// Gain `K` found: a proportional controller with about the required phase margin.
    pub gain: f64,
    /// Orders of convergence, `ln(e(n+1)/e(n)) / ln(e(n)/e(n-1))`, one for each three successive errors
    /// above rounding; they approach 2 (Steffensen) or 1.618 (secant).
    pub orders: Vec<f64>,
}

/// Runs the adaptation on a valid `plant`, from the gain `first` (above 0).
///
/// # Errors
/// That of a relay run, or [`TuningError::NotConverged`].
pub fn adapt(
    plant: &TransferFunction,
    design: &RelayDesign,
    method: AdaptationMethod,
    first: f64,
) -> Result<Adaptation, TuningError> {
    let run = |gain: f64| {
        let test = RelayTest::run(plant, &design.relay(gain))?;
        let error = test.amplitude / design.amplitude - 1.0;
        Ok::<_, TuningError>((error, test))
    };
    let mut gain = first;
    let mut now = run(gain);
    for _ in 0..DOUBLINGS {
        if now.is_ok() {
            break;
        }
        gain *= 2.0;
        now = run(gain);
    }
    let (mut error, mut test) = now?;
    let mut steps: Vec<AdaptationStep> = Vec::new();
    loop {
        let previous = steps.last().map(|s| (s.gain, s.error));
        let mut step = AdaptationStep {
            gain,
            error,
            test,
            trial: None,
        };
        if error.abs() < CONVERGED {
            steps.push(step);
            break;
        }
        if steps.len() >= STEPS {
            return Err(TuningError::NotConverged {
                runs: steps.len(),
                gain,
                error,
            });
        }
        let corrected = limited(gain / (1.0 + error), gain);
        let other = match (method, previous) {
            (AdaptationMethod::Secant, None) => None,
            (AdaptationMethod::Secant, Some(other)) => Some(other),
            (AdaptationMethod::Steffensen, _) => {
                let trial = run(corrected)?.0;
                step.trial = Some([corrected, trial]);
                Some((corrected, trial))
            }
        };
        let next = other.map_or(corrected, |(k, e)| gain - error * (gain - k) / (error - e));
        steps.push(step);
        // Two equal amplitudes give no secant: take the proportional correction.
        let next = if next.is_finite() { next } else { corrected };
        gain = limited(next, gain);
        (error, test) = run(gain)?;
    }
    Ok(Adaptation {
        design: *design,
        method,
        gain,
        orders: orders(&steps.iter().map(|s| s.error).collect::<Vec<_>>()),
        steps,
    })
}

fn limited(next: f64, gain: f64) -> f64 {
    next.clamp(gain / LARGEST_CHANGE, gain * LARGEST_CHANGE)
}

/// Orders of convergence seen in a sequence of errors.
pub fn orders(errors: &[f64]) -> Vec<f64> {
    errors
        .windows(3)
        .filter(|e| e.iter().all(|v| v.abs() > ROUNDING))
        .map(|e| libm::log((e[2] / e[1]).abs()) / libm::log((e[1] / e[0]).abs()))
        .collect()
}
