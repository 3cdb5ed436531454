//! Exact flow of body and load at the ends of an elastic joint without play, under held forces.
//!
//! ```text
//! x' = v    s' = v - u    J v' = z + q - d v - T    J2 u' = T - d2 u    z' = -mu (z - w)
//! T = K s + D (v - u)
//! ```
//!
//! with the twist `s`, the velocity `u` of the load, and `w` (input) and `q` (friction and load) held. It is linear, so
//! that one matrix exponential carries it over a sampling interval, however fast the joint swings in it.

use nalgebra::{DMatrix, SMatrix, SVector};

use super::Model;
use super::flow::Motion;
use crate::exponential::exponential;

/// `x, s, v, u, z`, and with them what is held: `w, q`.
const MOVING: usize = 5;
const ALL: usize = 7;

/// Body and load.
#[derive(Clone, Copy, Debug)]
pub(super) struct Joined {
    /// Motion of the body.
    pub body: Motion,
    /// Body minus load.
    pub twist: f64,
    /// Velocity of the load.
    pub load: f64,
}

/// A model with an elastic joint, and its flow over the durations used.
#[derive(Clone, Debug)]
pub(super) struct Joint {
    rates: SMatrix<f64, ALL, ALL>,
    steps: Vec<(f64, SMatrix<f64, MOVING, ALL>)>,
}

impl Joint {
    /// `None` unless the load of `model` hangs on a linear joint and nothing on it is dry.
    pub fn new(model: &Model) -> Option<Self> {
        let load = model.load?;
        let joint = load.coupling;
        if joint.half_gap != 0.0 || load.dry_friction != 0.0 {
            return None;
        }
        let (b, b2) = (1.0 / model.inertia, 1.0 / load.inertia);
        let (k, d, mu) = (
            joint.stiffness,
            joint.damping,
            model.lag.map_or(0.0, |t| 1.0 / t),
        );
        #[rustfmt::skip]
        let rates = SMatrix::<f64, ALL, ALL>::from_row_slice(&[
            0.0,  0.0,    1.0,                      0.0,                      0.0, 0.0, 0.0,
            0.0,  0.0,    1.0,                     -1.0,                      0.0, 0.0, 0.0,
            0.0, -k * b, -(d + model.viscous) * b,  d * b,                    b,   0.0, b,
            0.0,  k * b2, d * b2,                  -(d + load.viscous) * b2,  0.0, 0.0, 0.0,
            0.0,  0.0,    0.0,                      0.0,                     -mu,  mu,  0.0,
            0.0,  0.0,    0.0,                      0.0,                      0.0, 0.0, 0.0,
            0.0,  0.0,    0.0,                      0.0,                      0.0, 0.0, 0.0,
        ]);
        Some(Self {
            rates,
            steps: Vec::new(),
        })
    }

    /// Computes the flow over a duration that will recur, unless it is beyond all numbers.
    pub fn prepare(&mut self, h: f64) {
        let rates = self.rates * h;
        let flow = exponential(DMatrix::from_column_slice(ALL, ALL, rates.as_slice()));
        let flow = flow.fixed_view::<MOVING, ALL>(0, 0).into_owned();
        if flow.iter().all(|v| v.is_finite()) {
            self.steps.push((h, flow));
        }
    }

