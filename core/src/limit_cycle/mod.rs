//! Does it oscillate, how, and is it stable?

mod exact;
mod stability;

use std::f64::consts::PI;

use serde::{Deserialize, Serialize};

use crate::plant::TransferFunction;
use crate::relay::Relay;

pub use exact::{ExactCycle, exact_cycle, exact_cycles, exact_symmetric};

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

/// An intersection of the Nyquist curve with `-1/N(a)`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Intersection {
    /// Real and imaginary part.
    pub point: [f64; 2],
    /// Angular frequency, rad/s.
    pub omega: f64,
    /// The cycle that the describing function predicts there.
    pub cycle: Cycle,
}

/// Points of the frequency scan, per decade.
const SCAN_PER_DECADE: usize = 200;

/// Decades of the scan on either side of the plant's own frequency.
const SCAN_DECADES: f64 = 3.0;

/// Typical angular frequency of a plant, rad/s: the geometric mean of its poles, or of what its
/// coefficients show where some are at 0.
pub fn typical_frequency(plant: &TransferFunction) -> f64 {
    let lead = plant.denominator[0];
    let poles = plant
        .denominator
        .iter()
        .rposition(|c| *c != 0.0)
        .unwrap_or(0);
    let size = if poles > 0 {
        (plant.denominator[poles] / lead)
            .abs()
            .powf(1.0 / poles as f64)
    } else {
        1.0
    };
    if plant.dead_time > 0.0 {
        size.min(PI / plant.dead_time)
    } else {
        size
    }
}

/// All intersections of the Nyquist curve with `-1/N(a)`, equations (5) and (6): where
/// `Im P(jw) = -pi eps/(4k)` and `Re P(jw) <= 0`; `lag` is the relay's delay in s.
pub fn describing_function(plant: &TransferFunction, relay: &Relay) -> Vec<Intersection> {
    let response =
        |w: f64| plant.response(w) * nalgebra::Complex::from_polar(1.0, -w * relay.delay);
    let level = -PI * relay.hysteresis / (4.0 * relay.gain);
    let balance = |w: f64| response(w).im - level;
    let centre = typical_frequency(plant);
    let count = (2.0 * SCAN_DECADES * SCAN_PER_DECADE as f64) as usize;
    let frequency =
        |i: usize| centre * 10_f64.powf(-SCAN_DECADES + i as f64 / SCAN_PER_DECADE as f64);
    let mut found = Vec::new();
    for i in 0..count {
        let (low, high) = (frequency(i), frequency(i + 1));
        let (f_low, f_high) = (balance(low), balance(high));
        let crosses = f_low * f_high < 0.0;
        if !crosses {
            continue;
        }
        let omega = bisect(low, high, f_low, balance);
        let p = response(omega);
        if p.re >= 0.0 {
            continue;
        }
        let reach = 4.0 * relay.gain / PI * p.norm();
        // Loeb: the curve must cross the line upwards seen along rising frequency (the amplitude
        // grows to the left), so that a larger swing is less than critical.
        found.push(Intersection {
            point: [p.re, p.im],
            omega,
            cycle: Cycle {
                period: 2.0 * PI / omega,
                amplitude: reach,
                stable: Some(f_high > f_low),
            },
        });
    }
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
