//! Sliding: an ideal relay with `C B > 0` holds the output on its threshold (Filippov 1988).
//!
//! There the relay acts as the equivalent control `u_eq = -(C A x + n')/(C B)` that keeps `y + n = 0`
//! (`n'`: slope of the measurement noise), so that `x' = (I - B C/(C B)) A x - B n'/(C B)`. It ends where
//! `u_eq` leaves the range of the relay's outputs (Utkin 1992).

use nalgebra::DMatrix;

use super::flow::{Flow, State};
use super::series::{Roots, Series, TERMS, derivative, first_rise, is_resolved, spread, to_powers};
use crate::plant::StateSpace;

/// `C B` counts as 0 below this share of what its summands could give.
const NO_PUSH: f64 = 1e-12;

/// The flow along the threshold; its output is the equivalent control without the noise's part.
pub(crate) struct Sliding {
    flow: Flow,
    /// Equivalent control per slope of the noise.
    noise_gain: f64,
    /// From the states of the free flow to those of this one.
    to_slide: State,
}

/// How far a step along the threshold went.
pub(crate) struct SlideStep {
    /// Its duration, s.
    pub time: f64,
    /// It went to the limit given.
    pub to_limit: bool,
    /// State at its end, of the free flow.
    pub x: State,
    /// The relay's state with which sliding ends, if it does.
    pub leaves: Option<bool>,
}

impl Sliding {
    /// The flow for `plant`, whose free flow is `free`; `None` where `C B <= 0`.
    pub fn new(plant: &StateSpace, free: &Flow, longest: f64) -> Option<Self> {
        let push = plant.c.dot(&plant.b);
        let size: f64 = plant
            .c
            .iter()
            .zip(&plant.b)
            .map(|(c, b)| (c * b).abs())
            .sum();
        if !(push.is_finite() && push > NO_PUSH * size) {
            return None;
        }
        let row = (&plant.a.transpose() * &plant.c).transpose() / push;
        let a = &plant.a - &plant.b * &row;
        let n = plant.b.len();
        let b = DMatrix::from_fn(n, 1, |i, _| -plant.b[i] / push);
        let c = DMatrix::from_fn(1, n, |_, j| -row[j]);
        let flow = Flow::new(&a, &b, &c, longest);
        let mut to_slide = [1.0; crate::plant::MAX_ORDER];
        for i in 0..n {
            let mut one = [0.0; crate::plant::MAX_ORDER];
            one[i] = 1.0;
            to_slide[i] = flow.inner(&free.outer(&one))[i];
        }
        Some(Self {
            flow,
            noise_gain: -1.0 / push,
            to_slide,
        })
    }

    fn inner(&self, x: &State) -> State {
        let mut s = *x;
        for (s, f) in s.iter_mut().zip(&self.to_slide) {
            *s *= f;
        }
        s
    }

    fn outer(&self, x: &State) -> State {
        let mut s = *x;
        for (s, f) in s.iter_mut().zip(&self.to_slide) {
            *s /= f;
        }
        s
    }

    /// Equivalent control in state `x` of the free flow.
    pub fn input(&self, x: &State, noise_slope: f64) -> f64 {
        self.flow.output(&self.inner(x), 0) + self.noise_gain * noise_slope
    }

    /// State after `t` s of sliding.
    pub fn after(&self, x: &State, noise_slope: f64, t: f64) -> State {
        self.outer(&self.flow.after(&self.inner(x), &[noise_slope], t.max(0.0)))
    }

    /// One step of at most `span` s, ending where the equivalent control leaves `range`.
    pub fn step(&self, x: &State, noise_slope: f64, span: f64, range: [f64; 2]) -> SlideStep {
        let inside = self.inner(x);
        let u = [noise_slope];
        let mut level = self.flow.levels().saturating_sub(1);
        while level > 0 && self.flow.step(level - 1) >= span {
            level -= 1;
        }
        let mut c;
        loop {
            let noise;
            (c, noise) = self.flow.series(level, 0, &inside, &u);
            if level == 0 || is_resolved(&c, noise) {
                break;
            }
            level -= 1;
        }
        c[0] += self.noise_gain * noise_slope;
        let h = self.flow.step(level);
        let to_limit = span <= h;
        let end = if to_limit { 2.0 * span / h - 1.0 } else { 1.0 };
        let above = leaving(&c, 1.0, range[1], end);
        let below = leaving(&c, -1.0, -range[0], end);
        let first = match (above, below) {
            (Some(a), Some(b)) if b < a => Some((b, true)),
            (Some(a), _) => Some((a, false)),
            (None, b) => b.map(|b| (b, true)),
        };
        let time = match first {
            Some((z, _)) => 0.5 * h * (z + 1.0),
            None if to_limit => span,
            None => h,
        };
        SlideStep {
            time,
            to_limit,
            x: self.outer(&self.flow.after(&inside, &u, time)),
            leaves: first.map(|f| f.1),
        }
    }
}

/// First `z` up to `end` at which `sign * c` rises beyond `level`.
fn leaving(c: &Series, sign: f64, level: f64, end: f64) -> Option<f64> {
    let mut g = [0.0; TERMS];
    for (g, c) in g.iter_mut().zip(c) {
        *g = sign * c;
    }
    g[0] -= level;
    if g[0] + spread(&g) <= 0.0 {
        return None;
    }
    let turns = Roots::of(&to_powers(&derivative(&g)), -1.0, end);
    first_rise(&to_powers(&g), turns.as_slice(), -1.0, end)
}
