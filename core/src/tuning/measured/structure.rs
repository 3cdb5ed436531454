//! What a model consists of, and its parameters as they are searched and as they are read.

use num_complex::Complex;
use serde::{Deserialize, Serialize};

use crate::plant::TransferFunction;

/// Largest share of a time constant of the one before: equal ones would make their partial fractions meaningless.
pub(super) const LARGEST_SHARE: f64 = 0.95;

/// What a model consists of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Structure {
    /// `K e^(-Ls)/(T s + 1)`.
    Fopdt,
    /// `K e^(-Ls)/((T1 s + 1)(T2 s + 1))`.
    Sopdt,
    /// `K (Tz s + 1) e^(-Ls)/((T1 s + 1)(T2 s + 1))`; an inverse response where `Tz` is below 0.
    SopdtZero,
    /// `K e^(-Ls)/((T1 s + 1)(T2 s + 1)(T3 s + 1))` with `T1 : T2 = T2 : T3`, for plants of high order.
    Topdt,
    /// `K e^(-Ls)/s`.
    Integrator,
    /// `K e^(-Ls)/(s (T s + 1))`.
    IntegratorLag,
}

impl Structure {
    /// All, simplest first.
    pub const ALL: [Self; 6] = [
        Self::Fopdt,
        Self::Integrator,
        Self::Sopdt,
        Self::IntegratorLag,
        Self::Topdt,
        Self::SopdtZero,
    ];

    /// Its name in files.
    pub const fn id(self) -> &'static str {
        match self {
            Self::Fopdt => "fopdt",
            Self::Sopdt => "sopdt",
            Self::SopdtZero => "sopdt_zero",
            Self::Topdt => "topdt",
            Self::Integrator => "integrator",
            Self::IntegratorLag => "integrator_lag",
        }
    }

    /// Its name in sentences.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Fopdt => "a lag with dead time",
            Self::Sopdt => "two lags with dead time",
            Self::SopdtZero => "two lags with a zero and dead time",
            Self::Topdt => "three lags with dead time",
            Self::Integrator => "an integrator with dead time",
            Self::IntegratorLag => "an integrator with a lag and dead time",
        }
    }

    /// Whether its output goes on rising with a constant input.
    pub const fn integrates(self) -> bool {
        matches!(self, Self::Integrator | Self::IntegratorLag)
    }

    /// Time constants.
    pub(super) const fn lags(self) -> usize {
        match self {
            Self::Integrator => 0,
            Self::Fopdt | Self::IntegratorLag => 1,
            Self::Sopdt | Self::SopdtZero => 2,
            Self::Topdt => 3,
        }
    }

    /// Numbers that are searched for the time constants.
    pub(super) const fn searched(self) -> usize {
        match self {
            Self::Integrator => 0,
            Self::Fopdt | Self::IntegratorLag => 1,
            Self::Sopdt | Self::SopdtZero | Self::Topdt => 2,
        }
    }

    /// Coefficients of the forced response.
    pub(super) const fn forced(self) -> usize {
        match self {
            Self::SopdtZero => 2,
            _ => 1,
        }
    }
}

/// A value with its standard error, both in the value's unit.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Value {
    /// The value.
    pub value: f64,
    /// Its standard error.
    pub std_error: f64,
}

/// Relative standard error from which a gain is not known.
const VAGUE: f64 = 0.5;

impl Value {
    /// Whether its error leaves anything of it.
    pub(super) fn is_known(&self) -> bool {
        self.std_error < VAGUE * self.value.abs()
    }
}

/// A model with the standard errors of its parameters.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FittedModel {
    /// What it consists of.
    pub structure: Structure,
    /// Static gain, unit of the output over that of the input; of an integrator its velocity gain, per s.
    pub gain: Value,
    /// Time constants, s, the largest first.
    pub time_constants: Vec<Value>,
    /// Time constant of the zero, s.
    pub zero: Option<Value>,
    /// Dead time, s.
    pub dead_time: Value,
    /// Output without input (the surroundings); of an integrator the input that holds it still.
    pub operating_point: f64,
    /// Root mean square of what it misses over that of the motion, on the record itself.
    pub left: f64,
    /// Whether it is the one that the data prefer.
    pub preferred: bool,
}

impl FittedModel {
    /// Real and imaginary part of the response at `omega` rad/s.
    pub fn response(&self, omega: f64) -> [f64; 2] {
        let s = Complex::new(0.0, omega);
        let one = Complex::new(1.0, 0.0);
        let pole = if self.structure.integrates() { s } else { one };
        let lags = (self.time_constants.iter()).fold(pole, |p, t| p * (s * t.value + 1.0));
        let lead = self.zero.map_or(one, |z| s * z.value + 1.0);
        let (sin, cos) = libm::sincos(-omega * self.dead_time.value);
        let value = lead * self.gain.value * Complex::new(cos, sin) / lags;
        [value.re, value.im]
    }

    /// As a plant.
    pub fn plant(&self) -> TransferFunction {
        let mut denominator = if self.structure.integrates() {
            vec![1.0, 0.0]
        } else {
            vec![1.0]
        };
        for t in &self.time_constants {
            denominator = crate::tuning::scan::product(&denominator, &[t.value, 1.0]);
        }
        let k = self.gain.value;
        let numerator = self.zero.map_or_else(|| vec![k], |z| vec![k * z.value, k]);
        TransferFunction::new(&numerator, &denominator, self.dead_time.value)
    }
}
/// Time constants, largest first and 0 where there are none, and dead time, s, of what is searched.
pub(super) fn times(structure: Structure, p: &[f64], scale: f64) -> ([f64; 3], f64) {
    let searched = structure.searched();
    let first = if searched > 0 {
        scale * libm::exp(p[0])
    } else {
        0.0
    };
    let share = if searched > 1 {
        LARGEST_SHARE / (1.0 + libm::exp(-p[1]))
    } else {
        0.0
    };
    let third = if structure.lags() > 2 {
        first * share * share
    } else {
        0.0
    };
    ([first, first * share, third], scale * p[searched].abs())
}

/// Static or velocity gain, three time constants, zero and dead time.
pub(super) fn physical(structure: Structure, theta: &[f64], scale: f64) -> [f64; 6] {
    let forced = structure.forced();
    let ([t1, t2, t3], dead_time) = times(structure, &theta[forced..], scale);
    if structure == Structure::SopdtZero {
        let gain = theta[0] + theta[1];
        return [
            gain,
            t1,
            t2,
            t3,
            (theta[0] * t2 + theta[1] * t1) / gain,
            dead_time,
        ];
    }
    [theta[0], t1, t2, t3, 0.0, dead_time]
}

pub(super) fn response(
    structure: Structure,
    theta: &[f64],
    scale: f64,
    omega: f64,
) -> Complex<f64> {
    let [gain, t1, t2, t3, zero, dead_time] = physical(structure, theta, scale);
    let s = Complex::new(0.0, omega);
    let pole = if structure.integrates() {
        s
    } else {
        Complex::new(1.0, 0.0)
    };
    let lags = (s * t1 + 1.0) * (s * t2 + 1.0) * (s * t3 + 1.0);
    let (sin, cos) = libm::sincos(-omega * dead_time);
    (s * zero + 1.0) * gain * Complex::new(cos, sin) / (pole * lags)
}
