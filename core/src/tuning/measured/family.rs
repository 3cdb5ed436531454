//! Points of all lags with dead time whose cycle shows the same numbers.
//!
//! Period, time up, amplitude and hysteresis leave the shape of the plant open. The output of one to three lags under a
//! rectangular input is known in closed form; the dead time follows from the hysteresis, the gain from the amplitude,
//! and the set point lies where the relay switches. A short lag gives a square, a long one a triangle, several nearly a
//! sine: what lies between these is all that the numbers leave open.

use std::f64::consts::PI;

use num_complex::Complex;

use crate::root::bisect;

/// Largest time constants, in periods, and how many are tried.
const LAGS: [f64; 2] = [0.02, 30.0];
const LAGS_TRIED: usize = 40;

/// The other time constants, as shares of the largest; 0: none.
const OTHERS: [[f64; 2]; 6] = [
    [0.0, 0.0],
    [0.1, 0.0],
    [0.3, 0.0],
    [0.7, 0.0],
    [0.6, 0.3],
    [0.8, 0.6],
];

/// Instants of a period at which the output is computed.
const INSTANTS: usize = 400;

/// How far inside what the input reaches the thresholds lie at least, as a share of it: others are met by chance only.
const REACH: f64 = 0.03;

/// What was read off a cycle.
pub(super) struct Seen {
    /// Half of peak to peak.
    pub amplitude: f64,
    pub period: f64,
    /// Time with the input up, s.
    pub up: f64,
    pub hysteresis: f64,
    /// Distance of the levels.
    pub swing: f64,
}

/// Magnitude and phase, degrees, of a plant whose cycle looks so.
#[derive(Clone, Copy, Debug)]
pub(super) struct Member {
    pub magnitude: f64,
    pub phase_deg: f64,
}

/// Lags in a row under a rectangular input from 0 to 1.
struct Shape<'a> {
    lags: &'a [f64],
    weights: Vec<f64>,
    period: f64,
    up: f64,
}

impl Shape<'_> {
    /// The periodic output, up from time 0 on.
    fn at(&self, t: f64) -> f64 {
        let t = t.rem_euclid(self.period);
        let of = |lag: f64| {
            let decay = |s: f64| libm::exp(-s / lag);
            let least = (decay(self.period - self.up) - decay(self.period))
                / -libm::expm1(-self.period / lag);
            let risen = |s: f64| 1.0 - (1.0 - least) * decay(s);
            if t < self.up {
                risen(t)
            } else {
                risen(self.up) * decay(t - self.up)
            }
        };
        self.lags
            .iter()
            .zip(&self.weights)
            .map(|(lag, w)| w * of(*lag))
            .sum()
    }

    /// Outputs at which the relay goes down and up where the output comes so late.
    fn thresholds(&self, late: f64) -> [f64; 2] {
        [self.at(self.up - late), self.at(-late)]
    }

    fn peak_to_peak(&self) -> f64 {
        let instants = (0..INSTANTS).map(|i| self.period * i as f64 / INSTANTS as f64);
        // The corners of a single lag are its extremes.
        let (low, high) = instants
            .chain([self.up])
            .map(|t| self.at(t))
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), y| {
                (a.min(y), b.max(y))
            });
        high - low
    }

    /// The least dead time at which the thresholds are so far apart.
    fn dead_time(&self, apart: f64) -> Option<f64> {
        let excess = |late: f64| {
            let [down, up] = self.thresholds(late);
            down - up - apart
        };
        // Round-off, where the thresholds are the extremes.
        if excess(0.0) < -1e-9 * apart {
            return None;
        }
        let at = |i: usize| self.period * i as f64 / INSTANTS as f64;
        let passed = (1..INSTANTS).find(|&i| excess(at(i)) < 0.0)?;
        let side = |late: f64| 0.0_f64.total_cmp(&excess(late));
        Some(bisect(at(passed - 1), at(passed), side))
    }
}

impl Seen {
    fn member(&self, lags: &[f64]) -> Option<Member> {
        let shape = Shape {
            lags,
            weights: super::compared::partial_fractions(lags),
            period: self.period,
            up: self.up,
        };
        let swing = shape.peak_to_peak();
        let dead_time = shape.dead_time(self.hysteresis / self.amplitude * swing)?;
        let [down, up] = shape.thresholds(dead_time);
        if down > 1.0 - REACH || up < REACH {
            return None;
        }
        let omega = 2.0 * PI / self.period;
        let gain = 2.0 * self.amplitude / (swing * self.swing);
        let turn = |lag: &f64| libm::atan(omega * lag);
        let through: Complex<f64> = lags
            .iter()
            .map(|lag| Complex::new(1.0, omega * lag))
            .product();
        let phase = -omega * dead_time - lags.iter().map(turn).sum::<f64>();
        let magnitude = gain / through.norm();
        (magnitude.is_finite() && magnitude > 0.0).then(|| Member {
            magnitude,
            phase_deg: phase.to_degrees(),
        })
    }

    /// All that were tried and have such a cycle.
    pub fn family(&self) -> Vec<Member> {
        let mut members = Vec::new();
        for i in 0..LAGS_TRIED {
            let share = i as f64 / (LAGS_TRIED - 1) as f64;
            let largest = self.period * LAGS[0] * libm::pow(LAGS[1] / LAGS[0], share);
            for others in OTHERS {
                let lags: Vec<f64> = std::iter::once(largest)
                    .chain(others.iter().filter(|o| **o > 0.0).map(|o| o * largest))
                    .collect();
                members.extend(self.member(&lags));
            }
        }
        members
    }

    /// By the describing function, the output a sine about its own middle; nothing where a sine has no such cycle.
    pub fn sine(&self) -> Option<Member> {
        let share = libm::sin(PI * self.up / self.period);
        let late = self.hysteresis / (self.amplitude * share);
        (late < 1.0).then(|| Member {
            magnitude: PI * self.amplitude / (2.0 * self.swing * share),
            phase_deg: -180.0 + libm::asin(late).to_degrees(),
        })
    }
}