    /// State after `h` seconds under input `w` and force `q`; `None` for a duration that was not prepared.
    pub fn after(&self, joined: &Joined, w: f64, q: f64, h: f64) -> Option<Joined> {
        let (_, flow) = self.steps.iter().find(|(step, _)| *step == h)?;
        let Motion { x, v, z } = joined.body;
        // Counted from the present position, which may be far from 0.
        let from = SVector::<f64, ALL>::from([0.0, joined.twist, v, joined.load, z, w, q]);
        let to = flow * from;
        let body = Motion {
            x: x + to[0],
            v: to[2],
            z: to[4],
        };
        Some(Joined {
            body,
            twist: to[1],
            load: to[3],
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Coupling, Engine, Load, State};

    /// `x, s, v, u, z` and the rates at which they change.
    fn rates(model: &Model, load: &Load, s: [f64; 5], w: f64, q: f64) -> [f64; 5] {
        let [_, twist, v, u, z] = s;
        let torque = load.coupling.stiffness * twist + load.coupling.damping * (v - u);
        [
            v,
            v - u,
            (z + q - model.viscous * v - torque) / model.inertia,
            (torque - load.viscous * u) / load.inertia,
            model.lag.map_or(0.0, |lag| (w - z) / lag),
        ]
    }

    /// Runge and Kutta, 1901, in `steps` steps.
    fn integrated(model: &Model, load: &Load, from: [f64; 5], w: f64, q: f64, h: f64) -> [f64; 5] {
        let steps = 20_000;
        let h = h / f64::from(steps);
        let moved = |s: [f64; 5], k: [f64; 5], h: f64| std::array::from_fn(|i| s[i] + h * k[i]);
        (0..steps).fold(from, |s, _| {
            let k1 = rates(model, load, s, w, q);
            let k2 = rates(model, load, moved(s, k1, 0.5 * h), w, q);
            let k3 = rates(model, load, moved(s, k2, 0.5 * h), w, q);
            let k4 = rates(model, load, moved(s, k3, h), w, q);
            std::array::from_fn(|i| s[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]))
        })
    }

    fn joined() -> (Model, Load) {
        let load = Load {
            inertia: 7e-4,
            viscous: 1e-3,
            dry_friction: 0.0,
            coupling: Coupling {
                half_gap: 0.0,
                stiffness: 20.0,
                damping: 4e-3,
            },
        };
        let mut model = Model::body(9e-4, 2e-3);
        model.load = Some(load);
        (model, load)
    }

    #[test]
    fn body_and_load_move_as_integrated_in_small_steps() {
        for lag in [None, Some(2e-3)] {
            let (mut model, load) = joined();
            model.lag = lag;
            model.constant_force = 0.03;
            let (from, w) = ([0.0, 0.01, 3.0, -1.0, 0.2], 0.4);
            let z = if lag.is_some() { 0.2 } else { w };
            // A whole swing of the joint in one step.
            for h in [1e-4, 5e-3, 3e-2] {
                let mut joint = Joint::new(&model).expect("a linear joint");
                joint.prepare(h);
                let joined = Joined {
                    body: Motion {
                        x: 100.0,
                        v: from[2],
                        z,
                    },
                    twist: from[1],
                    load: from[3],
                };
                let to = joint.after(&joined, w, 0.03, h).expect("prepared");
                let from = [from[0], from[1], from[2], from[3], z];
                let exact = integrated(&model, &load, from, w, 0.03, h);
                let found = [to.body.x - 100.0, to.twist, to.body.v, to.load, to.body.z];
                for (found, exact) in found.iter().zip(exact) {
                    assert!((found - exact).abs() < 1e-11, "{found} is not {exact}");
                }
            }
        }
    }

    #[test]
    fn a_body_that_rubs_but_does_not_turn_loses_its_friction() {
        let (mut model, load) = joined();
        model.friction.level = 0.05;
        let mut engine = Engine::new(&model);
        engine.prepare(1e-3);
        let mut state = State::at_rest(0.0).restarted(0.0, 5.0);
        let mut exact = [0.0, 0.0, 5.0, 0.0, 0.3];
        for _ in 0..8 {
            engine.advance(&mut state, 0.3, 1e-3);
            exact = integrated(&model, &load, exact, 0.3, -0.05, 1e-3);
            exact[4] = 0.3;
        }
        assert!(exact[2] > 0.0, "the body turned");
        assert!((state.velocity() - exact[2]).abs() < 1e-11);
        assert!((state.twist() - exact[1]).abs() < 1e-13);
        assert!((state.load_velocity() - exact[3]).abs() < 1e-11);
    }

    #[test]
    fn a_joint_with_play_or_a_load_that_rubs_is_not_linear() {
        let (mut model, mut load) = joined();
        load.dry_friction = 0.01;
        model.load = Some(load);
        assert!(Joint::new(&model).is_none());
        load.dry_friction = 0.0;
        load.coupling.half_gap = 1e-3;
        model.load = Some(load);
        assert!(Joint::new(&model).is_none());
    }

    #[test]
    fn a_stiffness_beyond_all_numbers_is_left_to_the_small_steps() {
        let (mut model, mut load) = joined();
        load.coupling.stiffness = 1e308;
        model.load = Some(load);
        let mut joint = Joint::new(&model).expect("linear");
        joint.prepare(1e300);
        assert!(joint.steps.is_empty());
    }
}
