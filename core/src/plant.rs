//! What does the relay act on? Equation (1): a linear plant with dead time.

use nalgebra::{Complex, DMatrix, DVector};
use serde::{Deserialize, Serialize};

/// Highest order that is accepted.
pub const MAX_ORDER: usize = 12;

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

/// Why a plant cannot be.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PlantError {
    /// A coefficient that is no number.
    #[error("a coefficient is not finite: every coefficient must be a number")]
    NotFinite,
    /// Order out of range.
    #[error(
        "the denominator has order {0}: it must be 1 to {MAX_ORDER}, its first coefficient not 0"
    )]
    Order(usize),
    /// Numerator of too high an order.
    #[error(
        "the numerator has order {numerator}, the denominator {denominator}: the numerator's must be lower"
    )]
    NotProper {
        /// Order of the numerator.
        numerator: usize,
        /// Order of the denominator.
        denominator: usize,
    },
    /// Negative dead time.
    #[error("dead time {0} s: must be 0 or more")]
    DeadTime(f64),
}

/// `x' = A x + B u`, `y = C x`.
#[derive(Clone, Debug, PartialEq)]
pub struct StateSpace {
    /// Dynamics, n x n, 1/s.
    pub a: DMatrix<f64>,
    /// Input, n.
    pub b: DVector<f64>,
    /// Output, n.
    pub c: DVector<f64>,
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
    fn trimmed(&self) -> &[f64] {
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
        if order == 0 || order > MAX_ORDER || self.denominator[0] == 0.0 {
            return Err(PlantError::Order(order));
        }
        let numerator = self.trimmed().len().saturating_sub(1);
        if numerator >= order {
            return Err(PlantError::NotProper {
                numerator,
                denominator: order,
            });
        }
        if !(self.dead_time.is_finite() && self.dead_time >= 0.0) {
            return Err(PlantError::DeadTime(self.dead_time));
        }
        Ok(())
    }

    /// Frequency response at `omega` rad/s, dead time included.
    pub fn response(&self, omega: f64) -> Complex<f64> {
        let s = Complex::new(0.0, omega);
        let horner = |p: &[f64]| p.iter().fold(Complex::new(0.0, 0.0), |acc, c| acc * s + *c);
        horner(&self.numerator) / horner(&self.denominator)
            * Complex::from_polar(1.0, -omega * self.dead_time)
    }

    /// Controllable canonical form of a valid transfer function, without the dead time.
    pub fn state_space(&self) -> StateSpace {
        let n = self.denominator.len() - 1;
        let lead = self.denominator[0];
        let mut a = DMatrix::zeros(n, n);
        let mut c = DVector::zeros(n);
        for i in 0..n {
            a[(0, i)] = -self.denominator[i + 1] / lead;
            if i + 1 < n {
                a[(i + 1, i)] = 1.0;
            }
        }
        let numerator = self.trimmed();
        for (i, value) in numerator.iter().rev().enumerate() {
            c[n - 1 - i] = value / lead;
        }
        let mut b = DVector::zeros(n);
        b[0] = 1.0;
        StateSpace { a, b, c }
    }
}

/// A plant to explore.
pub struct Preset {
    /// Its name.
    pub name: &'static str,
    /// One sentence about it.
    pub sentence: &'static str,
    /// The plant.
    pub plant: TransferFunction,
}

/// The plants that *Explore* offers.
pub fn presets() -> Vec<Preset> {
    let preset = |name, sentence, numerator: &[f64], denominator: &[f64], dead_time| Preset {
        name,
        sentence,
        plant: TransferFunction::new(numerator, denominator, dead_time),
    };
    vec![
        preset(
            "Third-order lag",
            "Three equal storages in a row.",
            &[1.0],
            &[1.0, 3.0, 3.0, 1.0],
            0.0,
        ),
        preset(
            "Fourth-order lag",
            "Four equal storages in a row.",
            &[1.0],
            &[1.0, 4.0, 6.0, 4.0, 1.0],
            0.0,
        ),
        preset(
            "Lag with dead time",
            "One storage behind a transport belt.",
            &[1.0],
            &[1.0, 1.0],
            0.5,
        ),
        preset(
            "Integrator with lags",
            "A positioning drive.",
            &[1.0],
            &[1.0, 3.0, 2.0, 0.0],
            0.0,
        ),
        preset(
            "Resonant",
            "A storage and a weakly damped oscillation.",
            &[4.0],
            &[1.0, 1.8, 4.8, 4.0],
            0.0,
        ),
        preset(
            "Non-minimum phase",
            "It first moves the wrong way.",
            &[-1.0, 1.0],
            &[1.0, 2.0, 1.0],
            0.0,
        ),
    ]
}
