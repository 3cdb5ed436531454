//! Exact flow of a damped body behind a first-order lag, under a held input.
//!
//! ```text
//! x' = v      v' = -lambda v + b (z + q)      z' = -mu (z - w)
//! ```
//!
//! with constant `w` (input) and `q` (friction and load). Without a lag `z = w`. The solution is
//! affine in `(x, v, z, w, q)`; its coefficients depend on the duration only and are cached, since
//! measurements are sampled at equal distances.

use super::short;
use crate::root::falsi;

/// Coefficients of the solution after a duration `h`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Coefficients {
    /// Duration, s.
    h: f64,
    /// `exp(-lambda h)`.
    decay: f64,
    /// `exp(-mu h)`.
    lag_decay: f64,
    /// Velocity per unit of constant acceleration: `int_0^h exp(-lambda s) ds`.
    phi1: f64,
    /// Position per unit of constant acceleration.
    phi2: f64,
    /// Velocity per unit of decaying acceleration `exp(-mu s)`.
    psi1: f64,
    /// Position per unit of decaying acceleration.
    psi2: f64,
}

/// Above this `rate * h` closed forms are used, below it power series: each is accurate there to
/// a few units of round-off, where the other one cancels or converges slowly.
const SERIES_LIMIT: f64 = 0.5;

/// Below this `rate * h` the first terms of the series are exact to round-off.
const SHORT: f64 = 0.1;

/// Inverses of 2, 3, ... and of 3, 4, ...
const INVERSES: [(f64, f64); 9] = [
    (1.0 / 2.0, 1.0 / 3.0),
    (1.0 / 3.0, 1.0 / 4.0),
    (1.0 / 4.0, 1.0 / 5.0),
    (1.0 / 5.0, 1.0 / 6.0),
    (1.0 / 6.0, 1.0 / 7.0),
    (1.0 / 7.0, 1.0 / 8.0),
    (1.0 / 8.0, 1.0 / 9.0),
    (1.0 / 9.0, 1.0 / 10.0),
    (1.0 / 10.0, 1.0 / 11.0),
];

/// Terms of the series; `0.5^18 / 18!` is far below round-off.
const SERIES_TERMS: u32 = 18;

/// The series ends at terms below this share of round-off.
const SERIES_REST: f64 = 1e-3;

/// Durations closer than this share of each other use the same coefficients; the error is the
/// same share of one sample's motion, far below round-off of the file.
const SAME_DURATION: f64 = 1e-12;

impl Coefficients {
    fn new(lambda: f64, mu: Option<f64>, h: f64) -> Self {
        if mu.is_none() && (h * lambda).abs() < SHORT {
            return Self::short(lambda, h);
        }
        let mu_value = mu.unwrap_or(0.0);
        if h * lambda.abs().max(mu_value.abs()) < SERIES_LIMIT {
            return Self::series(lambda, mu_value, h);
        }
        let phi1_of = |rate: f64| {
            if rate * h == 0.0 {
                h
            } else {
                -libm::expm1(-rate * h) / rate
            }
        };
        let phi1 = phi1_of(lambda);
        let phi2 = if lambda.abs() * h < SERIES_LIMIT {
            Self::series(lambda, 0.0, h).phi2
        } else {
            (h - phi1) / lambda
        };
        let (decay, lag_decay) = (libm::exp(-lambda * h), libm::exp(-mu_value * h));
        // Equal rates are a removable singularity: the slower decay is taken out first.
        let apart = (lambda - mu_value).abs();
        let psi1 = decay.max(lag_decay) * phi1_of(apart);
        // From psi1' = -lambda psi1 + exp(-mu t), integrated; symmetric in the two rates.
        let psi2 = if lambda.abs() > mu_value.abs() {
            (phi1_of(mu_value) - psi1) / lambda
        } else {
            (phi1 - psi1) / mu_value
        };
        Self {
            h,
            decay,
            lag_decay,
            phi1,
            phi2,
            psi1,
            psi2,
        }
    }

