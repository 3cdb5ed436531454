//! A load behind an elastic joint or a gap.
//!
//! The joint is a spring with damping; with a half gap `beta` it touches only where the twist
//! exceeds `beta`, and then it can push but not pull (dead-zone contact, Nordin and Gutman 2002).
//! Rigid play with an impact, equations (10) and (11) of the paper, is its limit for large stiffness.

use super::flow::{Flow, Motion};
use super::friction::{Mode, slide};

/// How body and load are joined.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coupling {
    /// Half gap beta, rad or m; 0 for a joint without play, which also pulls.
    pub half_gap: f64,
    /// Stiffness, N m/rad or N/m; above 0.
    pub stiffness: f64,
    /// Damping, N m s/rad or N s/m; at least 0.
    pub damping: f64,
}

impl Coupling {
    /// Torque or force on the load at `twist` x1 - x2 and its `rate`.
    pub fn force(&self, twist: f64, rate: f64) -> f64 {
        if self.half_gap == 0.0 {
            return self.stiffness * twist + self.damping * rate;
        }
        let pressed = twist.abs() - self.half_gap;
        if pressed <= 0.0 {
            return 0.0;
        }
        let side = twist.signum();
        side * (self.stiffness * pressed + self.damping * rate * side).max(0.0)
    }
}

/// The second body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Load {
    /// Load inertia J2, kg m^2 or kg; above 0.
    pub inertia: f64,
    /// Load viscous friction d2; at least 0.
    pub viscous: f64,
    /// Load Coulomb friction; at least 0.
    pub dry_friction: f64,
    /// How it is joined to the body.
    pub coupling: Coupling,
}

/// Radians of the fastest oscillation in one step; its phase is then right to a few parts in ten
/// thousand.
const STEP_RADIANS: f64 = 0.2;

impl Load {
    /// Longest step for the exponential midpoint rule in contact with a body of `inertia`, s.
    pub(super) fn longest_step(&self, inertia: f64) -> f64 {
        let compliance = 1.0 / inertia.abs() + 1.0 / self.inertia;
        let frequency = (self.coupling.stiffness * compliance).sqrt();
        let damping = self.coupling.damping * compliance;
        STEP_RADIANS / frequency.max(damping)
    }

    /// Whether body and load may touch within `h` seconds.
    pub(super) fn may_touch(&self, twist: f64, rate: f64, h: f64) -> bool {
        twist.abs() + 2.0 * rate.abs() * h >= self.coupling.half_gap
    }
}

/// Torque or force that a load with `coupling` would put on a body which is moved as measured:
/// `position` at equal steps of `h` seconds, the load at rest in the middle of the gap at first.
///
/// Since the body's motion is given, the load cannot drift away from it: whole records can be
/// compared with the force that a model lacks, without windows.
pub fn load_torque(load: &Load, position: &[f64], h: f64) -> Vec<f64> {
    let flow = Flow::new(load.inertia, load.viscous, None);
    let steps = (h / load.longest_step(f64::INFINITY)).ceil().clamp(1.0, 32.0) as usize;
    let part = h / steps as f64;
    let (mut motion, mut mode) = (Motion::default(), Mode::Stick);
    motion.x = position.first().copied().unwrap_or(0.0);
    let mut torque = Vec::with_capacity(position.len());
    for pair in position.windows(2) {
        let v1 = (pair[1] - pair[0]) / h;
        let mut sum = 0.0;
        let steps = if load.may_touch(pair[0] - motion.x, v1 - motion.v, h) {
            steps
        } else {
            1
        };
        let part = if steps == 1 { h } else { part };
        for k in 0..steps {
            let middle = pair[0] + v1 * part * (k as f64 + 0.5);
            let twist = middle - motion.x - 0.5 * part * motion.v;
            let force = load.coupling.force(twist, v1 - motion.v);
            sum += force;
            slide(&flow, &mut motion, &mut mode, 0.0, force, load.dry_friction, part);
        }
        torque.push(sum / steps as f64);
    }
    torque.push(torque.last().copied().unwrap_or(0.0));
    torque
}
