//! Exact flow of body and load at the ends of an elastic joint, under held forces.
//!
//! ```text
//! x' = v    s' = v - u    J v' = z + q - d v - T    J2 u' = T + p - d2 u    z' = -mu (z - w)
//! T = K s + D (v - u)
//! ```
//!
//! with the twist `s`, the velocity `u` of the load, and `w` (input), `q` and `p` (friction and load) held. It is
//! linear, so that one matrix exponential carries it over a sampling interval, however fast the joint swings in it.

use nalgebra::{DMatrix, SMatrix, SVector};

use super::Model;
use super::flow::Motion;
use crate::exponential::exponential;

/// `x, s, v, u, z`, and with them what is held: `w, q, p`.
const MOVING: usize = 5;
const HELD: usize = 3;
const ALL: usize = MOVING + HELD;
const VELOCITY: usize = 2;
const LOAD_VELOCITY: usize = 3;

/// Terms of the power series: over half a radian the next one is below 1e-9.
const TERMS: usize = 10;

/// Motion of body and load as a power series in time.
pub(super) struct Series {
    /// Position of the body at the begin.
    from: f64,
    terms: [SVector<f64, MOVING>; TERMS],
}

impl Series {
    /// State after `t` seconds.
    pub fn at(&self, t: f64) -> Joined {
        let (last, rest) = (self.terms[TERMS - 1], &self.terms[..TERMS - 1]);
        let to = rest.iter().rev().fold(last, |sum, term| sum * t + term);
        Joined::from_vector(self.from, to.as_slice())
    }
}

/// Body and load.
#[derive(Clone, Copy, Debug)]
pub(super) struct Joined {
    /// Motion of the body.
    pub body: Motion,
    /// Body minus load, less the play.
    pub twist: f64,
    /// Velocity of the load.
    pub load: f64,
}

impl Joined {
    /// With what is held. Counted from the present position, which may be far from 0.
    fn vector(&self, forces: &Forces) -> SVector<f64, ALL> {
        let Motion { v, z, .. } = self.body;
        let (w, q, p) = (forces.input, forces.body, forces.load);
        SVector::from([0.0, self.twist, v, self.load, z, w, q, p])
    }

    /// From a vector that counts from position `x`.
    fn from_vector(x: f64, to: &[f64]) -> Self {
        Self {
            body: Motion {
                x: x + to[0],
                v: to[2],
                z: to[4],
            },
            twist: to[1],
            load: to[3],
        }
    }
}

/// What is held.
#[derive(Clone, Copy, Debug)]
pub(super) struct Forces {
    /// Input before the lag.
    pub input: f64,
    /// On the body.
    pub body: f64,
    /// On the load.
    pub load: f64,
}

/// A model with an elastic joint, and its flow over the durations used.
#[derive(Clone, Debug)]
pub(super) struct Joint {
    rates: SMatrix<f64, ALL, ALL>,
    steps: Vec<(f64, SMatrix<f64, MOVING, ALL>)>,
}

