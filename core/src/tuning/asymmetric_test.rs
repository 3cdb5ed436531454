//! A model from one test with an asymmetric relay.
//!
//! A relay that pushes harder one way makes half periods of different length, whose ratio tells the
//! normalised dead time `L/(L + T)`, and an input with a mean, which tells the static gain:
//!
//! - Berner, Hägglund and Åström (2016): first-order lag with dead time (FOTD) from the ratio of the half
//!   periods, the integrals, and the half-period equations;
//! - Shen, Wu and Yu (1996): two points of the Nyquist curve, at 0 and at the oscillation's frequency,
//!   from the same test, and the first-order lag with dead time through both. They took the second point
//!   from the describing function; here it is the ratio of Fourier coefficients, which is exact.

use std::f64::consts::{FRAC_PI_2, PI};

use serde::{Deserialize, Serialize};

use super::error::TuningError;
use super::experiment::RelayTest;
use super::moving_point::NyquistPoint;
use crate::plant::TransferFunction;
use crate::relay::Relay;

/// A model for tuning rules.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Model {
    /// `K e^(-Ls)/(T s + 1)`.
    Lag {
        /// Static gain `K`.
        gain: f64,
        /// Time constant `T`, s.
        time_constant: f64,
        /// Dead time `L`, s.
        dead_time: f64,
    },
    /// `K e^(-Ls)/s`.
    Integrating {
        /// Velocity gain `K`, per s.
        gain: f64,
        /// Dead time `L`, s.
        dead_time: f64,
    },
}

impl Model {
    /// As a plant.
    pub fn plant(&self) -> TransferFunction {
        match *self {
            Self::Lag {
                gain,
                time_constant,
                dead_time,
            } => TransferFunction::new(&[gain], &[time_constant, 1.0], dead_time),
            Self::Integrating { gain, dead_time } => {
                TransferFunction::new(&[gain], &[1.0, 0.0], dead_time)
            }
        }
    }
}

/// What one asymmetric relay test tells.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AsymmetricTest {
    /// The test.
    pub test: RelayTest,
    /// Ratio of the relay's outputs, the larger over the smaller.
    pub asymmetry_ratio: f64,
    /// Ratio of the half periods, the longer over the shorter.
    pub half_period_ratio: f64,
    /// Normalised dead time `L/(L + T)` by the formula of Berner et al.; near 0 for an integrator.
    pub normalised_dead_time: f64,
    /// Integral of the output over that of the input; `None` for an integrating plant.
    pub static_gain: Option<f64>,
    /// Point of the Nyquist curve at the oscillation's frequency.
    pub point: NyquistPoint,
    /// Model by Berner, Hägglund and Åström (2016).
    pub berner: Result<Model, TuningError>,
    /// Model by Shen, Wu and Yu (1996).
    pub shen: Result<Model, TuningError>,
}

/// Least difference from 1 of both ratios that tells something.
const LEAST_ASYMMETRY: f64 = 1e-6;

/// Normalised dead times beyond which the formula's models would have no time constant or no dead time
/// left.
const NORMALISED_RANGE: [f64; 2] = [0.005, 0.98];

/// `tau = (gamma - rho)/((gamma - 1)(0.35 rho + 0.65))`: the normalised dead time from the ratio `gamma`
/// of the relay's outputs and `rho` of the half periods (Berner, Hägglund and Åström 2016).
pub fn normalised_dead_time(asymmetry_ratio: f64, half_period_ratio: f64) -> f64 {
    let (gamma, rho) = (asymmetry_ratio, half_period_ratio);
    (gamma - rho) / ((gamma - 1.0) * (0.35 * rho + 0.65))
}

/// Times with the relay up and down, s, of a first-order lag or an integrator with dead time under
/// `relay`: the half-period equations. With `d1`, `d2` the relay's outputs up and down,
///
/// - lag: `t_on = T ln((eps/K - d2 + e^(L/T) (d1 + d2))/(d1 - eps/K))`;
/// - integrator: `t_on = L (1 + d2/d1) + 2 eps/(K d1)`;
///
/// and `t_off` with `d1` and `d2` exchanged. `None` where the relay does not reach its threshold.
///
/// ```
/// use hysteron_core::{relay::Relay, tuning::{Model, half_periods}};
/// let relay = Relay { hysteresis: 0.0, ..Relay::default() };
/// let model = Model::Lag { gain: 1.0, time_constant: 1.0, dead_time: 0.5 };
/// let (on, off) = half_periods(&model, &relay).unwrap();
/// assert!((on - (2.0 * 0.5_f64.exp() - 1.0).ln()).abs() < 1e-14 && on == off);
/// ```
pub fn half_periods(model: &Model, relay: &Relay) -> Option<(f64, f64)> {
    let (d1, d2) = (relay.output(false), -relay.output(true));
    let part = |push: f64, pull: f64| match *model {
        Model::Lag {
            gain,
            time_constant,
            dead_time,
        } => time_constant * logarithm(gain, dead_time / time_constant, relay, push, pull),
        Model::Integrating { gain, dead_time } => {
            dead_time * (1.0 + pull / push) + 2.0 * relay.hysteresis / (gain * push)
        }
    };
    let (on, off) = (part(d1, d2), part(d2, d1));
    (on > 0.0 && off > 0.0 && on.is_finite() && off.is_finite()).then_some((on, off))
}

