//! Does it oscillate, how, and is it stable?

mod cycle;
mod describing_function;
mod divergence;
mod exact;
mod existence;
mod harmonics;
mod history;
mod long_run;
mod noisy;
mod outcome;
mod pattern;
mod prediction;
mod stability;
mod words;
mod z_form;

use std::f64::consts::PI;

use crate::plant::TransferFunction;
use crate::relay::Relay;

pub use cycle::Cycle;
pub use describing_function::{
    Intersection, MAX_INTERSECTIONS, TRUSTED_DISTORTION, describing_function,
};
pub use exact::{ExactCycle, exact_cycle, exact_cycles, exact_symmetric};
use exact::{continuum, settled_cycle};
pub use existence::{Existence, existence};
pub use harmonics::{Harmonic, harmonics};
pub use long_run::{LongRun, LongRunResult};
pub use outcome::Outcome;
pub use prediction::{PredictError, Prediction, Trust, dominant, predict};
pub use z_form::{pulse_transfer_at_minus_one, z_form};

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
