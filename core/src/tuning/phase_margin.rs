//! Equation (7): the relay whose oscillation shows the gain for a required phase margin.
//!
//! Derived after Åström and Hägglund (1984). With `eps = a sin(phi)` the describing function gives
//! `-1/N(a) = -pi a/(4k) (cos(phi) + j sin(phi))`, the ray at `-pi + phi`; with `k = pi a/4` besides it
//! is the point `e^(j(-pi + phi))` of the unit circle. So a loop with the gain `K` in series that
//! oscillates with just this amplitude `a` has `K P(jw) = e^(j(-pi + phi))`: without the relay, the
//! proportional controller `K` has the phase margin `phi`, as far as the describing function is right.

use std::f64::consts::{FRAC_PI_2, PI};

use serde::{Deserialize, Serialize};

use super::error::{TuningError, check};
use crate::relay::Relay;

/// A relay for a phase margin.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RelayDesign {
    /// Required phase margin, rad.
    pub phase_margin: f64,
    /// Amplitude at which the loop must oscillate, half of peak to peak.
    pub amplitude: f64,
    /// Gain `k = pi a/4`.
    pub gain: f64,
    /// Hysteresis `eps = a sin(phi)`, unit of the output.
    pub hysteresis: f64,
}

impl RelayDesign {
    /// Equation (7) for a `phase_margin` in rad, 0 to less than pi/2, and an `amplitude` above 0.
    ///
    /// # Errors
    /// [`TuningError::Setting`].
    pub fn new(phase_margin: f64, amplitude: f64) -> Result<Self, TuningError> {
        let fits = (0.0..FRAC_PI_2).contains(&phase_margin);
        check(
            "phase margin",
            phase_margin,
            fits,
            "0 to less than pi/2 rad",
        )?;
        check("amplitude", amplitude, amplitude > 0.0, "above 0")?;
        Ok(Self {
            phase_margin,
            amplitude,
            gain: 0.25 * PI * amplitude,
            hysteresis: amplitude * libm::sin(phase_margin),
        })
    }

    /// The relay with the proportional gain `series` behind it.
    pub fn relay(&self, series: f64) -> Relay {
        Relay {
            gain: series * self.gain,
            hysteresis: self.hysteresis,
            ..Relay::default()
        }
    }
}
