//! The describing function: the cycle that the first harmonic alone would have, equations (5) and (6).

use std::f64::consts::PI;

use nalgebra::{Matrix3, Vector3};
use num_complex::Complex;
use serde::{Deserialize, Serialize};

use super::cycle::Cycle;
use crate::plant::{TransferFunction, ZeroPoleGain};
use crate::relay::Relay;
use crate::root::{SECTIONS, golden_section, illinois};

/// An intersection of the Nyquist curve with `-1/N(a)`: a solution of `N(a) P(jw) + 1 = 0`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Intersection {
    /// Real and imaginary part of `P(jw)`, all delays included.
    pub point: [f64; 2],
    /// Angular frequency, rad/s.
    pub omega: f64,
    /// The cycle that the describing function predicts there.
    pub cycle: Cycle,
    /// Mean of the output; not 0 with an asymmetric relay.
    pub mean: f64,
    /// Root of the sum of squares of the second to 25th harmonic that the plant lets through, per first
    /// harmonic: the describing function takes this for 0.
    pub distortion: f64,
}

/// Distortion from which the describing function should not be trusted. At 0.1 the period of the
/// loops that were tried is off by some per cent (a third-order lag has 0.02, a first-order one 0.3).
pub const TRUSTED_DISTORTION: f64 = 0.1;

/// Most intersections that are reported: an ideal relay with dead time has infinitely many.
pub const MAX_INTERSECTIONS: usize = 40;

/// The scan steps by this share of the distance to the nearest pole: within that distance the
/// response is a power series, so that it bends little within a step.
const POLE_STEP: f64 = 0.1;

/// Largest turn of the dead time within a step, rad.
const LAG_STEP: f64 = 0.15;

/// Smallest step where a pole lies on the imaginary axis, as a share of the frequency.
const SMALLEST_STEP: f64 = 1e-3;

/// The scan begins and ends this far below and above the poles and zeros.
const BELOW: f64 = 1e-4;
const ABOVE: f64 = 1e3;

/// Most steps of the scan.
const MAX_SCAN: usize = 20_000;

/// Harmonics that count for the distortion.
const HARMONICS: usize = 25;

/// All intersections of the Nyquist curve with `-1/N(a)`, equations (5) and (6), by rising frequency:
/// where `Im P(jw) = -pi eps/(4k)` and `Re P(jw) <= 0`. The relay's delay counts as dead time.
///
/// Stable is a cycle whose quasi-linear loop at a slightly larger amplitude has no pole in the right half
/// plane, by the Nyquist criterion: the curve crosses `-1/N(a)` upwards there, and its other crossings
/// further out on `-1/N(a)` do not encircle the point. `None` where the curves only touch.
///
/// With asymmetry or bias the balance is that of the mean value as well (dual-input describing
/// function, Gelb and Vander Velde 1968); the symmetric intersections are followed there. An invalid plant or
/// relay gives none.
pub fn describing_function(plant: &TransferFunction, relay: &Relay) -> Vec<Intersection> {
    let Some(loop_) = Loop::new(plant, relay) else {
        return Vec::new();
    };
    let crossings = loop_.crossings();
    let mut found: Vec<Intersection> = crossings
        .iter()
        .filter_map(|c| {
            let symmetric = Balance {
                omega: c.omega,
                amplitude: 4.0 * relay.gain / PI * c.point.norm(),
                mean: 0.0,
            };
            let balance = loop_.follow(symmetric)?;
            Some(loop_.intersection(&balance, loop_.is_stable(c, &crossings)))
        })
        .collect();
    found.truncate(MAX_INTERSECTIONS);
    found
}

/// A crossing of the ray `Im = -pi eps/(4k)`, `Re <= 0` by the Nyquist curve.
struct Crossing {
    omega: f64,
    point: Complex<f64>,
    /// Upwards as the frequency rises; `None` if it only touches.
    upwards: Option<bool>,
}

/// One solution of the balance.
#[derive(Clone, Copy)]
struct Balance {
    omega: f64,
    amplitude: f64,
    /// Mean of the output.
    mean: f64,
}

struct Loop<'a> {
    plant: &'a TransferFunction,
    relay: &'a Relay,
    factors: ZeroPoleGain,
    /// Dead time and delay, s.
    lag: f64,
    level: f64,
}

impl<'a> Loop<'a> {
    fn new(plant: &'a TransferFunction, relay: &'a Relay) -> Option<Self> {
        relay.validate().ok()?;
        let factors = plant.zero_pole_gain().ok()?;
        Some(Self {
            plant,
            relay,
            factors,
            lag: plant.dead_time + relay.delay,
            level: -PI * relay.hysteresis / (4.0 * relay.gain),
        })
    }

    fn response(&self, omega: f64) -> Complex<f64> {
        let p = self.plant.response(omega);
        if self.relay.delay == 0.0 {
            p
        } else {
            p * Complex::from_polar(1.0, -omega * self.relay.delay)
        }
    }

