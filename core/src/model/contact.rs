//! Dry friction in a contact that gives way elastically before it slips.
//!
//! After a reversal the friction force of a real contact does not jump: it follows the displacement
//! `x`, `F(x) = -c + 2 c (1 - exp(-x / s))`. A bristle with deflection `z` and stiffness `c / s` does
//! this (Dahl 1968), with damping of its own it is the model of Canudas de Wit, Olsson, Åström and
//! Lischinsky (1995). The deflection is found exactly from the displacement as long as the motion keeps
//! its direction; over short pieces the body moves on the spring that joins their ends, by its exact
//! flow; while the bristle slips, by the flow of the free body. Reversals are located as events.

use super::flow::{Flow, Motion, Spring};
use super::{Model, short};

/// A contact with more radians of its own oscillation than this in one interval is taken as rigid.
const RIGID_RADIANS: f64 = 4.0;

/// Pieces of motion in one interval after which it ends in any case.
const MAX_PIECES: u32 = 60;

/// Share of its stiffness below which a bristle slips.
const SLIP_SHARE: f64 = 1e-3;

/// Displacement of one piece, in units of `s` over the share of the stiffness that is left.
const PIECE: f64 = 0.3;

/// Longest piece in units of `s`, and in radians of the contact's oscillation.
const LONGEST_PIECE: f64 = 5.0;
const PIECE_RADIANS: f64 = 0.35;

/// A bristle settles within this many times `s`; a body so fast that its acceleration changes its square of speed by
/// less than one part in so many within `s` is past that before it has felt more than the impulse of it.
const SETTLED: f64 = 8.0;
const FLYING: f64 = 1e3;

/// Way in units of `s` below which the mean of an exponential over it is a short series.
const SHORT_WAY: f64 = 1e-3;

/// A displacement below this share of the motion that is left is crossed at once: far less would be lost in
/// the digits of the position.
const UNSEEN: f64 = 1e-9;

/// The contact of one body.
#[derive(Clone, Debug)]
pub(super) struct Contact {
    /// Inverse inertia of the body.
    b: f64,
    viscous: f64,
    /// Rate of the lag of its input.
    mu: Option<f64>,
    stiffness: f64,
    /// Deflection at which the friction at rest is overcome: the largest there is.
    reach: f64,
    /// Natural angular frequency while the bristle does not slip at all, rad/s.
    frequency: f64,
    /// While the bristle does not slip at all.
    damping: f64,
}

/// Deflection of a bristle that slips at `limit` after a displacement `moved` one way from the deflection `z` (Dahl
/// 1968).
pub(crate) fn dahl(z: f64, moved: f64, limit: f64) -> f64 {
    let steady = limit * moved.signum();
    steady + (z - steady) * libm::exp(-moved.abs() / limit)
}

/// A bristle on its way from a deflection `z`, as it follows the displacement.
struct Bent<'a> {
    acting: &'a Acting,
    z: f64,
}

impl Bent<'_> {
    /// Deflection after the displacement `moved`.
    fn at(&self, moved: f64) -> f64 {
        let steady = self.acting.limit * moved.signum();
        steady + (self.z - steady) * short::exp(-moved.abs() * self.acting.inverse)
    }

    /// Size of the change of deflection per displacement over `moved`, and by how much its mean over the displacement
    /// lies above the middle of its ends; `None` where it does not move.
    fn chord(&self, moved: f64) -> Option<(f64, f64)> {
        let way = moved.abs() * self.acting.inverse;
        if way <= f64::MIN_POSITIVE {
            return None;
        }
        let left = short::exp(-way);
        let slope = (1.0 - left) / way;
        let ahead = self.acting.limit * moved.signum() - self.z;
        let mean = if way < SHORT_WAY {
            way * way / 12.0 * (1.0 - 0.5 * way)
        } else {
            0.5 * (1.0 + left) - slope
        };
        Some((ahead.abs() * slope * self.acting.inverse, ahead * mean))
    }
}

/// What acts on the body over one interval.
struct Acting {
    w: f64,
    force: f64,
    level: f64,
    /// Deflection at which the bristle slips, and its inverse.
    limit: f64,
    inverse: f64,
}

