//! What happens? A linear plant under a delayed relay, from switch to switch by exact flows.

use std::collections::VecDeque;

use nalgebra::{DMatrix, DVector};

use crate::model::root;
use crate::plant::StateSpace;
use crate::relay::Relay;

/// Switches within one step of the grid after which a run counts as chattering and ends.
const MAX_SWITCHES_PER_STEP: usize = 50;

/// A simulated run, sampled at equal steps.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trajectory {
    /// Times, s.
    pub time: Vec<f64>,
    /// Output `y`.
    pub output: Vec<f64>,
    /// Its derivative, 1/s.
    pub slope: Vec<f64>,
    /// Acting input as `[t, u]` at each change.
    pub input: Vec<[f64; 2]>,
    /// Instants at which the relay switched up, s.
    pub rises: Vec<f64>,
    /// Largest and smallest output between each two rises, at the samples and the input's changes.
    pub swings: Vec<[f64; 2]>,
    /// The run was cut because the relay switched without end.
    pub chattering: bool,
}

/// Exact flow over a fixed duration under a constant input.
#[derive(Clone, Debug)]
pub(crate) struct Flow {
    phi: DMatrix<f64>,
    gamma: DVector<f64>,
}

impl Flow {
    /// Flow of `plant` over `h` seconds, by the exponential of the matrix with the input appended.
    pub fn new(plant: &StateSpace, h: f64) -> Self {
        let n = plant.b.len();
        let mut m = DMatrix::zeros(n + 1, n + 1);
        m.view_mut((0, 0), (n, n)).copy_from(&(&plant.a * h));
        m.view_mut((0, n), (n, 1)).copy_from(&(&plant.b * h));
        let e = m.exp();
        Self {
            phi: e.view((0, 0), (n, n)).into_owned(),
            gamma: e.view((0, n), (n, 1)).column(0).into_owned(),
        }
    }

    /// Transition matrix.
    pub fn transition(&self) -> &DMatrix<f64> {
        &self.phi
    }

    /// Response to a unit input from rest.
    pub fn response(&self) -> &DVector<f64> {
        &self.gamma
    }

    /// State after the duration.
    pub fn apply(&self, x: &DVector<f64>, u: f64) -> DVector<f64> {
        &self.phi * x + &self.gamma * u
    }
}

/// Runs `plant` (without its dead time) under `relay`, whose output acts `lag` seconds after a switch.
///
/// Starts from rest after one `step` of upward push, since an ideal relay would never leave the
/// origin; `steps` samples `step` seconds apart.
pub fn simulate(
    plant: &StateSpace,
    relay: &Relay,
    lag: f64,
    step: f64,
    steps: usize,
) -> Trajectory {
    let mut run = Run {
        plant,
        relay,
        lag,
        full: Flow::new(plant, step),
        x: DVector::zeros(plant.b.len()),
        u: relay.output(false),
        high: false,
        pending: VecDeque::new(),
        out: Trajectory::default(),
        swing: None,
    };
    run.x = run.full.apply(&run.x, run.u);
    run.high = run.output() > relay.hysteresis;
    run.u = relay.output(run.high);
    run.out.input.push([0.0, run.u]);
    for i in 0..steps {
        let t = step * i as f64;
        run.sample(t);
        if !run.advance(t, step) {
            run.out.chattering = true;
            break;
        }
    }
    run.out
}

struct Run<'a> {
    plant: &'a StateSpace,
    relay: &'a Relay,
    lag: f64,
    full: Flow,
    x: DVector<f64>,
    u: f64,
    high: bool,
    /// Changes of the input that are on their way.
    pending: VecDeque<(f64, f64)>,
    out: Trajectory,
    swing: Option<[f64; 2]>,
}

impl Run<'_> {
    fn output(&self) -> f64 {
        self.plant.c.dot(&self.x)
    }

    fn note_swing(&mut self) {
        let y = self.output();
        if let Some([low, high]) = &mut self.swing {
            *low = low.min(y);
            *high = high.max(y);
        }
    }

    fn sample(&mut self, t: f64) {
        self.note_swing();
        let slope = self
            .plant
            .c
            .dot(&(&self.plant.a * &self.x + &self.plant.b * self.u));
        self.out.time.push(t);
        self.out.output.push(self.output());
        self.out.slope.push(slope);
    }

    /// Positive beyond the threshold at which the relay switches next.
    fn beyond(&self, x: &DVector<f64>) -> f64 {
        let y = self.plant.c.dot(x);
        if self.high {
            -self.relay.hysteresis - y
        } else {
            y - self.relay.hysteresis
        }
    }

    /// Moves on by `step` from `t`; false if the relay chatters.
    fn advance(&mut self, t: f64, step: f64) -> bool {
        let mut now = t;
        let end = t + step;
        for _ in 0..MAX_SWITCHES_PER_STEP {
            let change = self.pending.front().map(|p| p.0).filter(|c| *c < end);
            let span = change.unwrap_or(end) - now;
            let whole = change.is_none() && now == t;
            let next = if whole {
                self.full.apply(&self.x, self.u)
            } else {
                self.after(span)
            };
            if self.beyond(&next) > 0.0 && self.beyond(&self.x) <= 0.0 {
                let t_switch = self.locate(span);
                self.x = self.after(t_switch);
                now += t_switch;
                self.switch(now);
                continue;
            }
            self.x = next;
            now += span;
            if change.is_some() {
                self.note_swing();
                if let Some((_, u)) = self.pending.pop_front() {
                    self.u = u;
                    self.out.input.push([now, u]);
                }
                continue;
            }
            return true;
        }
        false
    }

    fn after(&self, span: f64) -> DVector<f64> {
        Flow::new(self.plant, span).apply(&self.x, self.u)
    }

    /// Duration until the threshold within `span`, at whose end it is passed.
    fn locate(&self, span: f64) -> f64 {
        let (start, end) = (self.beyond(&self.x), self.beyond(&self.after(span)));
        if start == 0.0 {
            0.0
        } else {
            root(span, start, end, |t| self.beyond(&self.after(t)))
        }
    }

    fn switch(&mut self, now: f64) {
        self.high = !self.high;
        if self.high {
            self.out.rises.push(now);
            if let Some(swing) = self.swing.take() {
                self.out.swings.push(swing);
            }
            let y = self.output();
            self.swing = Some([y, y]);
        }
        let u = self.relay.output(self.high);
        if self.lag > 0.0 {
            self.pending.push_back((now + self.lag, u));
        } else {
            self.u = u;
            self.out.input.push([now, u]);
        }
    }
}
