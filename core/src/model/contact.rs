//! Dry friction in a contact that gives way elastically before it slips.
//!
//! After a reversal the friction force of a real contact does not jump: it follows the displacement
//! `x`, `F(x) = -c + 2 c (1 - exp(-x / s))` (Dahl 1968). Here a few springs, each behind a slider
//! (Prandtl 1928, Iwan 1966: the Maxwell-slip model), follow that curve, so that the motion stays
//! piecewise affine: it is found by exact flows between the instants at which a spring begins to slip
//! or the motion reverses.

use super::Model;
use super::flow::{Flow, Motion, Spring, root};

/// Displacements, in units of `s`, at which the springs slip one after the other after a reversal.
const KNOTS: [f64; 4] = [0.35, 1.0, 2.0, 4.0];

/// Shares of the friction level: with them the force lies on Dahl's curve at every knot but the
/// last, where it is complete.
const SHARES: [f64; 4] = [0.113_925, 0.285_701, 0.329_775, 0.270_599];

/// A contact with more radians of its own oscillation than this in one interval is taken as rigid.
const RIGID_RADIANS: f64 = 60.0;

/// Pieces of motion in one interval after which it ends in any case.
const MAX_PIECES: usize = 200;

/// A spring within this share of its slip counts as slipping.
const SLIP_SHARE: f64 = 1e-12;

/// Deflection of each spring, rad or m.
pub(super) type Deflection = [f64; 4];

/// The contact of one body.
#[derive(Clone, Debug)]
pub(super) struct Contact {
    inertia: f64,
    viscous: f64,
    lag: Option<f64>,
    /// Friction level for which `slips` hold.
    level: f64,
    /// Deflection at which each spring slips.
    slips: [f64; 4],
    stiffness: [f64; 4],
    total: f64,
    /// Damping while all springs stick.
    damping: f64,
}

impl Contact {
    /// The contact of `model`, if its friction is not rigid.
    pub fn new(model: &Model) -> Option<Self> {
        let friction = &model.friction;
        let level = friction.breakaway();
        if friction.presliding <= 0.0 || level <= 0.0 {
            return None;
        }
        // A reversal takes a spring from one slip to the other, twice its own.
        let slips = KNOTS.map(|x| 0.5 * x * friction.presliding);
        let mut stiffness = [0.0; 4];
        for ((k, share), slip) in stiffness.iter_mut().zip(SHARES).zip(slips) {
            *k = share * level / slip;
        }
        Some(Self {
            inertia: model.inertia,
            viscous: model.viscous,
            lag: model.lag,
            level,
            slips,
            stiffness,
            total: stiffness.iter().sum(),
            damping: 2.0
                * friction.contact_damping
                * (stiffness.iter().sum::<f64>() * model.inertia.abs()).sqrt(),
        })
    }

    /// Whether its own motion can be seen in intervals of `h` seconds.
    pub fn is_soft(&self, h: f64) -> bool {
        (self.total / self.inertia.abs()).sqrt() * h < RIGID_RADIANS
    }

