//! Plants as a ratio of polynomials.

use num_complex::Complex;
use serde::{Deserialize, Serialize};

use super::{MAX_ORDER, PlantError, roots};

/// A strictly proper transfer function with dead time, highest power first.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TransferFunction {
    /// Numerator coefficients, highest power first.
    pub numerator: Vec<f64>,
    /// Denominator coefficients, highest power first; the first is not 0.
    pub denominator: Vec<f64>,
    /// Dead time, s; at least 0.
    #[serde(default)]
    pub dead_time: f64,
}

impl TransferFunction {
    /// Numerator and denominator, highest power first, and dead time in s.
    pub fn new(numerator: &[f64], denominator: &[f64], dead_time: f64) -> Self {
        Self {
            numerator: numerator.to_vec(),
            denominator: denominator.to_vec(),
            dead_time,
        }
    }

    /// Numerator without leading zeros.
    pub(super) fn trimmed(&self) -> &[f64] {
        let zeros = self.numerator.iter().take_while(|c| **c == 0.0).count();
        &self.numerator[zeros..]
    }

    /// Checks coefficients, orders and dead time.
    pub fn validate(&self) -> Result<(), PlantError> {
        if self
            .numerator
            .iter()
            .chain(&self.denominator)
            .any(|c| !c.is_finite())
        {
            return Err(PlantError::NotFinite);
        }
        let order = self.denominator.len().saturating_sub(1);
        let Some(lead) = self.denominator.first() else {
            return Err(PlantError::Order(0));
        };
        if order == 0 || order > MAX_ORDER || *lead == 0.0 {
            return Err(PlantError::Order(order));
        }
        let Some(numerator) = self.trimmed().len().checked_sub(1) else {
            return Err(PlantError::NoNumerator);
        };
        if numerator >= order {
            return Err(PlantError::NotProper {
                numerator,
                denominator: order,
            });
        }
        let ratios = self.numerator.iter().chain(&self.denominator);
        if ratios.into_iter().any(|c| !(c / lead).is_finite()) {
            return Err(PlantError::Range);
        }
        if !(self.dead_time.is_finite() && self.dead_time >= 0.0) {
            return Err(PlantError::DeadTime(self.dead_time));
        }
        Ok(())
    }

    /// Frequency response at `omega` rad/s, dead time included; not finite on a pole.
    pub fn response(&self, omega: f64) -> Complex<f64> {
        let rational = horner(&self.numerator, omega) / horner(&self.denominator, omega);
        if self.dead_time == 0.0 {
            rational
        } else {
            rational * Complex::from_polar(1.0, -omega * self.dead_time)
        }
    }

    /// Value at `s = 0`: the output in the end per constant input; infinite with an integrator, not a
    /// number for an invalid plant.
    pub fn dc_gain(&self) -> f64 {
        let (n, d) = (self.numerator.last(), self.denominator.last());
        match (n, d) {
            (Some(n), Some(d)) if *d != 0.0 => n / d,
            (Some(n), Some(_)) if *n != 0.0 => {
                // The sign is that of the lowest power that the denominator has.
                let lowest = self.denominator.iter().rev().find(|c| **c != 0.0);
                lowest.map_or(f64::NAN, |c| f64::INFINITY.copysign(n * c.signum()))
            }
            _ => f64::NAN,
        }
    }

    /// Order of the denominator minus order of the numerator; 0 for an invalid plant.
    pub fn relative_degree(&self) -> usize {
        self.denominator.len().saturating_sub(self.trimmed().len())
    }

    /// Poles, 1/s, by rising distance from 0; empty for an invalid plant.
    pub fn poles(&self) -> Vec<Complex<f64>> {
        if self.validate().is_err() {
            Vec::new()
        } else {
            roots(&self.denominator)
        }
    }

    /// Zeros, 1/s, by rising distance from 0; empty for an invalid plant.
    pub fn zeros(&self) -> Vec<Complex<f64>> {
        if self.validate().is_err() {
            Vec::new()
        } else {
            roots(self.trimmed())
        }
    }
}

/// Polynomial at `j omega`: even powers are real, odd ones imaginary.
fn horner(p: &[f64], omega: f64) -> Complex<f64> {
    let square = -omega * omega;
    let sum = |skip: usize| {
        let mut value = 0.0;
        let length = p.len();
        // Powers skip, skip + 2, ... counted from the end.
        let mut k = if length > skip {
            (length - 1 - skip) / 2 * 2 + skip
        } else {
            return 0.0;
        };
        loop {
            value = value * square + p[length - 1 - k];
            if k < 2 {
                return value;
            }
            k -= 2;
        }
    };
    Complex::new(sum(0), omega * sum(1))
}