impl Contact {
    /// The contact of `model`, if its friction is not rigid.
    pub fn new(model: &Model) -> Option<Self> {
        let friction = &model.friction;
        let level = friction.breakaway();
        if friction.presliding <= 0.0 || level <= 0.0 {
            return None;
        }
        let stiffness = level / friction.presliding;
        Some(Self {
            b: 1.0 / model.inertia,
            viscous: model.viscous,
            mu: model.lag.map(|tau| 1.0 / tau),
            stiffness,
            reach: friction.presliding,
            frequency: (stiffness / model.inertia.abs()).sqrt(),
            damping: 2.0 * friction.contact_damping * (stiffness * model.inertia.abs()).sqrt(),
        })
    }

    /// Whether its own motion can be seen in intervals of `h` seconds.
    pub fn is_soft(&self, h: f64) -> bool {
        self.frequency * h < RIGID_RADIANS
    }

    /// Whether it slips at friction `level` while the body moves on at `velocity`.
    pub fn slips(&self, deflection: f64, velocity: f64, level: f64) -> bool {
        velocity * deflection > 0.0
            && (1.0 - deflection.abs() * self.stiffness / level).abs() <= SLIP_SHARE
    }

    /// Deflection after a known displacement `moved` at friction `level`.
    pub fn followed(&self, deflection: f64, moved: f64, level: f64) -> f64 {
        dahl(self.within_reach(deflection), moved, level / self.stiffness)
    }

    fn within_reach(&self, deflection: f64) -> f64 {
        deflection.max(-self.reach).min(self.reach)
    }

