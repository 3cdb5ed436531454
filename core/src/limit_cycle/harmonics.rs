//! Which harmonics a cycle has.

use std::f64::consts::PI;

use num_complex::Complex;
use serde::{Deserialize, Serialize};

use super::ExactCycle;
use crate::plant::TransferFunction;
use crate::relay::Relay;

/// One harmonic of the output, `amplitude cos(n w t + phase)` with `t = 0` at the relay's rise.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Harmonic {
    /// Order `n`, from 1.
    pub order: usize,
    /// Amplitude, in the unit of the output.
    pub amplitude: f64,
    /// Phase, rad.
    pub phase: f64,
}

/// The first `count` harmonics of the output in a cycle: the plant's response times the Fourier
/// coefficients of the relay's rectangular wave, so that they are exact.
pub fn harmonics(
    plant: &TransferFunction,
    relay: &Relay,
    cycle: &ExactCycle,
    count: usize,
) -> Vec<Harmonic> {
    let period = cycle.cycle.period;
    let omega = 2.0 * PI / period;
    let step = relay.output(true) - relay.output(false);
    (1..=count)
        .map(|order| {
            let w = order as f64 * omega;
            // 2/T int_0^h1 e^{-jwt} dt, later by the relay's delay.
            let wave = (Complex::new(1.0, 0.0) - Complex::from_polar(1.0, -w * cycle.durations[0]))
                / Complex::new(0.0, w);
            let delayed = wave * Complex::from_polar(2.0 / period * step.abs(), -w * relay.delay);
            let value = -plant.response(w) * delayed;
            Harmonic {
                order,
                amplitude: value.norm(),
                phase: value.arg(),
            }
        })
        .collect()
}
