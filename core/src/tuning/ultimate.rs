//! Equation (4): ultimate gain and period from a relay test, beside the true ones.
//!
//! **Amplitude** means half of peak to peak everywhere. A program that puts peak to peak into equation
//! (4) reports half of the gain; one that takes peak to peak of the relay for its gain reports twice it.

use std::f64::consts::PI;

use serde::{Deserialize, Serialize};

use super::experiment::RelayTest;
use super::scan;
use crate::plant::TransferFunction;

/// The amplitude convention of every result.
pub const AMPLITUDE_CONVENTION: &str =
    "amplitude is half of peak to peak, of the output as of the relay";

/// Ultimate gain and period.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Ultimate {
    /// `K_u`: the proportional gain at which the loop oscillates, unit of the input over unit of the output.
    pub gain: f64,
    /// `T_u`, s.
    pub period: f64,
}

/// A frequency at which the Nyquist curve crosses the negative real axis.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Crossing {
    /// Angular frequency, rad/s.
    pub omega: f64,
    /// Gain that moves the crossing to -1.
    pub gain: f64,
    /// Whether the phase falls through -180 degrees with rising frequency.
    pub falling: bool,
}

/// What a relay test says about the ultimate point, and what is true; errors are relative.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct UltimateReport {
    /// How amplitudes are counted.
    pub amplitude_convention: String,
    /// By `K_u = 4k/(pi a)`, as if the relay had no hysteresis, equation (4).
    pub plain: Ultimate,
    /// By `K_u = 4k/(pi sqrt(a^2 - eps^2))`, which allows for the hysteresis.
    pub corrected: Ultimate,
    /// From the plant's phase crossover; `None` where its phase never falls through -180 degrees.
    pub truth: Option<Ultimate>,
    /// Error of the plain gain.
    pub plain_error: Option<f64>,
    /// Error of the corrected gain.
    pub corrected_error: Option<f64>,
    /// Error of the measured period.
    pub period_error: Option<f64>,
}

/// `4k/(pi a)`, equation (4): `gain` of the relay, amplitude `a` (half of peak to peak).
///
/// ```
/// // The ideal relay around e^(-0.5 s)/(s + 1): amplitude 1 - e^(-0.5).
/// let a = 1.0 - (-0.5_f64).exp();
/// assert!((hysteron_core::tuning::ultimate_gain(1.0, a) - 3.236).abs() < 5e-4);
/// ```
pub fn ultimate_gain(gain: f64, amplitude: f64) -> f64 {
    4.0 * gain / (PI * amplitude)
}

/// `4k/(pi sqrt(a^2 - eps^2))`, equation (4) with hysteresis: the inverse of the real part of `-1/N(a)`.
pub fn ultimate_gain_with_hysteresis(gain: f64, amplitude: f64, hysteresis: f64) -> f64 {
    let (a, eps) = (amplitude, hysteresis);
    ultimate_gain(gain, ((a - eps) * (a + eps)).max(0.0).sqrt())
}

/// All crossings of the negative real axis by the Nyquist curve of a valid `plant` up to 100 times its
/// fastest pole or zero, lowest frequency first; integrators and dead time included.
///
/// They are the sign changes of `Im P(jw)` where `Re P(jw) < 0`: no phase has to be unwrapped.
pub fn crossings(plant: &TransferFunction) -> Vec<Crossing> {
    let (low, high) = scan::range(&[&plant.numerator, &plant.denominator], plant.dead_time);
    scan::roots(&scan::grid(low, high), |w| plant.response(w).im)
        .into_iter()
        .filter_map(|(omega, rising)| {
            let p = plant.response(omega);
            // A sign change at a pole on the axis is a jump, not a crossing.
            (p.re < 0.0 && p.im.abs() < 1e-6 * p.re.abs()).then(|| Crossing {
                omega,
                gain: -1.0 / p.re,
                falling: rising,
            })
        })
        .collect()
}

/// The true ultimate gain and period of a valid `plant`: the least gain at which a crossing with falling
/// phase reaches -1.
pub fn true_ultimate(plant: &TransferFunction) -> Option<Ultimate> {
    crossings(plant)
        .into_iter()
        .filter(|c| c.falling)
        .min_by(|a, b| a.gain.total_cmp(&b.gain))
        .map(|c| Ultimate {
            gain: c.gain,
            period: 2.0 * PI / c.omega,
        })
}

/// Compares the ultimate point of a symmetric relay `test` with the truth of its `plant`.
pub fn compare(test: &RelayTest, plant: &TransferFunction) -> UltimateReport {
    let (k, a, period) = (test.relay.gain, test.amplitude, test.period);
    let plain = ultimate_gain(k, a);
    let corrected = ultimate_gain_with_hysteresis(k, a, test.relay.hysteresis);
    let truth = true_ultimate(plant);
    let error = |value: f64, exact: fn(&Ultimate) -> f64| {
        truth
            .as_ref()
            .map(|t| value / exact(t) - 1.0)
            .filter(|e| e.is_finite())
    };
    UltimateReport {
        amplitude_convention: AMPLITUDE_CONVENTION.to_owned(),
        plain: Ultimate {
            gain: plain,
            period,
        },
        corrected: Ultimate {
            gain: corrected,
            period,
        },
        plain_error: error(plain, |t| t.gain),
        corrected_error: error(corrected, |t| t.gain),
        period_error: error(period, |t| t.period),
        truth,
    }
}
