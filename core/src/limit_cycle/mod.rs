//! Does it oscillate, how, and is it stable?

mod describing_function;
mod divergence;
mod exact;
mod existence;
mod harmonics;
mod noisy;
mod outcome;
mod pattern;
mod prediction;
mod stability;
mod words;

use std::f64::consts::PI;

use serde::{Deserialize, Serialize};

use crate::plant::TransferFunction;
use crate::relay::Relay;

pub use describing_function::{
    Intersection, MAX_INTERSECTIONS, TRUSTED_DISTORTION, describing_function,
};
pub use exact::{ExactCycle, exact_cycle, exact_cycles, exact_symmetric};
use exact::{continuum, settled_cycle};
pub use existence::{Existence, existence};
pub use harmonics::{Harmonic, harmonics};
pub use outcome::{LongRun, LongRunResult, Outcome};
pub use prediction::{PredictError, Prediction, Trust, dominant, predict};

/// A limit cycle.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Cycle {
    /// Period, s.
    pub period: f64,
    /// Half of peak to peak, in the unit of the output (the paper's `a`).
    pub amplitude: f64,
    /// Whether small disturbances die out; `None` where it is not known.
    pub stable: Option<bool>,
}

/// Typical angular frequency of a plant, rad/s: the geometric mean of its poles, or of what its
/// coefficients show where some are at 0.
pub fn typical_frequency(plant: &TransferFunction) -> f64 {
    let Some(lead) = plant.denominator.first() else {
        return 1.0;
    };
    let poles = plant
        .denominator
        .iter()
        .rposition(|c| *c != 0.0)
        .unwrap_or(0);
    let size = if poles > 0 {
        libm::pow((plant.denominator[poles] / lead).abs(), 1.0 / poles as f64)
    } else {
        1.0
    };
    if plant.dead_time > 0.0 {
        size.min(PI / plant.dead_time)
    } else {
        size
    }
}

/// Half periods in s near which a loop may oscillate though its describing function sees nothing, each with the dead
/// time and the relay's delay: that of the plant's typical frequency; that of a plant which answers a step at once with
/// a slope, on which the output goes to and fro between the thresholds; and that of its slowest pole alone, for which
/// it is exact.
pub fn likely_half_periods(plant: &TransferFunction, relay: &Relay) -> Vec<f64> {
    let lag = plant.dead_time + relay.delay;
    let reach = |gain: f64| relay.hysteresis / (relay.gain * gain.abs());
    let mut found = vec![0.5 * PI / typical_frequency(plant) + lag];
    if let (1, Some(b), Some(a)) = (
        plant.relative_degree(),
        plant.numerator.iter().find(|b| **b != 0.0),
        plant.denominator.first(),
    ) {
        found.push(2.0 * (reach(b / a) + lag));
    }
    let rates = plant.poles().into_iter().map(|p| -p.re);
    let slowest = rates.filter(|rate| *rate > 0.0).reduce(f64::min);
    if let Some(rate) = slowest {
        // y = K k - (K k + eps) exp(-rate t) from -eps to eps
        found.push(2.0 * libm::atanh(reach(plant.dc_gain())) / rate + lag);
    }
    found.retain(|h| h.is_finite() && *h > 0.0);
    found
}

fn bisect(mut low: f64, mut high: f64, f_low: f64, f: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..200 {
        let mid = 0.5 * (low + high);
        if mid <= low || mid >= high {
            break;
        }
        let value = f(mid);
        if value == 0.0 {
            return mid;
        }
        if (value < 0.0) == (f_low < 0.0) {
            low = mid;
        } else {
            high = mid;
        }
    }
    0.5 * (low + high)
}

/// Root of `f` between two points of different sign (Illinois method, then bisection).
fn illinois(low: (f64, f64), high: (f64, f64), f: impl Fn(f64) -> f64) -> f64 {
    let (mut a, mut b) = (low, high);
    for _ in 0..60 {
        let mut x = b.0 - b.1 * (b.0 - a.0) / (b.1 - a.1);
        if !(x > a.0.min(b.0) && x < a.0.max(b.0)) {
            x = 0.5 * (a.0 + b.0);
        }
        let value = f(x);
        if value == 0.0 || (x - b.0).abs() <= 2.0 * f64::EPSILON * x {
            return x;
        }
        if (value < 0.0) == (b.1 < 0.0) {
            a.1 *= 0.5;
        } else {
            a = b;
        }
        b = (x, value);
    }
    let (low, high) = if a.0 < b.0 { (a, b) } else { (b, a) };
    bisect(low.0, high.0, low.1, f)
}