    /// The series without a lag, by Horner's rule.
    fn short(lambda: f64, h: f64) -> Self {
        let x = lambda * h;
        // (1 - exp(-x)) / x and (x - 1 + exp(-x)) / x^2
        let (mut first, mut second) = (1.0, 1.0);
        for inverse in INVERSES.iter().rev() {
            second = 1.0 - x * inverse.1 * second;
            first = 1.0 - x * inverse.0 * first;
        }
        let phi1 = h * first;
        Self {
            h,
            decay: 1.0 - lambda * phi1,
            lag_decay: 1.0,
            phi1,
            phi2: 0.5 * h * h * second,
            psi1: 0.0,
            psi2: 0.0,
        }
    }

    fn series(lambda: f64, mu: f64, h: f64) -> Self {
        let (mut phi1, mut phi2, mut psi1, mut psi2) = (0.0, 0.0, 0.0, 0.0);
        // Taylor terms of exp(-lambda h), exp(-mu h) and of psi1, each of order k.
        let (mut decay_term, mut lag_term, mut psi_term) = (1.0, 1.0, 0.0);
        let (mut decay, mut lag_decay) = (1.0, 1.0);
        for k in 0..SERIES_TERMS {
            let k = f64::from(k);
            phi1 += decay_term * h / (k + 1.0);
            phi2 += decay_term * h * h / ((k + 1.0) * (k + 2.0));
            psi_term = (lag_term - lambda * psi_term) * h / (k + 1.0);
            psi1 += psi_term;
            psi2 += psi_term * h / (k + 2.0);
            decay_term *= -lambda * h / (k + 1.0);
            lag_term *= -mu * h / (k + 1.0);
            decay += decay_term;
            lag_decay += lag_term;
            let largest = decay_term.abs().max(lag_term.abs()).max(psi_term.abs() / h);
            if largest < f64::EPSILON * SERIES_REST {
                break;
            }
        }
        Self {
            h,
            decay,
            lag_decay,
            phi1,
            phi2,
            psi1,
            psi2,
        }
    }
}

/// What a body with this rate of decay does in `h` seconds: what stays of its velocity, and velocity and
/// position per unit of acceleration.
pub(crate) fn free_body(rate: f64, h: f64) -> (f64, f64, f64) {
    let c = Coefficients::new(rate, None, h);
    (c.decay, c.phi1, c.phi2)
}

/// Position, velocity and lagged input.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub(super) struct Motion {
    pub x: f64,
    pub v: f64,
    pub z: f64,
}

/// A body with its rates, and the coefficients of the durations used last.
#[derive(Clone, Debug)]
pub(super) struct Flow {
    lambda: f64,
    /// Inverse inertia.
    pub b: f64,
    mu: Option<f64>,
    /// Share of the lag's input that passes it by.
    direct: f64,
    cache: Vec<Coefficients>,
}

impl Flow {
    /// `inertia` and `viscous` friction of the body; `lag` in s.
    pub fn new(inertia: f64, viscous: f64, lag: Option<f64>) -> Self {
        Self {
            lambda: viscous / inertia,
            b: 1.0 / inertia,
            mu: lag.map(|tau| 1.0 / tau),
            direct: 0.0,
            cache: Vec::new(),
        }
    }

    /// The same with a `share` of the input that acts on the body at once; without dry friction.
    #[must_use]
    pub fn with_direct(self, share: f64) -> Self {
        Self {
            direct: share,
            ..self
        }
    }

    /// Whether the input reaches the body through a lag.
    pub fn lagged(&self) -> bool {
        self.mu.is_some()
    }

    /// Computes the coefficients of a duration that will recur.
    pub fn prepare(&mut self, h: f64) {
        self.cache.push(Coefficients::new(self.lambda, self.mu, h));
    }

    /// Like [`Flow::after`], quick for the durations that were prepared.
    pub fn after_cached(&self, m: Motion, w: f64, q: f64, h: f64) -> Motion {
        match self.prepared(h) {
            Some(c) => self.apply(c, m, w, q),
            None => self.after(m, w, q, h),
        }
    }

    /// What was prepared for this duration.
    pub fn prepared(&self, h: f64) -> Option<&Coefficients> {
        let mut cache = self.cache.iter();
        cache.find(|c| (c.h - h).abs() <= SAME_DURATION * h)
    }

