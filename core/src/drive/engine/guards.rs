//! Which guard a step meets first, and what happens there.

use super::DriveJob;
use crate::drive::Contact;
use crate::drive::flow::Step;
use crate::drive::modes::{holding, pull_share};
use crate::drive::polynomial::first_rise;
use crate::drive::state::Friction;
use crate::drive::trajectory::{EventKind, Mass, Side};

/// What ends a step before its time.
#[derive(Clone, Copy, Debug)]
pub(super) enum Guard {
    Relay,
    Stop(Mass),
    Break(Mass),
    Hit(Side),
    Release(Side),
    Repress(Side),
    Relax(Side),
}

/// Share of the fastest speed below which a rebound counts as none.
const NO_BOUNCE: f64 = 1e-9;

/// The same where rebounds lose next to nothing, [`LASTING`] or more: pressed together, such masses would go on
/// trembling for as long as the pressure lasts. What is lost is 1e-12 of the energy.
const NO_LASTING_BOUNCE: f64 = 1e-6;
const LASTING: f64 = 0.99;

/// Round-off of a few additions to the gap, in half gaps.
const ROUND_OFF: f64 = 8.0 * f64::EPSILON;

impl DriveJob {
    /// The first guard that a step meets, and where; its end and `None` if it meets none.
    pub(super) fn first_guard(&self, step: &Step) -> (f64, Option<Guard>) {
        let mut first = (1.0, None);
        let mut meet = |guard: Guard, constant: f64, a: f64, b: f64, c: f64| {
            let g = step.combine(constant, a, b, c);
            if let Some(z) = first_rise(&g[..step.terms], first.0)
                && (z < first.0 || first.1.is_none())
            {
                first = (z, Some(guard));
            }
        };
        let (s, drive) = (&self.state, &self.drive);
        if let (Some(relay), None) = (self.relay, self.look) {
            let sign = if self.high { -1.0 } else { 1.0 };
            meet(Guard::Relay, -relay.relay.hysteresis, sign, 0.0, 0.0);
        }
        let rigid = matches!(drive.contact, Contact::Rigid { .. });
        let together = rigid && s.joint.is_some();
        let level = drive.motor.coulomb + if together { drive.load.coulomb } else { 0.0 };
        if level > 0.0 && s.motor != Friction::Stuck {
            meet(Guard::Stop(Mass::Motor), 0.0, -s.motor.sign(), 0.0, 0.0);
        }
        if drive.load.coulomb > 0.0 && s.load != Friction::Stuck && !together {
            meet(Guard::Stop(Mass::Load), 0.0, 0.0, -s.load.sign(), 0.0);
        }
        if let (Some(end), Some(spring)) = (s.joint, s.spring(drive)) {
            let side = end.sign();
            let (k, d, offset) = (spring.stiffness, spring.damping, spring.offset);
            let constant = side * offset - holding(drive, end);
            meet(
                Guard::Release(end),
                constant,
                -side * d,
                side * d,
                -side * k,
            );
            let slack = s.slack(drive);
            for sign in [1.0, -1.0] {
                if s.motor == Friction::Stuck {
                    let constant = sign * (self.u + offset) - drive.motor.coulomb - slack;
                    let guard = Guard::Break(Mass::Motor);
                    meet(guard, constant, -sign * d, sign * d, -sign * k);
                }
                if s.load == Friction::Stuck {
                    let constant = -sign * offset - drive.load.coulomb - slack;
                    meet(
                        Guard::Break(Mass::Load),
                        constant,
                        sign * d,
                        -sign * d,
                        sign * k,
                    );
                }
            }
        } else if let Some(side) = s.joint {
            if s.motor != Friction::Stuck {
                let sign = -side.sign();
                let dry = sign * s.load.sign() * drive.load.coulomb;
                let hold = holding(drive, side) + pull_share(drive, self.u);
                let (j, d) = (sign * drive.load.inertia, sign * drive.load.viscous);
                let g = step.motor_force(j, d, dry - hold);
                if let Some(z) = first_rise(&g[..step.terms], first.0)
                    && (z < first.0 || first.1.is_none())
                {
                    first = (z, Some(Guard::Release(side)));
                }
            }
        } else {
            for side in [Side::Upper, Side::Lower] {
                let sign = side.sign();
                match drive.contact {
                    Contact::Compliant { stiffness, damping } if self.depth(side) > 0.0 => {
                        let (k, d) = (sign * stiffness, sign * damping);
                        meet(Guard::Repress(side), -stiffness * drive.half_gap, d, -d, k);
                        meet(Guard::Relax(side), drive.half_gap, 0.0, 0.0, -sign);
                    }
                    _ => meet(Guard::Hit(side), -drive.half_gap, 0.0, 0.0, sign),
                }
            }
        }
        first
    }