    /// Moves the body for `h` seconds under the held input `w` and a held `force`, with dry friction at
    /// `level`; `free` is its flow while slipping.
    #[allow(
        clippy::too_many_arguments,
        reason = "state, what acts on it, and for how long"
    )]
    pub fn advance(
        &self,
        free: &Flow,
        motion: &mut Motion,
        deflection: &mut Deflection,
        force: f64,
        level: f64,
        w: f64,
        h: f64,
    ) {
        // The stiffness stays, so a lower level is reached at a smaller deflection.
        let slips = self.slips.map(|s| s * level / self.level);
        for (y, slip) in deflection.iter_mut().zip(slips) {
            *y = y.clamp(-slip, slip);
        }
        let acting = Acting {
            w,
            force,
            level,
            slips,
        };
        let mut left = h;
        for _ in 0..MAX_PIECES {
            if left <= 0.0 {
                return;
            }
            let held: f64 = self
                .stiffness
                .iter()
                .zip(deflection.iter())
                .map(|(k, y)| k * y)
                .sum();
            let direction = if motion.v == 0.0 {
                (motion.z + force - held).signum()
            } else {
                motion.v.signum()
            };
            let sticking: [bool; 4] =
                std::array::from_fn(|i| deflection[i] * direction < slips[i] * (1.0 - SLIP_SHARE));
            left -= if sticking.contains(&true) {
                self.deflect(&acting, motion, deflection, sticking, direction, held, left)
            } else {
                acting.slip(free, motion, direction, left)
            };
        }
    }

    /// Some springs stick, until the next one slips or the motion reverses; returns the time used.
    #[allow(
        clippy::too_many_arguments,
        reason = "one piece of motion, taken apart for reading only"
    )]
    fn deflect(
        &self,
        acting: &Acting,
        motion: &mut Motion,
        deflection: &mut Deflection,
        sticking: [bool; 4],
        direction: f64,
        held: f64,
        left: f64,
    ) -> f64 {
        let slips = &acting.slips;
        let stiffness: f64 = (0..4)
            .filter(|i| sticking[*i])
            .map(|i| self.stiffness[i])
            .sum();
        let damping = self.viscous + self.damping * stiffness / self.total;
        let spring = Spring::new(self.inertia, stiffness, damping, self.lag);
        // One spring with the force of all: its deflection is that force over the stiffness.
        let start = Motion {
            x: held / stiffness,
            ..*motion
        };
        let at = |t: f64| spring.after(start, acting.w, acting.force, t);
        // Short enough that the motion reverses at most once.
        let mut time = left.min(1.0 / spring.frequency());
        let mut end = at(time);
        if end.v * direction < 0.0 {
            time = if start.v == 0.0 {
                time
            } else {
                root(time, start.v, end.v, |t| at(t).v)
            };
            end = at(time);
            end.v = if start.v == 0.0 { end.v } else { 0.0 };
        }
        let room = (0..4)
            .filter(|i| sticking[*i])
            .map(|i| slips[i] - deflection[i] * direction)
            .fold(f64::INFINITY, f64::min);
        let travelled = |m: &Motion| (m.x - start.x) * direction;
        if travelled(&end) > room {
            time = root(time, -room, travelled(&end) - room, |t| {
                travelled(&at(t)) - room
            });
            end = at(time);
        }
        let moved = end.x - start.x;
        for (i, y) in deflection.iter_mut().enumerate() {
            if sticking[i] {
                *y = (*y + moved).clamp(-slips[i], slips[i]);
                if slips[i] - *y * direction < 1e-9 * slips[i] {
                    *y = direction * slips[i];
                }
            }
        }
        *motion = Motion {
            x: motion.x + moved,
            ..end
        };
        time
    }
}

/// What acts on the body over one interval.
struct Acting {
    w: f64,
    force: f64,
    level: f64,
    /// Deflection at which each spring slips at this level.
    slips: [f64; 4],
}

impl Acting {
    /// All springs slip, until the motion reverses; returns the time used.
    fn slip(&self, free: &Flow, motion: &mut Motion, direction: f64, left: f64) -> f64 {
        let start = *motion;
        let q = self.force - direction * self.level;
        let end = free.after_cached(start, self.w, q, left);
        if end.v * direction >= 0.0 || start.v == 0.0 {
            *motion = end;
            return left;
        }
        let time = root(left, start.v, end.v, |t| free.after(start, self.w, q, t).v);
        *motion = Motion {
            v: 0.0,
            ..free.after(start, self.w, q, time)
        };
        time
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn force_after_a_reversal_lies_on_dahls_curve() {
        assert!((SHARES.iter().sum::<f64>() - 1.0).abs() < 1e-5);
        for x in [0.35_f64, 1.0, 2.0] {
            let force: f64 = SHARES
                .iter()
                .zip(KNOTS)
                .map(|(share, knot)| share * (x / knot).min(1.0))
                .sum();
            assert!((force - (1.0 - (-x).exp())).abs() < 1e-4, "{x}: {force}");
        }
    }
}
