//! Does it oscillate, how, and is it stable?

mod describing_function;
mod exact;
mod existence;
mod harmonics;
mod prediction;
mod stability;

use std::f64::consts::PI;

use serde::{Deserialize, Serialize};

use crate::plant::TransferFunction;

pub use describing_function::{
    Intersection, MAX_INTERSECTIONS, TRUSTED_DISTORTION, describing_function,
};
pub use exact::{ExactCycle, exact_cycle, exact_cycles, exact_symmetric};
pub use existence::{Existence, existence};
pub use harmonics::{Harmonic, harmonics};
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
