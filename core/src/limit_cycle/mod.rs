//! Does it oscillate, how, and is it stable?

use std::f64::consts::PI;

use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

use crate::plant::{StateSpace, TransferFunction};
use crate::relay::Relay;
use crate::simulate::Flow;

/// A limit cycle.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Cycle {
    /// Period, s.
    pub period: f64,
    /// Half of peak to peak, in the unit of the output (the paper's `a`).
    pub amplitude: f64,
    /// Whether small disturbances die out; `None` where it is not known.
    pub stable: Option<bool>,
}

/// An intersection of the Nyquist curve with `-1/N(a)`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Intersection {
    /// Real and imaginary part.
    pub point: [f64; 2],
    /// Angular frequency, rad/s.
    pub omega: f64,
    /// The cycle that the describing function predicts there.
    pub cycle: Cycle,
}

/// Points of the frequency scan, per decade.
const SCAN_PER_DECADE: usize = 200;

/// Decades of the scan on either side of the plant's own frequency.
const SCAN_DECADES: f64 = 3.0;

/// Points of the scan for the half period, from a fifth to five times the predicted one.
const HALF_PERIOD_SCAN: usize = 160;

/// Points at which a half period is searched for its extremum and for earlier crossings.
const CYCLE_POINTS: usize = 256;

/// Typical angular frequency of a plant, rad/s: the geometric mean of its poles, or of what its
/// coefficients show where some are at 0.
pub fn typical_frequency(plant: &TransferFunction) -> f64 {
    let lead = plant.denominator[0];
    let poles = plant
        .denominator
        .iter()
        .rposition(|c| *c != 0.0)
        .unwrap_or(0);
    let size = if poles > 0 {
        (plant.denominator[poles] / lead)
            .abs()
            .powf(1.0 / poles as f64)
    } else {
        1.0
    };
    if plant.dead_time > 0.0 {
        size.min(PI / plant.dead_time)
    } else {
        size
    }
}

/// All intersections of the Nyquist curve with `-1/N(a)`, equations (5) and (6): where
/// `Im P(jw) = -pi eps/(4k)` and `Re P(jw) <= 0`; `lag` is the relay's delay in s.
pub fn describing_function(plant: &TransferFunction, relay: &Relay) -> Vec<Intersection> {
    let response =
        |w: f64| plant.response(w) * nalgebra::Complex::from_polar(1.0, -w * relay.delay);
    let level = -PI * relay.hysteresis / (4.0 * relay.gain);
    let balance = |w: f64| response(w).im - level;
    let centre = typical_frequency(plant);
    let count = (2.0 * SCAN_DECADES * SCAN_PER_DECADE as f64) as usize;
    let frequency =
        |i: usize| centre * 10_f64.powf(-SCAN_DECADES + i as f64 / SCAN_PER_DECADE as f64);
    let mut found = Vec::new();
    for i in 0..count {
        let (low, high) = (frequency(i), frequency(i + 1));
        let (f_low, f_high) = (balance(low), balance(high));
        let crosses = f_low * f_high < 0.0;
        if !crosses {
            continue;
        }
        let omega = bisect(low, high, f_low, balance);
        let p = response(omega);
        if p.re >= 0.0 {
            continue;
        }
        let reach = 4.0 * relay.gain / PI * p.norm();
        // Loeb: the curve must cross the line upwards seen along rising frequency (the amplitude
        // grows to the left), so that a larger swing is less than critical.
        found.push(Intersection {
            point: [p.re, p.im],
            omega,
            cycle: Cycle {
                period: 2.0 * PI / omega,
                amplitude: reach,
                stable: Some(f_high > f_low),
            },
        });
    }
    found
}

fn bisect(mut low: f64, mut high: f64, f_low: f64, f: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..200 {
        let mid = 0.5 * (low + high);
        if mid <= low || mid >= high {
            break;
        }
        let value = f(mid);
        if value == 0.0 {
            return mid;
        }
        if (value < 0.0) == (f_low < 0.0) {
            low = mid;
        } else {
            high = mid;
        }
    }
    0.5 * (low + high)
}

/// The exact symmetric limit cycle, equation (3), near the half period `guess` in s; `None` where
/// there is none with the relay's first crossing at its end.
///
/// With half period `h` and total delay `L = m h + L'`, `0 <= L' < h`, the state at an upward switch
/// obeys `(I + e^{Ah}) x0 = (-1)^m k [G(h-L') - e^{A(h-L')} G(L')]`, `C x0 = eps`.
/// Stability: eigenvalues of `(I - w C/(C w)) e^{Ah}`, `w` the velocity at the switch (Astrom 1995),
/// given for delays shorter than the half period.
pub fn exact_symmetric(plant: &StateSpace, relay: &Relay, lag: f64, guess: f64) -> Option<Cycle> {
    let half = HalfPeriod { plant, relay, lag };
    let at = |i: usize| guess * 5_f64.powf(2.0 * i as f64 / HALF_PERIOD_SCAN as f64 - 1.0);
    let mut best: Option<(f64, f64)> = None;
    for i in 0..HALF_PERIOD_SCAN {
        let (low, high) = (at(i), at(i + 1));
        let (Some(f_low), Some(f_high)) = (half.balance(low), half.balance(high)) else {
            continue;
        };
        let crosses = f_low * f_high <= 0.0;
        if !crosses {
            continue;
        }
        let h = bisect(low, high, f_low, |h| half.balance(h).unwrap_or(f64::NAN));
        // A jump of the balance (where the delay passes a multiple of h) is no root.
        let Some(rest) = half.balance(h) else {
            continue;
        };
        if rest.abs() > 1e-7 * (f_low.abs() + f_high.abs() + relay.hysteresis)
            || !half.crosses_first(h)
        {
            continue;
        }
        let distance = (h / guess).ln().abs();
        if best.is_none_or(|(d, _)| distance < d) {
            best = Some((distance, h));
        }
    }
    let (_, h) = best?;
    Some(Cycle {
        period: 2.0 * h,
        amplitude: half.amplitude(h)?,
        stable: half.stable(h),
    })
}