    /// State after `h` seconds with input `w` and force `q`.
    pub fn after(&self, m: Motion, w: f64, q: f64, h: f64) -> Motion {
        self.apply(&Coefficients::new(self.lambda, self.mu, h), m, w, q)
    }

    /// What has come of the input `w` at the body after `h` seconds.
    pub fn input_after(&self, m: Motion, w: f64, h: f64) -> f64 {
        if self.mu.is_none() {
            return w;
        }
        self.after_cached(m, w, 0.0, h).z
    }

    /// Time after which the velocity passes through zero, if it does before `until`, where it is `end`.
    pub fn stops(&self, m: Motion, w: f64, q: f64, until: f64, end: f64) -> f64 {
        if self.mu.is_some() {
            return falsi(until, m.v, end, |t| self.after(m, w, q, t).v);
        }
        // v exp(-lambda t) + a (1 - exp(-lambda t)) / lambda = 0
        let a = self.b * (w + q);
        let ratio = -self.lambda * m.v / a;
        let time = if ratio.abs() < 1e-12 {
            -m.v / a
        } else {
            libm::log1p(ratio) / self.lambda
        };
        // Not clamp: a wild trial of a fit may bring times that are no numbers.
        time.max(0.0).min(until)
    }

    /// Acceleration in state `m`.
    pub fn acceleration(&self, m: Motion, q: f64) -> f64 {
        self.b * (m.z + q) - self.lambda * m.v
    }

    /// State after a prepared duration with input `w` and force `q`.
    pub fn apply(&self, c: &Coefficients, m: Motion, w: f64, q: f64) -> Motion {
        let steady = self.b * (w + q);
        let (x, v) = (
            m.x + m.v * c.phi1 + steady * c.phi2,
            m.v * c.decay + steady * c.phi1,
        );
        if self.mu.is_none() {
            return Motion { x, v, z: w };
        }
        let fading = self.b * (1.0 - self.direct) * (m.z - w);
        Motion {
            x: x + fading * c.psi2,
            v: v + fading * c.psi1,
            z: w + (m.z - w) * c.lag_decay,
        }
    }

    /// Time until the lagged input reaches `target` on its way to `w`, if it does.
    pub fn lag_reaches(&self, z: f64, w: f64, target: f64) -> Option<f64> {
        let share = (target - w) / (z - w);
        let mu = self.mu?;
        (share > 0.0 && share <= 1.0).then(|| -libm::log(share) / mu)
    }
}

/// Exact flow of a body held by a spring: `y' = v`, `v' = -kappa y - lambda v + b (z + q)`, the
/// input behind the same lag as in [`Flow`].
#[derive(Clone, Copy, Debug)]
pub(super) struct Spring {
    lambda: f64,
    kappa: f64,
    b: f64,
    mu: Option<f64>,
    /// Share of the lag's input that passes it by.
    direct: f64,
}

impl Spring {
    /// A body of inverse inertia `b` on a spring of `stiffness` with `damping`; `mu` is the rate of the lag.
    pub fn new(b: f64, stiffness: f64, damping: f64, mu: Option<f64>) -> Self {
        Self {
            lambda: damping * b,
            kappa: stiffness * b,
            b,
            mu,
            direct: 0.0,
        }
    }

    /// The same with a `share` of the input that acts on the body at once.
    #[must_use]
    pub fn with_direct(self, share: f64) -> Self {
        Self {
            direct: share,
            ..self
        }
    }

    /// Roughly how far the body moves from state `m` in a short time `h`: three terms of the series.
    pub fn moved(&self, m: Motion, w: f64, q: f64, h: f64) -> f64 {
        let a = self.b * (m.z + q) - self.kappa * m.x - self.lambda * m.v;
        let rise = self.mu.map_or(0.0, |mu| self.b * mu * (w - m.z));
        let jerk = rise - self.kappa * m.v - self.lambda * a;
        h * (m.v + h * (0.5 * a + h * jerk / 6.0))
    }

