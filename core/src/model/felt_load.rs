//! A load behind a gap, known by the force that the body felt.
//!
//! Where body and load meet again and again, a load that is simulated from its beginning is lost soon, whether the body
//! is simulated too or moved as measured: every contact multiplies what was wrong before it. What the known forces do
//! not explain of the body's measured motion is the push of the load, and the same push moves the load: its momentum is
//! told by that of the body, contact by contact, without that growth. Its place is that momentum's integral, which
//! drifts; while they touch, it is told by the gap. A Kalman filter (1960) joins both.

use super::flow::Motion;
use super::followed::Followed;
use super::friction::Mode;
use super::seen_load::{LoadState, Surprise, root};
use super::{Instant, Load, Model, Slowing};
use crate::order::quantile;

/// Share of the intervals in which the body is taken to be free at least, and the share of a standard deviation below
/// which as many values of a normal distribution lie.
const FREE: f64 = 0.3;
const FREE_DEVIATIONS: f64 = 0.385;

/// Share of the usual speed below which the body is still, and tells no noise.
const STILL: f64 = 0.01;

/// Standard deviations of the felt force from which it is a push, and the weakest push as a share of the hardest.
const PUSH: f64 = 6.0;
const WEAKEST: f64 = 0.01;

/// Uncertainty of the load's velocity that grows in so many samples, as a share of the body's usual speed, and the
/// least.
const GROWN: f64 = 0.01;
const GROWING: f64 = 1000.0;
const LEAST: f64 = 0.003;

/// Uncertainty of the depth of a contact, as a share of it, and of the gap's ends, as a share of the half gap.
const DEPTH: f64 = 0.3;
const ENDS: f64 = 1e-3;

/// Velocity at sample `k` from the positions before and after it, `step` seconds apart.
pub(crate) fn slope(position: &[f64], k: usize, step: f64) -> f64 {
    let (before, after) = (k.saturating_sub(1), (k + 1).min(position.len() - 1));
    (position[after] - position[before]) / ((after - before) as f64 * step)
}

/// A measured motion of the body, and the input that reached it.
pub(super) struct Felt<'a> {
    /// Position at every sample, free of noise as far as known.
    pub position: &'a [f64],
    /// Velocity at every sample, if it was measured.
    pub velocity: Option<&'a [f64]>,
    /// Input after its path, over every interval.
    pub input: &'a [f64],
    /// Sampling time, s.
    pub step: f64,
}