struct HalfPeriod<'a> {
    plant: &'a StateSpace,
    relay: &'a Relay,
    lag: f64,
}

impl HalfPeriod<'_> {
    /// Input before and after its change within the half period, and the time of the change.
    fn input(&self, h: f64) -> (f64, f64, f64) {
        let whole = (self.lag / h).floor();
        let sign = if whole % 2.0 == 0.0 { 1.0 } else { -1.0 };
        (
            sign * self.relay.gain,
            -sign * self.relay.gain,
            self.lag - whole * h,
        )
    }

    /// State at the upward switch.
    fn start(&self, h: f64) -> Option<DVector<f64>> {
        let (first, second, change) = self.input(h);
        let n = self.plant.b.len();
        let late = Flow::new(self.plant, h - change);
        let early = Flow::new(self.plant, change);
        let forced = late.transition() * early.response() * first + late.response() * second;
        let whole = late.transition() * early.transition();
        (DMatrix::identity(n, n) + whole).lu().solve(&-forced)
    }

    fn balance(&self, h: f64) -> Option<f64> {
        let value = self.plant.c.dot(&self.start(h)?) - self.relay.hysteresis;
        value.is_finite().then_some(value)
    }

    /// State after `t` seconds of the half period.
    fn state(&self, x0: &DVector<f64>, h: f64, t: f64) -> DVector<f64> {
        let (first, second, change) = self.input(h);
        if t <= change {
            return Flow::new(self.plant, t).apply(x0, first);
        }
        let x = Flow::new(self.plant, change).apply(x0, first);
        Flow::new(self.plant, t - change).apply(&x, second)
    }

    /// Outputs at equal steps of each part of the half period: `(t, y)`.
    fn outputs(&self, h: f64) -> Option<Vec<(f64, f64)>> {
        let (first, second, change) = self.input(h);
        let mut x = self.start(h)?;
        let mut points = Vec::with_capacity(2 * CYCLE_POINTS);
        let mut t = 0.0;
        for (u, span) in [(first, change), (second, h - change)] {
            if span <= 0.0 {
                continue;
            }
            let step = span / CYCLE_POINTS as f64;
            let flow = Flow::new(self.plant, step);
            for _ in 0..CYCLE_POINTS {
                points.push((t, self.plant.c.dot(&x)));
                x = flow.apply(&x, u);
                t += step;
            }
        }
        points.push((h, self.plant.c.dot(&x)));
        Some(points)
    }

    /// Whether the output stays above the lower threshold until the end of the half period.
    fn crosses_first(&self, h: f64) -> bool {
        let eps = self.relay.hysteresis;
        self.outputs(h).is_some_and(|points| {
            let swing = points.iter().fold(0.0_f64, |m, p| m.max(p.1.abs()));
            let inner = &points[1..points.len() - 1];
            swing > 0.0 && inner.iter().all(|(_, y)| *y > -eps - 1e-9 * swing)
        })
    }

    /// Largest output within the half period.
    fn amplitude(&self, h: f64) -> Option<f64> {
        let points = self.outputs(h)?;
        let x0 = self.start(h)?;
        let top =
            (0..points.len()).max_by(|a, b| points[*a].1.abs().total_cmp(&points[*b].1.abs()))?;
        let (mut low, mut high) = (
            points[top.saturating_sub(1)].0,
            points[(top + 1).min(points.len() - 1)].0,
        );
        // Golden section: the output has one extremum between neighbouring points.
        let ratio = 0.5 * (5_f64.sqrt() - 1.0);
        let size = |t: f64| self.plant.c.dot(&self.state(&x0, h, t)).abs();
        let mut best = points[top].1.abs();
        for _ in 0..60 {
            let (a, b) = (high - ratio * (high - low), low + ratio * (high - low));
            let (fa, fb) = (size(a), size(b));
            best = best.max(fa).max(fb);
            if fa < fb {
                low = a;
            } else {
                high = b;
            }
        }
        Some(best)
    }

    fn stable(&self, h: f64) -> Option<bool> {
        if self.lag >= h {
            return None;
        }
        let x0 = self.start(h)?;
        let (_, u, _) = self.input(h);
        let n = self.plant.b.len();
        let w =
            &self.plant.a * -x0 + &self.plant.b * if self.lag > 0.0 { u } else { -self.relay.gain };
        let rate = self.plant.c.dot(&w);
        if rate == 0.0 || !rate.is_finite() {
            return None;
        }
        let jump = DMatrix::identity(n, n) - &w * self.plant.c.transpose() / rate;
        let map = jump * Flow::new(self.plant, h).transition();
        if map.iter().any(|v| !v.is_finite()) {
            return None;
        }
        let schur = nalgebra::Schur::try_new(map, 1e-14, 10_000)?;
        Some(schur.complex_eigenvalues().iter().all(|e| e.norm() < 1.0))
    }
}