    /// State after `h` seconds, with `m.x` the deflection of the spring.
    pub fn after(&self, m: Motion, w: f64, q: f64, h: f64) -> Motion {
        let rest = self.b * (w + q) / self.kappa;
        // Particular solution of the fading part of the lagged input.
        let (fading, mu, late, z) = match self.mu {
            None => (0.0, 0.0, 0.0, w),
            Some(mu) => {
                let gain = self.b * (1.0 - self.direct) / (mu * mu - self.lambda * mu + self.kappa);
                let (offset, decay) = (m.z - w, short::exp(-mu * h));
                (offset * gain, mu, offset * gain * decay, w + offset * decay)
            }
        };
        let (y0, v0) = (m.x - rest - fading, m.v + mu * fading);
        let alpha = 0.5 * self.lambda;
        let square = self.kappa - alpha * alpha;
        let (cosine, sine) = if (square * h * h).abs() < short::SHORT_SWING {
            short::swing(square, h)
        } else if square > 0.0 {
            let omega = square.sqrt();
            (libm::cos(omega * h), libm::sin(omega * h) / omega)
        } else if square < 0.0 {
            let omega = (-square).sqrt();
            (libm::cosh(omega * h), libm::sinh(omega * h) / omega)
        } else {
            (1.0, h)
        };
        let envelope = short::exp(-alpha * h);
        Motion {
            x: rest + late + envelope * (y0 * (cosine + alpha * sine) + v0 * sine),
            v: -mu * late + envelope * (v0 * (cosine - alpha * sine) - self.kappa * y0 * sine),
            z,
        }
    }
}

impl Spring {
    /// Time after which the velocity passes through zero, if it does before `until`, where it is `end`.
    pub fn stops(&self, m: Motion, w: f64, q: f64, until: f64, end: f64) -> f64 {
        if self.mu.is_some() {
            return falsi(until, m.v, end, |t| self.after(m, w, q, t).v);
        }
        // v cos(omega t) = (alpha v + kappa y) sin(omega t) / omega
        let alpha = 0.5 * self.lambda;
        let square = self.kappa - alpha * alpha;
        let y = m.x - self.b * (w + q) / self.kappa;
        let pull = (alpha * m.v + self.kappa * y) * m.v.signum();
        let (omega, speed) = (square.abs().sqrt(), m.v.abs());
        let time = if omega * until < STRAIGHT {
            speed / pull
        } else if square > 0.0 {
            libm::atan2(omega * speed, pull) / omega
        } else {
            libm::atanh(omega * speed / pull) / omega
        };
        // Not clamp: a wild trial of a fit may bring times that are no numbers.
        time.max(0.0).min(until)
    }
}

/// Radians below which a sine is its angle to round-off.
const STRAIGHT: f64 = 1e-8;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::runge_kutta;

    /// In many small steps, as an independent reference.
    fn integrate(lambda: f64, b: f64, mu: f64, m: Motion, w: f64, q: f64, h: f64) -> Motion {
        let rates = |[_, v, z]: [f64; 3], _| [v, -lambda * v + b * (z + q), -mu * (z - w)];
        let [x, v, z] = runge_kutta::integrate(rates, [m.x, m.v, m.z], h, 20_000);
        Motion { x, v, z }
    }

    #[test]
    fn agrees_with_runge_kutta_for_slow_fast_and_equal_rates() {
        let start = Motion {
            x: 0.3,
            v: -1.2,
            z: 0.7,
        };
        for (lambda, mu, h) in [
            (2.0, 3.0, 0.01),
            (2.0, 50.0, 0.1),
            (40.0, 3.0, 0.1),
            (20.0, 20.0, 0.1),
        ] {
            let flow = Flow::new(0.5, 0.5 * lambda, Some(1.0 / mu));
            let exact = flow.after(start, -0.4, 0.25, h);
            let reference = integrate(lambda, 2.0, mu, start, -0.4, 0.25, h);
            let tolerance = 1e-11;
            assert!((exact.x - reference.x).abs() < tolerance, "{lambda} {mu}");
            assert!((exact.v - reference.v).abs() < tolerance, "{lambda} {mu}");
            assert!((exact.z - reference.z).abs() < tolerance, "{lambda} {mu}");
        }
    }
}
