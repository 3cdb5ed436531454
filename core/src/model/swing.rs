//! Exact flow over one interval of a load on an elastic joint whose other end moves as given.
//!
//! ```text
//! J2 u' = K (x1 - x2) + D (v1 - u) - d2 u + f      x1 = from + begin s + bend s^2 / 2,  s = t / h
//! ```

use nalgebra::{DMatrix, SMatrix};

use super::flow::Motion;
use super::load::Load;
use crate::exponential::exponential;

/// Radians of a contact with play in one interval up to which its ends tell whether the contact lasts.
const SEEN_RADIANS: f64 = 1.0;

/// How the body moves over the interval.
pub(super) struct Parabola {
    /// Where it begins.
    pub from: f64,
    /// Velocity there times `h`.
    pub begin: f64,
    /// Acceleration times `h^2`.
    pub bend: f64,
}

/// The flow.
pub(super) struct Swing {
    /// Length of the interval, s.
    pub h: f64,
    /// Place from where the body begins and velocity times `h` at the end, per unit of these at the begin, of the
    /// body's begin and bend, and of the force on the load times `h^2` over its inertia.
    flow: SMatrix<f64, 2, 5>,
    inertia: f64,
    viscous: f64,
}

impl Swing {
    /// `None` where the flow is beyond all numbers, or a contact with play may end and begin again unseen.
    pub fn new(load: &Load, h: f64) -> Option<Self> {
        let joint = load.coupling;
        let (k, d) = (joint.stiffness * h * h / load.inertia, h / load.inertia);
        if joint.half_gap > 0.0 && k > SEEN_RADIANS * SEEN_RADIANS {
            return None;
        }
        // Place and velocity of the load; place, velocity and acceleration of the body; force.
        let rates = [
            [0.0, 1.0, 0.0, 0.0, 0.0, 0.0],
            [
                -k,
                -(joint.damping + load.viscous) * d,
                k,
                joint.damping * d,
                0.0,
                1.0,
            ],
            [0.0, 0.0, 0.0, 1.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, 1.0, 0.0],
            [0.0; 6],
            [0.0; 6],
        ];
        let flow = exponential(DMatrix::from_fn(6, 6, |i, j| rates[i][j]));
        let columns = [0, 1, 3, 4, 5].map(|j| [flow[(0, j)], flow[(1, j)]]);
        let finite = columns.iter().flatten().all(|v| v.is_finite());
        finite.then(|| Self {
            h,
            flow: SMatrix::from(columns),
            inertia: load.inertia,
            viscous: load.viscous,
        })
    }

    /// Motion of the load after the interval, with this force on it besides; and the mean torque or force of the joint.
    pub fn advance(&self, load: Motion, body: &Parabola, force: f64) -> (Motion, f64) {
        let start = [load.x - body.from, load.v * self.h];
        let end = self.next(start, body, self.pull(force));
        let next = Motion {
            x: body.from + end[0],
            v: end[1] / self.h,
            z: load.z,
        };
        (next, self.torque(start, end) - force)
    }

    /// What a force on the load pulls in an interval.
    pub fn pull(&self, force: f64) -> f64 {
        force * self.h * self.h / self.inertia
    }

    /// Place of the load from where the body begins, and its velocity times `h`, after the interval; from where it
    /// begins, whatever the body's `from`.
    pub fn next(&self, [place, velocity]: [f64; 2], body: &Parabola, pull: f64) -> [f64; 2] {
        let f = &self.flow;
        // The load's own part last: the next interval waits for it.
        [0, 1].map(|i| {
            let given = f[(i, 2)] * body.begin + f[(i, 3)] * body.bend + f[(i, 4)] * pull;
            given + (f[(i, 0)] * place + f[(i, 1)] * velocity)
        })
    }

    /// Mean torque or force on the load that takes it from one to the other.
    pub fn torque(&self, start: [f64; 2], end: [f64; 2]) -> f64 {
        let rate = 1.0 / self.h;
        let momentum =
            self.inertia * rate * (end[1] - start[1]) + self.viscous * (end[0] - start[0]);
        momentum * rate
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Coupling;
    use crate::model::runge_kutta::integrate;

    const LOAD: Load = Load {
        inertia: 7e-4,
        viscous: 1e-3,
        dry_friction: 0.0,
        coupling: Coupling {
            half_gap: 0.0,
            stiffness: 20.0,
            damping: 4e-3,
        },
    };

    /// Place, velocity and the integral of the torque.
    fn integrated(body: &Parabola, start: Motion, force: f64, h: f64) -> [f64; 3] {
        let rates = |s: [f64; 3], t: f64| {
            let share = t / h;
            let x1 = body.from + body.begin * share + 0.5 * body.bend * share * share;
            let v1 = (body.begin + body.bend * share) / h;
            let joint = LOAD.coupling;
            let torque = joint.stiffness * (x1 - s[0]) + joint.damping * (v1 - s[1]);
            [
                s[1],
                (torque + force - LOAD.viscous * s[1]) / LOAD.inertia,
                torque,
            ]
        };
        integrate(rates, [start.x, start.v, 0.0], h, 10_000)
    }

    #[test]
    fn a_load_moves_as_integrated_in_small_steps() {
        let body = Parabola {
            from: 3.0,
            begin: 0.02,
            bend: -0.013,
        };
        let start = Motion {
            x: 2.99,
            v: 4.0,
            z: 0.0,
        };
        for h in [1e-4, 3e-3, 3e-2] {
            let swing = Swing::new(&LOAD, h).expect("finite");
            let (end, torque) = swing.advance(start, &body, -0.03);
            let [x, v, sum] = integrated(&body, start, -0.03, h);
            assert!((end.x - x).abs() < 1e-12, "{} is not {x}", end.x);
            assert!((end.v - v).abs() < 1e-10, "{} is not {v}", end.v);
            assert!(
                (torque - sum / h).abs() < 1e-9,
                "{torque} is not {}",
                sum / h
            );
        }
    }

    #[test]
    fn a_stiff_contact_with_play_is_left_to_small_steps() {
        let mut load = LOAD;
        assert!(Swing::new(&load, 3e-2).is_some());
        load.coupling.half_gap = 1e-3;
        assert!(Swing::new(&load, 3e-2).is_none());
        assert!(Swing::new(&load, 1e-3).is_some());
        load.coupling.stiffness = f64::INFINITY;
        assert!(Swing::new(&load, 1e-3).is_none());
    }
}
