//! Sticking, slipping and touching: which mode follows from a state and the torque that acts.

use super::spring::Spring;
use super::state::{Friction, State};
use super::trajectory::Side;
use super::{Body, Contact, Drive};

/// Share of the forces by which a contact must pull before it counts as parting: above round-off, so
/// that a contact without force is no endless coming and going.
const PULL: f64 = 1e-12;

/// Share of a spring's terms that is round-off.
const SLACK: f64 = 8.0 * f64::EPSILON;

impl State {
    /// The spring of the contact, if the masses touch and it has one.
    pub fn spring(&self, drive: &Drive) -> Option<Spring> {
        Spring::at(drive, self.joint?)
    }

    /// Torque or force on the load from the spring.
    pub fn spring_force(&self, drive: &Drive) -> f64 {
        self.spring(drive).map_or(0.0, |s| s.force(self))
    }

    /// How far beyond a level the force of a spring must be to overcome it: what round-off of the gap makes
    /// of the force. Less than that would begin a motion against which the very next step decides.
    pub fn slack(&self, drive: &Drive) -> f64 {
        self.spring(drive).map_or(0.0, |s| {
            let damped = s.damping * (self.v1.abs() + self.v2.abs());
            SLACK * (s.stiffness * self.gap.abs() + damped + s.offset.abs())
        })
    }

    /// Sets the modes that follow from the velocities, the gap and the torque `u`.
    pub fn settle(&mut self, drive: &Drive, u: f64) {
        if matches!(drive.contact, Contact::Rigid { .. }) {
            if self.joint.is_none() {
                self.joint = self.begins_to_press(drive, u);
            }
            if let Some(side) = self.joint {
                if self.stays_together(drive, u, side) {
                    return;
                }
                self.joint = None;
            }
        }
        let (force, slack) = (self.spring_force(drive), self.slack(drive));
        let level = |body: Body| {
            if body.coulomb > 0.0 {
                body.coulomb + slack
            } else {
                0.0
            }
        };
        self.motor = Friction::of(self.v1, u - force, level(drive.motor));
        self.load = Friction::of(self.v2, force, level(drive.load));
    }

    /// The end at which masses without relative speed would move into each other.
    fn begins_to_press(&self, drive: &Drive, u: f64) -> Option<Side> {
        if self.v1 != self.v2 || self.gap.abs() != drive.half_gap {
            return None;
        }
        let closing =
            acceleration(&drive.motor, self.v1, u) - acceleration(&drive.load, self.v2, 0.0);
        [Side::Upper, Side::Lower]
            .into_iter()
            .find(|s| s.sign() * self.gap == drive.half_gap && s.sign() * closing > 0.0)
    }

    /// Whether rigidly touching masses go on so; sets their friction if they do.
    fn stays_together(&mut self, drive: &Drive, u: f64, side: Side) -> bool {
        let (motor, load) = (drive.motor, drive.load);
        let sign = side.sign();
        let pull = holding(drive, side) + pull_share(drive, u);
        let level = motor.coulomb + load.coulomb;
        let push = sign * u;
        if self.v1 == 0.0 && level > 0.0 {
            // At rest the force on the load is any that both frictions can bear.
            let least = (-pull).max(-load.coulomb).max(push - motor.coulomb);
            let most = load.coulomb.min(push + motor.coulomb);
            if least <= most {
                (self.motor, self.load) = (Friction::Stuck, Friction::Stuck);
                return true;
            }
            if u.abs() <= level {
                return false;
            }
        }
        let friction = Friction::of(self.v1, u, 0.0);
        let dry = friction.sign();
        let inertia = motor.inertia + load.inertia;
        let a = (u - dry * level - (motor.viscous + load.viscous) * self.v1) / inertia;
        let force = load.inertia * a + load.viscous * self.v1 + dry * load.coulomb;
        (self.motor, self.load) = (friction, friction);
        sign * force >= -pull
    }
}

/// Pull that the contact at an end withstands.
pub(super) fn holding(drive: &Drive, side: Side) -> f64 {
    match side {
        Side::Upper => drive.adhesion.upper,
        Side::Lower => drive.adhesion.lower,
    }
}

/// Pull that counts as none.
pub(super) fn pull_share(drive: &Drive, u: f64) -> f64 {
    PULL * (u.abs() + drive.motor.coulomb + drive.load.coulomb)
}

/// Acceleration of a mass by itself.
fn acceleration(body: &Body, v: f64, force: f64) -> f64 {
    let friction = Friction::of(v, force, body.coulomb);
    if friction == Friction::Stuck {
        return 0.0;
    }
    (force - friction.sign() * body.coulomb - body.viscous * v) / body.inertia
}