    /// Moves the body for `h` seconds under the held input `w` and a held `force`, with dry friction at
    /// `level`; `free` is its flow while slipping. Returns the pieces of motion that this took.
    #[allow(
        clippy::too_many_arguments,
        reason = "state, what acts on it, and for how long"
    )]
    pub fn advance(
        &self,
        free: &Flow,
        motion: &mut Motion,
        deflection: &mut f64,
        force: f64,
        level: f64,
        w: f64,
        h: f64,
    ) -> u32 {
        // The stiffness stays, so a lower level is reached at a smaller deflection; where the level has fallen
        // below the force of the bristle, that force fades as the body moves on.
        let limit = level / self.stiffness;
        if limit.is_nan() {
            // A wild trial of a fit; its motion is no number any more.
            return 0;
        }
        *deflection = self.within_reach(*deflection);
        let acting = Acting {
            w,
            force,
            level,
            limit,
            inverse: self.stiffness / level,
        };
        let mut left = h;
        for pieces in 0..MAX_PIECES {
            // Not so either where a wild motion has used a time that is no number.
            if !(left > 0.0 && motion.v.is_finite()) {
                return pieces;
            }
            let direction = if motion.v == 0.0 {
                (motion.z + force - self.stiffness * *deflection).signum()
            } else {
                motion.v.signum()
            };
            let share = 1.0 - direction * *deflection * acting.inverse;
            let seen = limit > UNSEEN * (motion.v * left).abs();
            let past = self.is_past(&acting, *motion, left);
            left -= if seen && !past && share.abs() > SLIP_SHARE {
                self.bend(&acting, motion, deflection, direction, left)
            } else {
                if past {
                    motion.v += self.kick(&acting, direction * limit - *deflection, motion.v);
                }
                *deflection = direction * limit;
                acting.slip(free, motion, direction, left)
            };
        }
        MAX_PIECES
    }

    /// Whether the body is so fast that the bristle settles at once, within `left` seconds.
    fn is_past(&self, acting: &Acting, motion: Motion, left: f64) -> bool {
        let acceleration =
            (motion.z.abs() + acting.force.abs() + 2.0 * acting.level) * self.b.abs();
        motion.v * motion.v > FLYING * acting.limit * acceleration
            && motion.v.abs() * left > SETTLED * acting.limit
    }

    /// Change of velocity while the deflection grows by `ahead` to where the bristle slips, over what slipping itself
    /// does: the impulse of `stiffness ahead exp(-|v| t / limit)`, and of the damping of the contact.
    fn kick(&self, acting: &Acting, ahead: f64, v: f64) -> f64 {
        self.b * ahead * (self.stiffness * acting.limit / v.abs() - self.damping)
    }

    /// The bristle bends on, until the motion reverses or the piece is long enough; returns the time used.
    fn bend(
        &self,
        acting: &Acting,
        motion: &mut Motion,
        deflection: &mut f64,
        direction: f64,
        left: f64,
    ) -> f64 {
        let (start, z) = (*motion, *deflection);
        let bent = Bent { acting, z };
        let share = 1.0 - direction * z * acting.inverse;
        // The bristle's force at the start is held, and a spring takes what it changes by.
        let here = Motion { x: 0.0, ..start };
        let held = acting.force - self.stiffness * z;
        let time = self.piece(acting, start.v, start.z + held, share.abs(), left);
        let guess = self.spring(share).moved(here, acting.w, held, time);
        // The spring that joins the ends of the piece instead of the one at its start, and by how much its mean force
        // is off: the bristle's is bent between them.
        let (share, missing) = match bent.chord(guess) {
            Some((joined, missing)) => {
                let size = joined.clamp(SLIP_SHARE * 0.5, 2.0);
                (size.copysign(share), missing)
            }
            None => (share, 0.0),
        };
        let held = held - self.stiffness * missing;
        let spring = self.spring(share);
        let mut end = spring.after(here, acting.w, held, time);
        let mut used = time;
        if end.v * direction < 0.0 && start.v != 0.0 {
            used = spring.stops(here, acting.w, held, time, end.v);
            end = spring.after(here, acting.w, held, used);
            end.v = 0.0;
        }
        let moved = end.x;
        *deflection = if moved * direction > 0.0 {
            bent.at(moved)
        } else {
            self.within_reach(z + moved)
        };
        *motion = Motion {
            x: start.x + moved,
            ..end
        };
        used
    }

    /// Time of a piece of at most `left` seconds in which neither the bristle bends far, under the force `net` on the
    /// body, nor the contact swings far; `share` of its stiffness is left.
    fn piece(&self, acting: &Acting, v: f64, net: f64, share: f64, left: f64) -> f64 {
        let (v, a) = (v.abs(), (net * self.b).abs());
        let mut time = left;
        let way = left * (v + 0.5 * a * left) * acting.inverse;
        if way * share > PIECE || way > LONGEST_PIECE {
            let reach = acting.limit * (PIECE / share).min(LONGEST_PIECE);
            time = time.min(2.0 * reach / (v + (v * v + 2.0 * a * reach).sqrt()));
        }
        let turned = self.frequency * time;
        if turned * turned * share > PIECE_RADIANS * PIECE_RADIANS {
            time = PIECE_RADIANS / (self.frequency * share.sqrt());
        }
        time
    }

    /// Body on a bristle that has this share of its stiffness left.
    fn spring(&self, share: f64) -> Spring {
        Spring::new(
            self.b,
            share * self.stiffness,
            self.viscous + share * self.damping,
            self.mu,
        )
    }
}