/// Half period over the time constant.
fn logarithm(gain: f64, ratio: f64, relay: &Relay, push: f64, pull: f64) -> f64 {
    let eps = relay.hysteresis / gain.abs();
    libm::log((eps - pull + libm::exp(ratio) * (push + pull)) / (push - eps))
}

/// Identifies both models from the `test`.
///
/// # Errors
/// [`TuningError::Symmetric`] where the half periods or the relay's outputs are equal.
pub fn identify(test: RelayTest) -> Result<AsymmetricTest, TuningError> {
    let outputs = [test.relay.output(false), -test.relay.output(true)];
    let larger = |a: f64, b: f64| a.max(b) / a.min(b);
    let gamma = larger(outputs[0], outputs[1]);
    let rho = larger(test.on_time, test.off_time);
    // A pure dead time has equal half periods under any relay: only the relay must be asymmetric.
    if !(gamma - 1.0 > LEAST_ASYMMETRY && rho.is_finite()) {
        return Err(TuningError::Symmetric {
            on: test.on_time,
            off: test.off_time,
            asymmetry: test.relay.asymmetry,
        });
    }
    let normalised = normalised_dead_time(gamma, rho);
    let static_gain = test.static_gain();
    let point = NyquistPoint {
        omega: test.omega,
        value: test.fourier_point,
    };
    Ok(AsymmetricTest {
        berner: berner(&test, normalised, static_gain),
        shen: shen(&point, static_gain),
        asymmetry_ratio: gamma,
        half_period_ratio: rho,
        normalised_dead_time: normalised,
        static_gain,
        point,
        test,
    })
}

fn berner(
    test: &RelayTest,
    normalised: f64,
    static_gain: Option<f64>,
) -> Result<Model, TuningError> {
    let relay = &test.relay;
    let (d1, d2) = (relay.output(false), -relay.output(true));
    let Some(gain) = static_gain.filter(|_| normalised > NORMALISED_RANGE[0]) else {
        // An integrator with dead time: both half-period equations say the same, so the amplitude,
        // 2a = 2 eps + K L (d1 + d2), stands in for one of them.
        let swing = 2.0 * test.amplitude;
        let gain = swing / (test.on_time * d1);
        return Ok(Model::Integrating {
            gain,
            dead_time: (swing - 2.0 * relay.hysteresis) / (gain * (d1 + d2)),
        });
    };
    let normalised = normalised.min(NORMALISED_RANGE[1]);
    let ratio = normalised / (1.0 - normalised);
    let times = [
        test.on_time / logarithm(gain, ratio, relay, d1, d2),
        test.off_time / logarithm(gain, ratio, relay, d2, d1),
    ];
    let time_constant = 0.5 * (times[0] + times[1]);
    let fits = times.iter().all(|t| t.is_finite() && *t > 0.0);
    if !fits {
        return Err(TuningError::NotFirstOrder {
            what: "the time constant from the half periods".into(),
            value: times[0].min(times[1]),
            range: "above 0 s".into(),
        });
    }
    Ok(Model::Lag {
        gain,
        time_constant,
        dead_time: ratio * time_constant,
    })
}

/// `T = sqrt((K/|P|)^2 - 1)/w`, `L = (-arg P - atan(w T))/w`; for an integrating plant `K = |P| w`,
/// `L = (-arg P - pi/2)/w`.
fn shen(point: &NyquistPoint, static_gain: Option<f64>) -> Result<Model, TuningError> {
    let omega = point.omega;
    let size = libm::hypot(point.value[0], point.value[1]);
    // The lag of an oscillating loop lies between a quarter and almost a whole turn.
    let angle = libm::atan2(point.value[1], point.value[0]);
    let late = if angle > 0.0 {
        2.0 * PI - angle
    } else {
        -angle
    };
    let Some(gain) = static_gain else {
        return checked(Model::Integrating {
            gain: size * omega,
            dead_time: (late - FRAC_PI_2) / omega,
        });
    };
    let ratio = gain / size;
    if ratio < 1.0 {
        return Err(TuningError::NotFirstOrder {
            what: "the static gain over that at the oscillation".into(),
            value: ratio,
            range: "above 1".into(),
        });
    }
    let turn = ((ratio - 1.0) * (ratio + 1.0)).sqrt();
    checked(Model::Lag {
        gain,
        time_constant: turn / omega,
        dead_time: (late - libm::atan(turn)) / omega,
    })
}

fn checked(model: Model) -> Result<Model, TuningError> {
    let (Model::Lag { dead_time, .. } | Model::Integrating { dead_time, .. }) = model;
    if dead_time >= 0.0 {
        return Ok(model);
    }
    Err(TuningError::NotFirstOrder {
        what: "the dead time from the phase".into(),
        value: dead_time,
        range: "0 s or more".into(),
    })
}