    pub(super) fn handle(&mut self, guard: Guard) {
        let half_gap = self.drive.half_gap;
        match guard {
            Guard::Relay => {
                let relay = self.relay.unwrap_or_default().relay;
                self.state.v1 = if self.high {
                    -relay.hysteresis
                } else {
                    relay.hysteresis
                };
                self.crossing();
            }
            Guard::Stop(mass) => {
                let rigid = matches!(self.drive.contact, Contact::Rigid { .. });
                let together = rigid && self.state.joint.is_some();
                if mass == Mass::Motor || together {
                    self.state.v1 = 0.0;
                }
                if mass == Mass::Load || together {
                    self.state.v2 = 0.0;
                }
                self.settle();
            }
            Guard::Break(mass) => {
                let force = self.state.spring_force(&self.drive);
                let (friction, force) = match mass {
                    Mass::Motor => (&mut self.state.motor, self.u - force),
                    Mass::Load => (&mut self.state.load, force),
                };
                *friction = if force < 0.0 {
                    Friction::Down
                } else {
                    Friction::Up
                };
                self.note(EventKind::Move(mass));
            }
            Guard::Hit(side) => {
                self.state.gap = side.sign() * half_gap;
                match self.drive.contact {
                    Contact::Rigid { restitution } => self.impact(side, restitution),
                    Contact::Compliant { .. } => {
                        self.state.joint = Some(side);
                        self.note(EventKind::Touch(side));
                        self.settle();
                    }
                }
            }
            Guard::Release(side) => {
                self.run.energy.contact += self.elastic_energy();
                self.state.joint = None;
                self.note(EventKind::Part(side));
                self.settle_free();
            }
            Guard::Repress(side) => {
                if self.depth(side) > 0.0 {
                    self.state.joint = Some(side);
                    self.run.energy.contact -= self.elastic_energy();
                    self.note(EventKind::Touch(side));
                    self.settle();
                }
            }
            // Just so, lest round-off leaves a rest of depth to be relaxed for ever.
            Guard::Relax(side) => self.state.gap = side.sign() * half_gap,
        }
    }

    /// Sets the modes anew and notes what changed.
    pub(super) fn settle(&mut self) {
        let before = self.state;
        self.state.settle(&self.drive, self.u);
        let after = self.state;
        match (before.joint, after.joint) {
            (None, Some(side)) => self.note(EventKind::Touch(side)),
            (Some(side), None) => self.note(EventKind::Part(side)),
            _ => {}
        }
        let masses = [
            (Mass::Motor, self.drive.motor, before.motor, after.motor),
            (Mass::Load, self.drive.load, before.load, after.load),
        ];
        for (mass, body, was, is) in masses {
            if was != is && body.coulomb > 0.0 {
                self.note(match is {
                    Friction::Stuck => EventKind::Stick(mass),
                    _ => EventKind::Move(mass),
                });
            }
        }
    }

    /// Friction of masses that have just parted.
    pub(super) fn settle_free(&mut self) {
        let s = &mut self.state;
        s.motor = Friction::of(s.v1, self.u, self.drive.motor.coulomb);
        s.load = Friction::of(s.v2, 0.0, self.drive.load.coulomb);
    }

    /// Relative speed of a rebound that rises no further than round-off of the gap: such bounces repeat
    /// each other instead of dying away.
    fn flattest_bounce(&self) -> f64 {
        let (motor, load) = (self.drive.motor, self.drive.load);
        let press = (self.u.abs() + motor.coulomb) / motor.inertia + load.coulomb / load.inertia;
        (2.0 * press * ROUND_OFF * self.drive.half_gap).sqrt()
    }

    /// Momentum is kept; the relative velocity turns round.
    pub(super) fn impact(&mut self, side: Side, restitution: f64) {
        let (j1, j2) = (self.drive.motor.inertia, self.drive.load.inertia);
        let sign = side.sign();
        let s = &self.state;
        let before = self.drive.kinetic_energy(s.v1, s.v2);
        let approach = sign * (s.v1 - s.v2);
        let least = if restitution < LASTING {
            NO_BOUNCE
        } else {
            NO_LASTING_BOUNCE
        };
        let least = (least * self.fastest).max(self.flattest_bounce());
        let s = &mut self.state;
        // Without a gap there is no room to bounce.
        let stays = self.drive.half_gap == 0.0 || restitution * approach <= least;
        if stays {
            let common = (j1 * s.v1 + j2 * s.v2) / (j1 + j2);
            (s.v1, s.v2) = (common, common);
            s.joint = Some(side);
        } else {
            let exchanged = sign * (1.0 + restitution) * approach / (j1 + j2);
            s.v1 -= exchanged * j2;
            s.v2 += exchanged * j1;
            self.fastest = self.fastest.max(s.v1.abs()).max(s.v2.abs());
        }
        let s = &self.state;
        self.run.energy.contact += before - self.drive.kinetic_energy(s.v1, s.v2);
        self.note(if stays {
            EventKind::Touch(side)
        } else {
            EventKind::Impact(side, approach)
        });
        self.settle();
    }
}
