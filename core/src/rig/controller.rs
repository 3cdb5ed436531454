//! The sampled controller of the bench.

use std::f64::consts::TAU;

use super::{Excitation, Random};

/// Where a servo shall be, from -1 to 1, after so many moves: each goes to a new place within three fifths of
/// its time, with the least jerk (Flash and Hogan 1985).
fn move_at(moves: f64) -> f64 {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let place = |k: f64| {
        if k <= 0.0 {
            0.0
        } else {
            2.0 * (k * GOLDEN).fract() - 1.0
        }
    };
    let from = moves.floor();
    let s = ((moves - from) / 0.6).min(1.0);
    let share = s.powi(3) * (10.0 - 15.0 * s + 6.0 * s * s);
    place(from) + (place(from + 1.0) - place(from)) * share
}

/// The controller and what it keeps.
pub(super) struct Controller {
    excitation: Excitation,
    high: bool,
    /// Frequency (rad/s) and phase.
    sines: Vec<(f64, f64)>,
    /// Sampling time, s.
    sampling: f64,
    /// Error of the position one sample ago, rad.
    error: Option<f64>,
}

impl Controller {
    pub(super) fn new(excitation: Excitation, sampling: f64, random: &mut Random) -> Self {
        let sines = (0..10)
            .map(|i| {
                (
                    TAU * libm::pow(40_f64, f64::from(i) / 9.0),
                    TAU * random.uniform(),
                )
            })
            .collect();
        Self {
            excitation,
            high: false,
            sines,
            sampling,
            error: None,
        }
    }

    /// The torque command at time `t` (s) for the position and velocity that are measured.
    pub(super) fn command(&mut self, t: f64, position: f64, velocity: f64) -> f64 {
        match self.excitation {
            Excitation::Relay {
                gain,
                asymmetry,
                hysteresis,
                flip,
            } => {
                if velocity > hysteresis {
                    self.high = true;
                } else if velocity < -hysteresis {
                    self.high = false;
                }
                let turned = flip.is_some_and(|period| (t / period) as u64 % 2 == 1);
                let asymmetry = if turned { -asymmetry } else { asymmetry };
                if self.high {
                    -gain * (1.0 - asymmetry)
                } else {
                    gain * (1.0 + asymmetry)
                }
            }
            Excitation::Proposed(proposed) => proposed.input(t, velocity, &mut self.high),
            Excitation::Multisine { amplitude } => self
                .sines
                .iter()
                .map(|(omega, phase)| amplitude * libm::sin(omega * t + phase))
                .sum(),
            Excitation::Staircase { top } => {
                const SHARES: [f64; 5] = [0.4, 0.55, 0.7, 0.85, 1.0];
                let slot = (t / 0.0625) as usize;
                let level = top * SHARES.get(slot / 4 % SHARES.len()).unwrap_or(&1.0);
                match slot % 4 {
                    0 => level,
                    2 => -level,
                    _ => 0.0,
                }
            }
            Excitation::Servo {
                reach,
                period,
                stiffness,
                damping,
            } => {
                let error = reach * move_at(t / period) - position;
                let rate = self.error.map_or(0.0, |e| (error - e) / self.sampling);
                self.error = Some(error);
                stiffness * error + damping * rate
            }
        }
    }
}