impl Joint {
    /// `None` for a model without a load.
    pub fn new(model: &Model) -> Option<Self> {
        let load = model.load?;
        let joint = load.coupling;
        let (b, b2) = (1.0 / model.inertia, 1.0 / load.inertia);
        let (k, d, mu) = (
            joint.stiffness,
            joint.damping,
            model.lag.map_or(0.0, |t| 1.0 / t),
        );
        #[rustfmt::skip]
        let rates = SMatrix::<f64, ALL, ALL>::from_row_slice(&[
            0.0,  0.0,    1.0,                      0.0,                      0.0, 0.0, 0.0, 0.0,
            0.0,  0.0,    1.0,                     -1.0,                      0.0, 0.0, 0.0, 0.0,
            0.0, -k * b, -(d + model.viscous) * b,  d * b,                    b,   0.0, b,   0.0,
            0.0,  k * b2, d * b2,                  -(d + load.viscous) * b2,  0.0, 0.0, 0.0, b2,
            0.0,  0.0,    0.0,                      0.0,                     -mu,  mu,  0.0, 0.0,
            0.0,  0.0,    0.0,                      0.0,                      0.0, 0.0, 0.0, 0.0,
            0.0,  0.0,    0.0,                      0.0,                      0.0, 0.0, 0.0, 0.0,
            0.0,  0.0,    0.0,                      0.0,                      0.0, 0.0, 0.0, 0.0,
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

    /// Motion from here under these forces, over times in which the joint does not swing far; body or load may be held
    /// by dry friction.
    pub fn series(&self, joined: &Joined, forces: &Forces, [body, load]: [bool; 2]) -> Series {
        let all = joined.vector(forces);
        let mut terms = [all.fixed_rows::<MOVING>(0).into_owned(); TERMS];
        for k in 1..TERMS {
            // What is held drives the first term alone.
            let held = if k == 1 {
                all.fixed_rows::<HELD>(MOVING).into_owned()
            } else {
                SVector::zeros()
            };
            terms[k] = self.rate(&terms[k - 1], &held) / k as f64;
            if body {
                terms[k][VELOCITY] = 0.0;
            }
            if load {
                terms[k][LOAD_VELOCITY] = 0.0;
            }
        }
        Series {
            from: joined.body.x,
            terms,
        }
    }

    /// Rates of change of what moves. Two thirds of the matrix are 0, and contacts take most of the time of a fit with
    /// a gap.
    fn rate(
        &self,
        moving: &SVector<f64, MOVING>,
        held: &SVector<f64, HELD>,
    ) -> SVector<f64, MOVING> {
        let [_, s, v, u, z] = (*moving).into();
        let [w, q, p] = (*held).into();
        let r = &self.rates;
        SVector::from([
            v,
            v - u,
            r[(2, 1)] * s + r[(2, 2)] * v + r[(2, 3)] * u + r[(2, 4)] * z + r[(2, 6)] * q,
            r[(3, 1)] * s + r[(3, 2)] * v + r[(3, 3)] * u + r[(3, 7)] * p,
            r[(4, 4)] * z + r[(4, 5)] * w,
        ])
    }

    /// State after `h` seconds under these forces; `None` for a duration that was not prepared.
    pub fn after(&self, joined: &Joined, forces: &Forces, h: f64) -> Option<Joined> {
        let (_, flow) = self.steps.iter().find(|(step, _)| *step == h)?;
        let to = flow * joined.vector(forces);
        Some(Joined::from_vector(joined.body.x, to.as_slice()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::runge_kutta::integrate;
    use crate::model::{Coupling, Engine, Load, State};

    /// `x, s, v, u, z` and the rates at which they change.
    fn rates(model: &Model, load: &Load, s: [f64; 5], forces: &Forces) -> [f64; 5] {
        let [_, twist, v, u, z] = s;
        let torque = load.coupling.stiffness * twist + load.coupling.damping * (v - u);
        [
            v,
            v - u,
            (z + forces.body - model.viscous * v - torque) / model.inertia,
            (torque + forces.load - load.viscous * u) / load.inertia,
            model.lag.map_or(0.0, |lag| (forces.input - z) / lag),
        ]
    }

    fn integrated(model: &Model, from: [f64; 5], forces: &Forces, h: f64) -> [f64; 5] {
        let load = model.load.expect("a load");
        integrate(|s, _| rates(model, &load, s, forces), from, h, 20_000)
    }

    fn model(half_gap: f64, dry_friction: f64) -> Model {
        Model {
            load: Some(Load {
                inertia: 7e-4,
                viscous: 1e-3,
                dry_friction,
                coupling: Coupling {
                    half_gap,
                    stiffness: 20.0,
                    damping: 4e-3,
                },
            }),
            ..Model::body(9e-4, 2e-3)
        }
    }

    #[test]
    fn body_and_load_move_as_integrated_in_small_steps() {
        for lag in [None, Some(2e-3)] {
            let model = Model {
                lag,
                ..model(0.0, 0.0)
            };
            let forces = Forces {
                input: 0.4,
                body: 0.03,
                load: -0.02,
            };
            let z = if lag.is_some() { 0.2 } else { forces.input };
            // A whole swing of the joint in one step.
            for h in [1e-4, 5e-3, 3e-2] {
                let mut joint = Joint::new(&model).expect("a load");
                joint.prepare(h);
                let joined = Joined {
                    body: Motion {
                        x: 100.0,
                        v: 3.0,
                        z,
                    },
                    twist: 0.01,
                    load: -1.0,
                };
                let to = joint.after(&joined, &forces, h).expect("prepared");
                let exact = integrated(&model, [0.0, 0.01, 3.0, -1.0, z], &forces, h);
                let found = [to.body.x - 100.0, to.twist, to.body.v, to.load, to.body.z];
                for (found, exact) in found.iter().zip(exact) {
                    assert!((found - exact).abs() < 1e-11, "{found} is not {exact}");
                }
            }
        }
    }

    #[test]
    fn body_and_load_that_rub_and_touch_throughout_lose_their_friction_only() {
        let half_gap = 0.004;
        let mut model = model(half_gap, 0.03);
        model.friction.level = 0.05;
        let mut engine = Engine::new(&model);
        engine.prepare(1e-3);
        let mut state = State::touching(half_gap + 0.03, 5.0, 4.0);
        let forces = Forces {
            input: 0.3,
            body: -0.05,
            load: -0.03,
        };
        let mut exact = [0.0, 0.03, 5.0, 4.0, 0.3];
        for _ in 0..8 {
            engine.advance(&mut state, 0.3, 1e-3);
            exact = integrated(&model, exact, &forces, 1e-3);
            assert!(exact[1] > 0.0 && exact[2] > 0.0 && exact[3] > 0.0);
        }
        assert!((state.velocity() - exact[2]).abs() < 1e-11);
        assert!((state.twist() - half_gap - exact[1]).abs() < 1e-13);
        assert!((state.load_velocity() - exact[3]).abs() < 1e-11);
    }

    #[test]
    fn a_stiffness_beyond_all_numbers_is_left_to_the_small_steps() {
        let mut model = model(0.0, 0.0);
        if let Some(load) = &mut model.load {
            load.coupling.stiffness = 1e308;
        }
        let mut joint = Joint::new(&model).expect("a load");
        joint.prepare(1e300);
        assert!(joint.steps.is_empty());
    }
}
