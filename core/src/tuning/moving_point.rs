//! Equation (9): the controller that moves an identified point `M` of the Nyquist curve to `S`.
//!
//! Derived after Åström and Hägglund (1984): `C(jw) P(jw)` shall be `S` where `P(jw)` is `M`, so
//! `C(jw) = S/M = rho e^(j theta)`. With `Ti = alpha Td` and without a derivative filter that is
//! `K = rho cos(theta)`, `w Td - 1/(w alpha Td) = tan(theta)`, hence
//! `Td = (tan(theta) + sqrt(tan^2(theta) + 4/alpha))/(2 w)`. Here the filter `Tf = Td/N` is taken into
//! account, so that the point lands on `S` with the controller that is really used.

use std::f64::consts::{FRAC_PI_2, PI};

use num_complex::Complex;
use serde::{Deserialize, Serialize};

use super::controller::Pid;
use super::error::TuningError;
use super::scan::crossing;
use crate::root::{SECTIONS, golden_section};

/// A known point of the plant's Nyquist curve.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct NyquistPoint {
    /// Angular frequency, rad/s.
    pub omega: f64,
    /// Real and imaginary part.
    pub value: [f64; 2],
}

/// Where the point shall go.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Target {
    /// `e^(j(-pi + phi))`, phase margin `phi` in rad.
    PhaseMargin(f64),
    /// `-1/Am`, amplitude margin `Am`.
    AmplitudeMargin(f64),
    /// `r e^(j(-pi + phi))`.
    Point {
        /// Distance `r` from the origin.
        size: f64,
        /// Angle `phi` from the negative real axis, rad.
        angle: f64,
    },
}

impl Target {
    /// `S`.
    pub fn point(self) -> Complex<f64> {
        let (size, angle) = match self {
            Self::PhaseMargin(angle) => (1.0, angle),
            Self::AmplitudeMargin(margin) => (1.0 / margin, 0.0),
            Self::Point { size, angle } => (size, angle),
        };
        Complex::from_polar(size, angle - PI)
    }
}

/// `S/M` as size and angle, the angle within -pi to pi.
fn quotient(from: &NyquistPoint, to: Complex<f64>) -> Result<(f64, f64), TuningError> {
    let ratio = to / Complex::new(from.value[0], from.value[1]);
    let (size, turn) = ratio.to_polar();
    if size.is_finite() && size > 0.0 && from.omega.is_finite() && from.omega > 0.0 {
        Ok((size, turn))
    } else {
        Err(TuningError::NotFinite(
            "the ratio of target and point".into(),
        ))
    }
}

/// The PID controller with `Ti = ratio Td` and `Tf = Td/filter` that moves `from` to `to`, equation (4).
///
/// # Errors
/// [`TuningError::OutOfReach`] where the controller cannot turn so far; with the usual `ratio` 4 and
/// `filter` 10 it turns by -90 to about 55 degrees.
pub fn pid(
    from: &NyquistPoint,
    to: Complex<f64>,
    ratio: f64,
    filter: f64,
) -> Result<Pid, TuningError> {
    let (size, turn) = quotient(from, to)?;
    // C(jw)/K with x = w Td; its angle rises from -pi/2 up to a largest one and falls again.
    let c = |x: f64| {
        let jx = Complex::new(0.0, x);
        1.0 + 1.0 / (jx * ratio) + jx / (jx / filter + 1.0)
    };
    let angle = |x: f64| c(x).arg();
    let top = largest(1e-6, 10.0 * filter.max(1.0), angle);
    let (least, most) = (-FRAC_PI_2, angle(top));
    if !(turn > least && turn < most) {
        return Err(TuningError::OutOfReach { turn, least, most });
    }
    let mut low = top;
    while angle(low) > turn && low > 1e-12 {
        low *= 0.5;
    }
    let x = crossing(low, top, false, |x| angle(x) - turn);
    let derivative = x / from.omega;
    Ok(Pid::with_derivative(
        size / c(x).norm(),
        ratio * derivative,
        derivative,
        filter,
    ))
}

/// The PI controller that moves `from` to `to`: `K = rho cos(theta)`, `Ti = -1/(w tan(theta))`.
///
/// # Errors
/// [`TuningError::OutOfReach`] where the point would have to be turned forward, or back by 90 degrees
/// or more.
pub fn pi(from: &NyquistPoint, to: Complex<f64>) -> Result<Pid, TuningError> {
    let (size, turn) = quotient(from, to)?;
    let (least, most) = (-FRAC_PI_2, 0.0);
    if !(turn > least && turn < most) {
        return Err(TuningError::OutOfReach { turn, least, most });
    }
    Ok(Pid::pi(
        size * libm::cos(turn),
        -1.0 / (from.omega * libm::tan(turn)),
    ))
}

/// Where a function with one maximum between `low` and `high` has it: golden section over the logarithm.
fn largest(low: f64, high: f64, f: impl Fn(f64) -> f64) -> f64 {
    let ends = (libm::log(low), libm::log(high));
    let peak = golden_section(ends, SECTIONS, f64::INFINITY, |x| f(libm::exp(x)));
    libm::exp(peak.at)
}