impl Felt<'_> {
    /// Position in the middle of an interval, and velocity over it.
    fn body(&self, k: usize) -> (f64, f64) {
        let (from, to) = (self.position[k], self.position[k + 1]);
        (f64::midpoint(from, to), (to - from) / self.step)
    }

    /// Velocity at a sample.
    fn velocity(&self, k: usize) -> f64 {
        if let Some(velocity) = self.velocity {
            return velocity[k];
        }
        slope(self.position, k, self.step)
    }

    /// Force from the body on the load of `model` over every interval.
    fn forces(&self, model: &Model) -> Vec<f64> {
        let (late, ramp) = model.late_load();
        let force = |(k, input): (usize, &f64)| {
            let (position, velocity) = self.body(k);
            let time = (k as f64 + 0.5) * self.step;
            let instant = Instant {
                position,
                velocity,
                input: *input,
                time,
            };
            let forces: f64 = model.forces.iter().map(|f| f(position, velocity)).sum();
            let own: f64 = model.own_forces.iter().map(|f| f(&instant)).sum();
            let pushed = (self.velocity(k + 1) - self.velocity(k)) / self.step;
            let acting = input + model.early_load(time) + late + ramp * time + forces + own;
            let rest = acting - model.viscous * velocity - model.inertia * pushed;
            let level = model.friction.level_at(position, velocity).max(0.0);
            let level = level + model.level_of_gear(&instant);
            if velocity == 0.0 {
                rest.signum() * (rest.abs() - level).max(0.0)
            } else {
                rest - velocity.signum() * level
            }
        };
        self.input.iter().enumerate().map(force).collect()
    }

    /// Where `load` is at `samples`, ascending, with the root of its covariance.
    pub fn states(
        &self,
        model: &Model,
        load: &Load,
        samples: &[usize],
    ) -> Vec<(Followed, [f64; 3])> {
        let forces = self.forces(model);
        let (step, gap) = (self.step, load.coupling.half_gap);
        let intervals = forces.len().max(1) as f64;
        let squares: f64 = (0..forces.len()).map(|k| self.body(k).1.powi(2)).sum();
        let speed = (squares / intervals).sqrt();
        let sizes = forces.iter().enumerate();
        let moving = sizes.filter(|(k, _)| self.body(*k).1.abs() > STILL * speed);
        let mut sizes: Vec<f64> = moving.map(|(_, f)| f.abs()).collect();
        let noise = quantile(&mut sizes, FREE) / FREE_DEVIATIONS;
        let hardest = sizes.iter().copied().fold(0.0, f64::max);
        let push = (PUSH * noise).max(WEAKEST * hardest);
        let slowing = Slowing {
            viscous: load.viscous / load.inertia,
            dry: load.dry_friction / load.inertia,
        };
        let mut state = LoadState {
            x: self.position[0],
            v: 0.0,
            covariance: [gap * gap, 0.0, speed * speed],
        };
        let mut samples = samples.iter().peekable();
        let mut found = Vec::new();
        for k in 0..self.position.len() {
            while samples.next_if(|s| **s == k).is_some() {
                let [xx, xv, vv] = state.covariance;
                let vv = vv + (LEAST * speed).powi(2);
                found.push((followed(&state), root([xx, xv, vv])));
            }
            let Some(force) = forces.get(k) else {
                break;
            };
            let (x, v) = self.body(k);
            let gained = force / load.inertia * step;
            // Half of the push comes before the middle of the interval, where the body is known.
            state.fly(&slowing, 0.5 * step);
            state.x += 0.125 * gained * step;
            state.v += 0.5 * gained;
            let twist = x - state.x;
            let presses = force.abs() > push;
            let side = if presses {
                force.signum()
            } else {
                twist.signum()
            };
            let depth = if presses {
                force.abs() / load.coupling.stiffness
            } else {
                0.0
            };
            if presses || twist.abs() > gap {
                let late = 0.5 * step * (v - state.v);
                let variance = (DEPTH * depth).powi(2) + (ENDS * gap).powi(2) + late * late;
                let surprise = Surprise {
                    value: twist - side * (gap + depth),
                    variance: variance + state.covariance[0],
                };
                state.meet(&surprise);
            }
            state.v += 0.5 * gained;
            state.fly(&slowing, 0.5 * step);
            state.x += 0.125 * gained * step;
            state.covariance[2] += (GROWN * speed).powi(2) / GROWING;
        }
        found
    }
}

fn followed(state: &LoadState) -> Followed {
    Followed {
        motion: Motion {
            x: state.x,
            v: state.v,
            ..Motion::default()
        },
        mode: Mode::of(state.v),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Coupling, Engine, State};

    const STEP: f64 = 2e-4;

    #[test]
    fn a_load_that_is_met_again_and_again_is_where_the_force_has_moved_it() {
        let mut model = Model::body(8e-4, 2e-3);
        let load = Load {
            inertia: 9e-4,
            viscous: 2e-3,
            dry_friction: 0.005,
            coupling: Coupling {
                half_gap: 0.03,
                stiffness: 800.0,
                damping: 0.15,
            },
        };
        model.load = Some(load);
        let engine = Engine::new(&model);
        let mut state = State::at_rest(0.0);
        let (mut position, mut velocity, mut input) = (Vec::new(), Vec::new(), Vec::new());
        let mut truth = Vec::new();
        for k in 0..6000 {
            position.push(state.position());
            velocity.push(state.velocity());
            truth.push((state.position() - state.twist(), state.load_velocity()));
            let time = f64::from(k) * STEP;
            let pushed = 0.12 * libm::sin(31.0 * time) + 0.1 * libm::sin(83.0 * time);
            input.push(pushed);
            engine.advance(&mut state, pushed, STEP);
        }
        let felt = Felt {
            position: &position,
            velocity: Some(&velocity),
            input: &input[..input.len() - 1],
            step: STEP,
        };
        let samples: Vec<usize> = (0..6000).step_by(50).collect();
        let states = felt.states(&model, &load, &samples);
        let speed = truth.iter().map(|(_, v)| v.abs()).fold(0.0, f64::max);
        let near = samples.iter().zip(&states).filter(|(k, (found, _))| {
            let (x, v) = truth[**k];
            let gap = load.coupling.half_gap;
            (found.motion.x - x).abs() < 0.03 * gap && (found.motion.v - v).abs() < 0.03 * speed
        });
        let near = near.count();
        assert!(
            20 * near > 19 * samples.len(),
            "{near} of {}",
            samples.len()
        );
    }
}
