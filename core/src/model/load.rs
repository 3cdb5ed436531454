//! A load behind an elastic joint or a gap.
//!
//! The joint is a spring with damping; with a half gap `beta` it touches only where the twist
//! exceeds `beta`, and then it can push but not pull (dead-zone contact, Nordin and Gutman 2002).
//! Rigid play with an impact, equations (10) and (11) of the paper, is its limit for large stiffness.

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
            return self.unlimited(twist, rate);
        }
        let pressed = twist.abs() - self.half_gap;
        if pressed <= 0.0 {
            return 0.0;
        }
        let side = twist.signum();
        side * (self.stiffness * pressed + self.damping * rate * side).max(0.0)
    }

    /// The same of a joint that pulls too, with a `twist` that counts from the end of its play.
    pub(super) fn unlimited(&self, twist: f64, rate: f64) -> f64 {
        self.stiffness * twist + self.damping * rate
    }

    /// Whether body and load are joined at `twist` and its `rate`: always without play, else where they push each
    /// other on this `side` of it.
    pub(super) fn joins(&self, side: f64, twist: f64, rate: f64) -> bool {
        self.half_gap == 0.0 || (side * twist > self.half_gap && self.force(twist, rate) != 0.0)
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
pub(super) const STEP_RADIANS: f64 = 0.2;

impl Load {
    /// Rate at which its swing on a joint loses energy, 1/s: twice the rate at which the swing decays.
    pub(super) fn decay(&self) -> f64 {
        (self.coupling.damping + self.viscous) / self.inertia
    }

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
