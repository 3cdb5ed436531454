//! The point of the Nyquist curve that a cycle shows: the ratio of the Fourier coefficients of output and input.
//!
//! The input's coefficient over the whole periods is integrated exactly. The output's is taken in two parts: what a
//! fitted model makes of the very input (start, drift of the period and asymmetry included), and the harmonics of what
//! the model leaves, by least squares together with a drift. The first part keeps what is not periodic from counting;
//! the second keeps the model's faults from counting. Nothing is assumed of the relay.

use std::f64::consts::PI;

use num_complex::Complex;
use serde::{Deserialize, Serialize};

use super::compared::Compared;
use super::cycle::Cycle;
use super::fit::Fit;
use super::record::Record;
use super::response::Held;
use super::structure::Value;
use crate::least_squares::{coherence, inverse_gram, least_squares};
use crate::order::median;
use crate::sums::dot;

/// Most harmonics that are fitted, and samples of a period for each.
const HARMONICS: usize = 6;
const SAMPLES_EACH: f64 = 4.0;

/// Samples that a step of the sensor has at least; a sensor without steps has as many values as samples.
const SAMPLES_OF_A_STEP: usize = 4;

/// A sine of `n` steps keeps after rounding a first harmonic that is wrong by a share of at most `(2/(pi n)) sum
/// |J1(2 pi k n)|/k`, some `0.53/n^1.5`; where the steps lie is not known, so that all up to there is as likely.
const COARSE: f64 = 0.304;

/// A point of the Nyquist curve.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Point {
    /// Angular frequency, rad/s.
    pub omega: f64,
    /// `|P|`, unit of the output over that of the input.
    pub magnitude: f64,
    /// Phase, degrees, above -360 and at most 0.
    pub phase_deg: f64,
    /// Standard error of the magnitude.
    pub std_error_magnitude: f64,
    /// Standard error of the phase, degrees.
    pub std_error_phase_deg: f64,
}

impl Point {
    pub(super) fn new(omega: f64, value: Complex<f64>, error: f64) -> Self {
        let phase = libm::atan2(value.im, value.re);
        let phase = if phase > 0.0 { phase - 2.0 * PI } else { phase };
        let magnitude = value.norm();
        Self {
            omega,
            magnitude,
            phase_deg: phase.to_degrees(),
            std_error_magnitude: error,
            std_error_phase_deg: (error / magnitude).to_degrees(),
        }
    }

    /// Whether its error leaves anything of it.
    pub(super) fn is_known(&self) -> bool {
        let magnitude = Value {
            value: self.magnitude,
            std_error: self.std_error_magnitude,
        };
        magnitude.is_known()
    }

    /// Degrees by which its phase lies above -180, from -180 to 180; of a plant of negative gain (`sign` -1) with the
    /// input turned, as its controller turns it.
    pub(super) fn beyond(&self, sign: f64) -> f64 {
        let turned = if sign < 0.0 { 0.0 } else { 180.0 };
        let wrapped = (self.phase_deg + turned + 180.0).rem_euclid(360.0);
        wrapped - 180.0
    }

    /// The point of the plant with the input turned.
    pub(super) fn turned(&self) -> Self {
        Self {
            phase_deg: self.beyond(-1.0) - 180.0,
            ..*self
        }
    }

    /// As a complex number.
    pub fn value(&self) -> Complex<f64> {
        let (sin, cos) = libm::sincos(self.phase_deg.to_radians());
        Complex::new(cos, sin) * self.magnitude
    }
}

/// The point of the cycle; `fit` is the model that helps.
pub(super) fn point(
    record: &Record,
    cycle: &Cycle,
    compared: &Compared,
    fit: Option<&Fit>,
) -> Option<Point> {
    let [from, to] = cycle.window;
    let (whole, noise) = part(record, cycle, compared, fit, from, to)?;
    // The two halves of the window should say the same: where they do not, by so much it is not known.
    let half = cycle.periods / 2;
    let mut error = noise;
    if half >= 1 {
        let middle = from + half as f64 * cycle.period;
        let second = to - half as f64 * cycle.period;
        let halves =
            [(from, middle), (second, to)].map(|(a, b)| part(record, cycle, compared, fit, a, b));
        if let [Some(a), Some(b)] = halves {
            error = error.max(0.5 * (a.0 - b.0).norm() / 2.0_f64.sqrt());
        }
    }
    let value = whole;
    let error = libm::hypot(error, value.norm() * coarse(record, cycle));
    (value.norm() > 0.0 && error.is_finite())
        .then(|| Point::new(2.0 * PI / cycle.period, value, error))
}

/// Relative standard error of the wave that a sensor in steps shows: each period meets the same steps, so that no mean
/// over the periods makes it smaller.
fn coarse(record: &Record, cycle: &Cycle) -> f64 {
    let mut steps = record.sensor_steps();
    if (steps.len() + 1) * SAMPLES_OF_A_STEP > record.output.len() {
        return 0.0;
    }
    let steps = cycle.amplitude / median(&mut steps);
    COARSE * libm::pow(steps, -1.5)
}

/// The point by whole periods from `from` to `to`, and its error from noise.
fn part(
    record: &Record,
    cycle: &Cycle,
    compared: &Compared,
    fit: Option<&Fit>,
    from: f64,
    to: f64,
) -> Option<(Complex<f64>, f64)> {
    let omega = 2.0 * PI / cycle.period;
    let [re, im] = Held::new(&record.time, &record.input).fourier(omega, from, to);
    let input = Complex::new(re, im);
    let inside: Vec<usize> = (0..compared.time.len())
        .filter(|&i| (from..to).contains(&compared.time[i]))
        .collect();
    let time: Vec<f64> = inside.iter().map(|&i| compared.time[i] - from).collect();
    let rest: Vec<f64> = inside
        .iter()
        .map(|&i| compared.output[i] - fit.map_or(0.0, |f| f.simulated[i]))
        .collect();
    let span = to - from;
    let each = inside.len() as f64 * cycle.period / span;
    let harmonics = ((each / SAMPLES_EACH) as usize).clamp(1, HARMONICS);
    let mut columns: Vec<Vec<f64>> = Vec::new();
    for h in 1..=harmonics {
        let waves: Vec<(f64, f64)> = time
            .iter()
            .map(|t| libm::sincos(omega * h as f64 * t))
            .collect();
        columns.push(waves.iter().map(|w| w.1).collect());
        columns.push(waves.iter().map(|w| w.0).collect());
    }
    columns.push(vec![1.0; time.len()]);
    if span > 1.5 * cycle.period {
        columns.push(time.iter().map(|t| t / span - 0.5).collect());
        columns.push(time.iter().map(|t| (t / span - 0.5).powi(2)).collect());
    }
    if time.len() <= columns.len() {
        return None;
    }
    let c = least_squares(&columns, &rest)?;
    let mut left = rest;
    for (c, column) in c.iter().zip(&columns) {
        left.iter_mut().zip(column).for_each(|(r, x)| *r -= c * x);
    }
    let variance = dot(&left, &left) / (time.len() - columns.len()) as f64 * coherence(&left);
    let inverse = inverse_gram(&columns)?;
    let weight = 0.5 * span / input.norm();
    let error = weight * (variance * 0.5 * (inverse[(0, 0)] + inverse[(1, 1)])).sqrt();
    let model = fit.map_or(Complex::new(0.0, 0.0), |f| f.response(omega));
    let value = model + Complex::new(c[0], -c[1]) * (0.5 * span) / input;
    Some((value, error))
}