    fn balance(&self, omega: f64) -> f64 {
        self.response(omega).im - self.level
    }

    /// Smallest and largest frequency that the scan covers, rad/s.
    fn range(&self) -> [f64; 2] {
        let roots = self.factors.poles.iter().chain(&self.factors.zeros);
        let sizes = roots.map(|r| r.norm()).filter(|r| *r > 0.0);
        let lag = (self.lag > 0.0).then_some(1.0 / self.lag);
        let (mut low, mut high) = (f64::INFINITY, 0.0_f64);
        for size in sizes.chain(lag) {
            low = low.min(size);
            high = high.max(size);
        }
        if high == 0.0 {
            // Integrators only: the gain sets the scale, |K|/w^n = 1 unit of level.
            let order = self.factors.relative_degree().max(1) as f64;
            let size = libm::pow(
                self.factors.gain.abs() / self.level.abs().max(f64::MIN_POSITIVE),
                1.0 / order,
            );
            (low, high) = if self.level == 0.0 {
                (1.0, 1.0)
            } else {
                (size, size)
            };
        }
        [BELOW * low, ABOVE * high]
    }

    fn step(&self, omega: f64) -> f64 {
        let s = Complex::new(0.0, omega);
        let nearest = self
            .factors
            .poles
            .iter()
            .fold(f64::INFINITY, |m, p| m.min((s - p).norm()));
        let turn = if self.lag > 0.0 {
            LAG_STEP / self.lag
        } else {
            f64::INFINITY
        };
        (POLE_STEP * nearest).max(SMALLEST_STEP * omega).min(turn)
    }

    /// All crossings of the ray, by rising frequency.
    fn crossings(&self) -> Vec<Crossing> {
        let [low, high] = self.range();
        let mut found = Vec::new();
        let mut last = (low, self.balance(low));
        let mut before: Option<(f64, f64)> = None;
        for _ in 0..MAX_SCAN {
            let omega = last.0 + self.step(last.0);
            // Beyond its poles the response falls; what lies below the ray's level cannot meet it again.
            let faded = self.level < 0.0 && self.lag > 0.0;
            if omega > high
                || (faded && omega > 0.01 * high && self.plant.response(omega).norm() < -self.level)
                || found.len() > 2 * MAX_INTERSECTIONS
            {
                break;
            }
            let next = (omega, self.balance(omega));
            if (last.1 < 0.0) != (next.1 < 0.0) {
                self.add(&mut found, last, next);
            } else if let Some(before) = before
                && last.1.abs() < before.1.abs()
                && last.1.abs() < next.1.abs()
                && (before.1 < 0.0) == (last.1 < 0.0)
            {
                self.touch(&mut found, before.0, next.0, last.1);
            }
            before = Some(last);
            last = next;
        }
        found
    }

    fn add(&self, found: &mut Vec<Crossing>, low: (f64, f64), high: (f64, f64)) {
        if !(low.1.is_finite() && high.1.is_finite()) {
            return;
        }
        let omega = illinois(low, high, |w| self.balance(w));
        let point = self.response(omega);
        // A pole on the axis makes the curve jump through infinity, which is no crossing.
        let jump = point.norm() > 1e6 * (low.1.abs() + high.1.abs() + self.level.abs());
        if point.re < 0.0 && !jump {
            found.push(Crossing {
                omega,
                point,
                upwards: (low.1 != high.1).then_some(high.1 > low.1),
            });
        }
    }

    /// Between `low` and `high` the curve comes close to the ray on one side: does it reach it?
    fn touch(&self, found: &mut Vec<Crossing>, low: f64, high: f64, value: f64) {
        let sign = value.signum();
        let peak = golden_section((low, high), SECTIONS, 0.0, |w| -sign * self.balance(w));
        let (at, beyond) = peak.best;
        if beyond > 0.0 {
            let middle = (at, -sign * beyond);
            self.add(found, (low, self.balance(low)), middle);
            self.add(found, middle, (high, self.balance(high)));
            return;
        }
        let omega = peak.at;
        let point = self.response(omega);
        if (point.im - self.level).abs() <= 1e-12 * point.norm() && point.re < 0.0 {
            found.push(Crossing {
                omega,
                point,
                upwards: None,
            });
        }
    }

    /// The Nyquist criterion for an amplitude slightly above that of the crossing.
    fn is_stable(&self, here: &Crossing, all: &[Crossing]) -> Option<bool> {
        if !here.upwards? {
            return Some(false);
        }
        let outside = all.iter().filter(|c| c.point.re < here.point.re);
        let mut turns = 0.0;
        for crossing in outside {
            turns += match crossing.upwards {
                Some(true) => 2.0,
                Some(false) => -2.0,
                None => 0.0,
            };
        }
        let integrates = self.factors.poles.iter().any(|p| p.norm() == 0.0);
        if integrates {
            // The arc at infinity from the positive real axis to where the curve begins.
            let begin = self.factors.phase(self.range()[0]);
            turns += 2.0 * ((PI - begin) / (2.0 * PI)).floor();
        } else if self.plant.dc_gain() < here.point.re {
            turns += 1.0;
        }
        let unstable = self.factors.poles.iter().filter(|p| p.re > 0.0).count();
        Some(unstable as f64 + turns == 0.0)
    }

