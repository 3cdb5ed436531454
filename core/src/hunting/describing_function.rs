//! Hunting by the first harmonic: for `x = A sin wt` the balance of
//!
//! ```text
//! -J w^2 + N_c(A) + jw (viscous + D + N_f(w A)) + (P + I/(jw)) N_p(A) = 0
//! ```
//!
//! with the describing functions of dry friction at the velocity, of cogging and of play at the position (Gelb and
//! Vander Velde 1968). What sticks is beyond it: friction is that of a sine, which never rests.

use std::f64::consts::PI;

use num_complex::Complex;
use serde::{Deserialize, Serialize};

use super::servo::{Friction, Servo};
use crate::drive::play_describing_function;
use crate::root::illinois;

/// A solution of the harmonic balance.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct HuntingBalance {
    /// Angular frequency, rad/s.
    pub omega: f64,
    /// Period, s.
    pub period: f64,
    /// Amplitude of the motor's position, rad (or m).
    pub motor_amplitude: f64,
    /// The same of the measured one: `|N_p| A`.
    pub amplitude: f64,
    /// Whether a slightly larger swing dies down to it (Loeb's criterion).
    pub stable: Option<bool>,
}

/// Points of the scans in amplitude and frequency, and their decades.
const AMPLITUDES: u32 = 400;
const FREQUENCIES: u32 = 400;
const AMPLITUDE_DECADES: f64 = 4.0;
const FREQUENCY_DECADES: f64 = 4.0;

/// Points of a quarter of a sine.
const QUARTER: u32 = 48;

/// Most balances that are reported.
const MOST: usize = 20;

/// Describing function of dry friction for a velocity of this amplitude: `4/(pi V) int_0^(pi/2) F(V sin t) sin t dt`.
pub fn friction_gain(friction: &Friction, speed: f64) -> f64 {
    if friction.excess == 0.0 || friction.stribeck_speed == 0.0 {
        return 4.0 * friction.coulomb / (PI * speed);
    }
    // The excess alone needs a sum (midpoints); the level has a closed form.
    let step = 0.5 * PI / f64::from(QUARTER);
    let sum: f64 = (0..QUARTER)
        .map(|k| {
            let s = libm::sin((f64::from(k) + 0.5) * step);
            (friction.moving(speed * s) - friction.coulomb) * s * step
        })
        .sum();
    4.0 * (friction.coulomb + sum) / (PI * speed)
}

/// All balances, by rising amplitude; none for an invalid servo.
pub fn describing_function(servo: &Servo) -> Vec<HuntingBalance> {
    if servo.validate().is_err() {
        return Vec::new();
    }
    let balance = Balance { servo };
    let mut found: Vec<HuntingBalance> = Vec::new();
    let mut last: Option<(f64, Vec<(f64, f64)>)> = None;
    for i in 0..=AMPLITUDES {
        let amplitude = balance.amplitude(f64::from(i) / f64::from(AMPLITUDES));
        let here: Vec<(f64, f64)> = balance
            .frequencies(amplitude)
            .into_iter()
            .map(|omega| (omega, balance.value(amplitude, omega).im))
            .collect();
        if let Some((before, old)) = &last
            && old.len() == here.len()
        {
            for (k, (a, b)) in old.iter().zip(&here).enumerate() {
                if (a.1 < 0.0) != (b.1 < 0.0) {
                    found.extend(balance.solve((*before, a.1), (amplitude, b.1), k));
                }
            }
        }
        last = Some((amplitude, here));
    }
    found.truncate(MOST);
    found
}

struct Balance<'a> {
    servo: &'a Servo,
}

impl Balance<'_> {
    /// An amplitude of the scan, at a share of its logarithmic range.
    fn amplitude(&self, share: f64) -> f64 {
        let servo = self.servo;
        let stiffness = servo.controller.proportional;
        let dry = servo.friction.breakaway() + servo.cogging.map_or(0.0, |c| c.amplitude);
        let size = servo.half_gap.max(dry / stiffness);
        let size = if size > 0.0 { size } else { 1.0 };
        size * libm::pow(10_f64, AMPLITUDE_DECADES * (share - 0.5))
    }

    fn value(&self, amplitude: f64, omega: f64) -> Complex<f64> {
        let servo = self.servo;
        let c = &servo.controller;
        let play = play_describing_function(amplitude, servo.half_gap).unwrap_or_default();
        let cogging = servo.cogging.map_or(0.0, |cogging| {
            2.0 * cogging.amplitude * libm::j1(cogging.per_turn * amplitude) / amplitude
        });
        let dry = friction_gain(&servo.friction, omega * amplitude);
        let body = Complex::new(
            cogging - servo.inertia * omega * omega,
            omega * (servo.viscous + c.derivative + dry),
        );
        body + Complex::new(c.proportional, -c.integral / omega) * play
    }

    /// Frequencies at which the real part balances.
    fn frequencies(&self, amplitude: f64) -> Vec<f64> {
        let typical = 1.0 / self.servo.typical_time();
        let omega = |k: u32| {
            let share = f64::from(k) / f64::from(FREQUENCIES) - 0.8;
            typical * libm::pow(10_f64, FREQUENCY_DECADES * share)
        };
        let off = |omega: f64| self.value(amplitude, omega).re;
        let mut found = Vec::new();
        let mut last = (omega(0), off(omega(0)));
        for k in 1..=FREQUENCIES {
            let next = (omega(k), off(omega(k)));
            if (last.1 < 0.0) != (next.1 < 0.0) {
                found.push(illinois(last, next, off));
            }
            last = next;
        }
        found
    }

    /// Where the imaginary part of the frequency number `k` balances as well.
    fn solve(&self, low: (f64, f64), high: (f64, f64), k: usize) -> Option<HuntingBalance> {
        let off = |amplitude: f64| {
            let omega = self.frequencies(amplitude).get(k).copied();
            omega.map_or(f64::NAN, |omega| self.value(amplitude, omega).im)
        };
        let motor = illinois(low, high, off);
        let omega = self.frequencies(motor).get(k).copied()?;
        let play = play_describing_function(motor, self.servo.half_gap)?;
        let [step_a, step_w] = [1e-5 * motor, 1e-5 * omega];
        let by_a = self.value(motor + step_a, omega) - self.value(motor - step_a, omega);
        let by_w = self.value(motor, omega + step_w) - self.value(motor, omega - step_w);
        // Loeb: dU/dA dV/dw - dU/dw dV/dA > 0.
        let cross = by_a.re * by_w.im - by_w.re * by_a.im;
        Some(HuntingBalance {
            omega,
            period: 2.0 * PI / omega,
            motor_amplitude: motor,
            amplitude: motor * play.norm(),
            stable: (cross != 0.0 && cross.is_finite()).then_some(cross > 0.0),
        })
    }
}
