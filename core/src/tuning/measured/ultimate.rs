//! Ultimate gain and period of a measured plant, only where they follow.
//!
//! The cycle shows one point; the ultimate point lies elsewhere on the curve unless the phase happens to be -180
//! degrees. The fitted models carry from the one to the other: each is turned and scaled so that it passes through the
//! measured point, and followed to -180 degrees. All models that the record cannot rule out must agree there.

use std::f64::consts::PI;

use num_complex::Complex;
use serde::{Deserialize, Serialize};

use super::fit::{Fit, MISSED};
use super::fourier::Point;

/// Largest relative standard error of gain and period with which they are told.
const TOLD: f64 = 0.025;

/// A model is not ruled out while its score is worse than the best by no more than this, or it misses no more than
/// [`MISSED`].
const SCORE: f64 = 10.0;

/// How far from the cycle's frequency the ultimate one is looked for, as a factor either way.
const FAR: f64 = 30.0;

/// Where the phase of the plant is -180 degrees.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct MeasuredUltimate {
    /// Ultimate gain, unit of the input over that of the output.
    pub gain: f64,
    /// Ultimate period, s.
    pub period: f64,
    /// Standard error of the gain, with the disagreement of the models.
    pub std_error_gain: f64,
    /// Standard error of the period, s.
    pub std_error_period: f64,
}

/// Ultimate point by one model through the measured point, turned by `turn` rad and scaled by `scale`.
fn through(
    response: &dyn Fn(f64) -> Complex<f64>,
    sign: f64,
    point: Option<&Point>,
    omega: f64,
    (scale, turn): (f64, f64),
) -> Option<(f64, f64)> {
    let (sin, cos) = libm::sincos(turn);
    let by = point.map_or(Complex::new(1.0, 0.0), |p| p.value() / response(p.omega));
    let by = by * Complex::new(cos, sin) * scale * sign;
    // A correction near half a turn is no correction of a model that fits.
    if point.is_some() && (sign * by.re <= 0.0 || by.im.abs() > by.re.abs()) {
        return None;
    }
    // The model's own sign is in the response: both are turned to positive gain.
    let own = |w: f64| response(w) * by;
    let at = crossover(&own, omega / FAR, omega * FAR)?;
    Some((1.0 / own(at).norm(), 2.0 * PI / at))
}

/// The ultimate point, and which models were asked; `omega` is a frequency in the plant's range.
pub(super) fn ultimate(
    fits: &[Fit],
    point: Option<&Point>,
    omega: f64,
) -> Option<MeasuredUltimate> {
    let all = candidate(fits, point, omega)?;
    let told =
        all.std_error_gain <= TOLD * all.gain.abs() && all.std_error_period <= TOLD * all.period;
    told.then_some(all)
}

/// The same, however uncertain.
pub(super) fn candidate(
    fits: &[Fit],
    point: Option<&Point>,
    omega: f64,
) -> Option<MeasuredUltimate> {
    let best = fits.first()?;
    let sign = best.model.gain.value.signum();
    // Models that the record cannot rule out disagree in full. The others stand for orders that were not tried: these
    // would change the answer as the last ones did, in proportion to the squared error that is left to them.
    let weight = |f: &Fit| {
        if f.score - best.score <= SCORE || f.model.left <= MISSED * best.model.left {
            1.0
        } else {
            (best.model.left / f.model.left).powi(2)
        }
    };
    let of =
        |fit: &Fit, change: (f64, f64)| through(&|w| fit.response(w), sign, point, omega, change);
    let (gain, period) = of(best, (1.0, 0.0))?;
    let mut variances = [0.0; 2];
    let mut widest = [0.0_f64; 2];
    for other in fits.iter().skip(1) {
        let weight = weight(other);
        let Some((g, p)) = of(other, (1.0, 0.0)) else {
            // A model without such a point disagrees as much as can be.
            if weight >= 1.0 {
                return None;
            }
            continue;
        };
        widest = [
            widest[0].max(weight * (g - gain).abs()),
            widest[1].max(weight * (p - period).abs()),
        ];
    }
    for (variance, wide) in variances.iter_mut().zip(widest) {
        *variance += wide * wide;
    }
    let mut add = |index: usize, error: f64| variances[index] += error * error;
    if let Some(point) = point {
        let turned = of(best, (1.0, point.std_error_phase_deg.to_radians()))?;
        add(0, gain * point.std_error_magnitude / point.magnitude);
        add(0, turned.0 - gain);
        add(1, turned.1 - period);
    }
    // What the best model misses beyond noise it may get wrong on the way from the cycle to -180 degrees as well.
    let way = point.map_or(1.0, |p| (p.beyond(sign).abs() / 90.0).min(1.0));
    add(0, gain * best.misfit() * way);
    add(1, period * best.misfit() * way);
    for (index, middle) in [gain, period].into_iter().enumerate() {
        let number = |response: &dyn Fn(f64) -> Complex<f64>| {
            through(response, sign, point, omega, (1.0, 0.0))
                .map(|r| if index == 0 { r.0 } else { r.1 })
        };
        // Where the Jacobian tells nothing, the error is as large as the value.
        add(index, best.error_of(number).unwrap_or(middle));
    }
    Some(MeasuredUltimate {
        gain: sign * gain,
        period,
        std_error_gain: variances[0].sqrt(),
        std_error_period: variances[1].sqrt(),
    })
}

/// Frequency at which the phase passes -180 degrees first, searched from `low` to `high` rad/s; the gain is positive.
fn crossover(response: &dyn Fn(f64) -> Complex<f64>, low: f64, high: f64) -> Option<f64> {
    let points = crate::tuning::scan::grid(low, high);
    let turned = |w: f64| {
        let r = response(w);
        libm::atan2(r.im, r.re)
    };
    let mut phase = turned(low);
    let mut before = (low, phase);
    for &w in points.iter().skip(1) {
        let raw = turned(w);
        phase = raw + 2.0 * PI * ((phase - raw) / (2.0 * PI)).round();
        if before.1 > -PI && phase <= -PI {
            let f = |x: f64| response(x).im;
            return Some(crate::tuning::scan::crossing(
                before.0,
                w,
                f(before.0) > 0.0,
                f,
            ));
        }
        before = (w, phase);
    }
    None
}