    /// Follows a balance of the symmetric relay to the relay as it is.
    fn follow(&self, symmetric: Balance) -> Option<Balance> {
        if self.relay.is_symmetric() {
            return Some(symmetric);
        }
        let (mut now, mut done, mut step) = (symmetric, 0.0_f64, 0.25_f64);
        while done < 1.0 {
            let next = (done + step).min(1.0);
            if let Some(found) = self.solve(now, next * self.relay.mean_output()) {
                (now, done) = (found, next);
                step *= 1.5;
            } else {
                step *= 0.5;
                if step < 1e-3 {
                    return None;
                }
            }
        }
        Some(now)
    }

    /// Newton's method for `N(a, b) P(jw) = -1` and the mean value, the relay's mean output being `mean`.
    fn solve(&self, from: Balance, mean: f64) -> Option<Balance> {
        let dc = self.plant.dc_gain();
        let residual = |v: &Vector3<f64>| -> Option<Vector3<f64>> {
            let (omega, amplitude, offset) = (libm::exp(v[0]), libm::exp(v[1]), v[2]);
            let [gain, constant] = dual_input(self.relay, amplitude, offset)?;
            let one = gain * self.response(omega) + 1.0;
            let input = mean + constant.re;
            let third = if dc.is_finite() {
                (offset - dc * input) / amplitude
            } else {
                input / self.relay.gain
            };
            Some(Vector3::new(one.re, one.im, third))
        };
        let mut v = Vector3::new(libm::log(from.omega), libm::log(from.amplitude), from.mean);
        for _ in 0..30 {
            let r = residual(&v)?;
            let mut jacobian = Matrix3::zeros();
            for k in 0..3 {
                let size = if k == 2 { libm::exp(v[1]) } else { 1.0 };
                let mut moved = v;
                moved[k] += 1e-7 * size;
                let column = (residual(&moved)? - r) / (1e-7 * size);
                jacobian.set_column(k, &column);
            }
            let step = jacobian.lu().solve(&r)?;
            v -= step;
            if !v.iter().all(|x| x.is_finite()) {
                return None;
            }
            let size = step[0].abs() + step[1].abs() + step[2].abs() / libm::exp(v[1]);
            if size < 1e-12 {
                return Some(Balance {
                    omega: libm::exp(v[0]),
                    amplitude: libm::exp(v[1]),
                    mean: v[2],
                });
            }
            if size > 2.0 {
                return None;
            }
        }
        None
    }

    fn intersection(&self, at: &Balance, stable: Option<bool>) -> Intersection {
        let p = self.response(at.omega);
        Intersection {
            point: [p.re, p.im],
            omega: at.omega,
            cycle: Cycle {
                period: 2.0 * PI / at.omega,
                amplitude: at.amplitude,
                stable,
            },
            mean: at.mean,
            distortion: self.distortion(at),
        }
    }

    fn distortion(&self, at: &Balance) -> f64 {
        let eps = self.relay.hysteresis;
        let angle = |v: f64| libm::asin((v / at.amplitude).clamp(-1.0, 1.0));
        // Half of the time with h = +1, as an angle: from asin((eps - b)/a) to pi + asin((eps + b)/a).
        let half = 0.5 * (PI + angle(eps + at.mean) - angle(eps - at.mean));
        let first = libm::sin(half).abs() * self.response(at.omega).norm();
        let sum: f64 = (2..=HARMONICS)
            .map(|n| {
                let order = n as f64;
                let p = self.response(order * at.omega).norm();
                (libm::sin(order * half) / order * p / first).powi(2)
            })
            .sum();
        sum.sqrt()
    }
}

/// Describing function `N` of `-u` for the output `b + a sin(wt)`, and the constant part of `-k h` (real):
/// `h` is +1 from the angle `asin((eps - b)/a)` to `pi + asin((eps + b)/a)`. `None` where the output does not
/// reach both thresholds.
fn dual_input(relay: &Relay, a: f64, b: f64) -> Option<[Complex<f64>; 2]> {
    let (rise, fall) = ((relay.hysteresis - b) / a, (relay.hysteresis + b) / a);
    if !(rise.abs() < 1.0 && fall.abs() < 1.0) {
        return None;
    }
    let k = relay.gain;
    let in_phase = 2.0 * k / (PI * a) * ((1.0 - rise * rise).sqrt() + (1.0 - fall * fall).sqrt());
    let quadrature = -4.0 * k * relay.hysteresis / (PI * a * a);
    let constant = -k / PI * (libm::asin(fall) - libm::asin(rise));
    Some([
        Complex::new(in_phase, quadrature),
        Complex::new(constant, 0.0),
    ])
}