impl Acting {
    /// The bristle slips, until the motion reverses; returns the time used.
    fn slip(&self, free: &Flow, motion: &mut Motion, direction: f64, left: f64) -> f64 {
        let start = *motion;
        let q = self.force - direction * self.level;
        let end = free.after_cached(start, self.w, q, left);
        if end.v * direction >= 0.0 || start.v == 0.0 {
            *motion = end;
            return left;
        }
        let time = free.stops(start, self.w, q, left, end.v);
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
    use crate::model::engine::Engine;
    use crate::model::state::State;
    use crate::model::{DryFriction, Model, runge_kutta};

    /// The contact of a body that rubs, whose friction builds up over this displacement, and its free flow.
    fn rubbing(presliding: f64) -> (Contact, Flow) {
        let mut model = Model::body(9e-4, 2e-3);
        model.friction = DryFriction {
            level: 0.05,
            presliding,
            contact_damping: 0.2,
            ..DryFriction::default()
        };
        let free = Flow::new(model.inertia, model.viscous, None);
        (Contact::new(&model).unwrap(), free)
    }

    /// Bristle, body and input in many small steps, as an independent reference.
    fn integrate(
        contact: &Contact,
        level: impl Fn(f64) -> f64,
        w: f64,
        h: f64,
        s: [f64; 3],
    ) -> [f64; 3] {
        let rates = |[_, v, z]: [f64; 3], _| {
            let rate = v - contact.stiffness * v.abs() / level(v) * z;
            let force = contact.stiffness * z + contact.damping * rate;
            [v, (w - contact.viscous * v - force) * contact.b, rate]
        };
        runge_kutta::integrate(rates, s, h, 2_000)
    }

    #[test]
    fn agrees_with_small_steps_of_runge_kutta() {
        let (contact, free) = rubbing(2e-5);
        let (h, level) = (2e-4, 0.05);
        let mut motion = Motion::default();
        let (mut z, mut exact) = (0.0, [0.0; 3]);
        for (i, u) in [0.5, 0.5, -0.5, -0.5, -0.5, 0.03, 0.03, 0.3, 0.0, 0.0]
            .into_iter()
            .enumerate()
        {
            motion.z = u;
            contact.advance(&free, &mut motion, &mut z, 0.0, level, u, h);
            exact = integrate(&contact, |_| level, u, h, exact);
            // To a hundredth of the displacement over which friction builds up, and of the velocity
            // that a sample brings.
            assert!(
                (motion.x - exact[0]).abs() < 1e-2 * 2e-5,
                "{i}: {} {}",
                motion.x,
                exact[0]
            );
            assert!(
                (motion.v - exact[1]).abs() < 1e-2 * 0.1,
                "{i}: {} {}",
                motion.v,
                exact[1]
            );
        }
    }

    #[test]
    fn the_force_of_a_bristle_lags_behind_a_level_that_falls_with_speed() {
        let mut model = Model::body(9e-4, 2e-3);
        model.friction = DryFriction {
            level: 0.03,
            static_excess: 0.04,
            stribeck_speed: 0.7,
            presliding: 5e-5,
            contact_damping: 0.1,
            ..DryFriction::default()
        };
        let contact = Contact::new(&model).unwrap();
        let engine = Engine::new(&model);
        let h = 2e-4;
        let (mut state, mut exact) = (State::at_rest(0.0), [0.0; 3]);
        // It breaks loose and turns round twice.
        let inputs = [(0.2, 40), (-0.12, 120), (0.1, 100)];
        for (u, count) in inputs {
            for i in 0..count {
                engine.advance(&mut state, u, h);
                exact = integrate(&contact, |v| model.friction.level_at(0.0, v), u, h, exact);
                let (x, v) = (state.position() - exact[0], state.velocity() - exact[1]);
                // With its force at the falling level at once it would be 5e-5 rad and 4e-3 rad/s off.
                assert!(x.abs() < 1e-5, "{u} {i}: {x}");
                assert!(v.abs() < 1e-3, "{u} {i}: {v}");
            }
        }
    }

    #[test]
    fn a_fast_body_feels_the_impulse_of_a_bristle_that_settles_at_once() {
        let (contact, free) = rubbing(2e-6);
        let (h, level, u, v) = (2e-4, 0.05, 0.1, 2.0);
        let mut motion = Motion {
            v,
            z: u,
            ..Motion::default()
        };
        // The bristle is bent the other way.
        let mut z = -2e-6;
        let pieces = contact.advance(&free, &mut motion, &mut z, 0.0, level, u, h);
        assert_eq!(pieces, 1);
        let exact = integrate(&contact, |_| level, u, h, [0.0, v, -2e-6]);
        let slipping = free.after(
            Motion {
                v,
                z: u,
                ..Motion::default()
            },
            u,
            -level,
            h,
        );
        let (felt, found) = (exact[1] - slipping.v, motion.v - slipping.v);
        assert!((found - felt).abs() < 1e-2 * felt.abs(), "{found} {felt}");
    }

    #[test]
    fn a_wild_state_ends_without_a_panic() {
        let (contact, free) = rubbing(2e-5);
        let wild = [f64::NAN, f64::INFINITY, -1e308, 1e200, 0.0];
        for v in wild {
            for u in wild {
                for start in wild {
                    let mut motion = Motion {
                        v,
                        z: u,
                        ..Motion::default()
                    };
                    let mut z = start;
                    contact.advance(&free, &mut motion, &mut z, u, 0.05, u, 2e-4);
                }
            }
        }
    }
}
