//! The hybrid engine: exact flow between events, modes for sticking, slipping and contact.

use super::contact::{Contact, Deflection};
use super::flow::{Flow, Motion, root};
use super::{Model, Play};

/// Events in one held-input interval after which the modes are frozen until its end: a run never
/// hangs on infinitely many of them (bouncing, Zeno).
const MAX_EVENTS: usize = 64;

/// A bounce whose flight would last less than this share of the interval is a capture.
const CAPTURE_SHARE: f64 = 1e-3;

/// Sign of motion of a body, or sticking.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
enum Mode {
    /// At rest, held by dry friction.
    #[default]
    Stick,
    /// Moves towards positive positions.
    Forward,
    /// Moves towards negative positions.
    Backward,
}

impl Mode {
    fn of(v: f64) -> Self {
        if v > 0.0 {
            Self::Forward
        } else if v < 0.0 {
            Self::Backward
        } else {
            Self::Stick
        }
    }

    /// Mode of a body at rest under force `f` with friction `level`.
    fn from_rest(f: f64, level: f64) -> Self {
        if f.abs() <= level {
            Self::Stick
        } else {
            Self::of(f)
        }
    }

    fn sign(self) -> f64 {
        match self {
            Self::Stick => 0.0,
            Self::Forward => 1.0,
            Self::Backward => -1.0,
        }
    }
}

/// State of the whole model. Position and velocity are what a window estimates; the rest is
/// hidden and carried from window to window.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct State {
    motion: Motion,
    mode: Mode,
    /// Elastic deflections of the contact of dry friction.
    deflection: Deflection,
    /// x1 - x2, within the play.
    gap: f64,
    /// Load velocity.
    load_velocity: f64,
    /// Side of contact: +1 the motor pushes forward, -1 backward, 0 in the gap.
    side: f64,
}

impl State {
    /// At rest at the origin with the lagged input at `input`.
    pub fn at_rest(input: f64) -> Self {
        Self {
            motion: Motion {
                z: input,
                ..Motion::default()
            },
            ..Self::default()
        }
    }

    /// Position of the body.
    pub fn position(&self) -> f64 {
        self.motion.x
    }

    /// Velocity of the body.
    pub fn velocity(&self) -> f64 {
        self.motion.v
    }

    /// x1 - x2 of a drive with play.
    pub fn gap(&self) -> f64 {
        self.gap
    }

    /// Velocity of the load behind the play.
    pub fn load_velocity(&self) -> f64 {
        if self.side == 0.0 {
            self.load_velocity
        } else {
            self.motion.v
        }
    }

    /// The same hidden state with the body moved to `position` and `velocity`.
    #[must_use]
    pub fn restarted(&self, position: f64, velocity: f64) -> Self {
        let mut next = *self;
        next.motion.x = position;
        next.motion.v = velocity;
        next.mode = Mode::of(velocity);
        next
    }
}

/// Moves a [`State`] through intervals of held input.
#[derive(Clone, Debug)]
pub struct Engine {
    free: Flow,
    joint: Flow,
    force: f64,
    friction: f64,
    play: Option<Play>,
    inertia: f64,
    /// Elastic contact of dry friction.
    contact: Option<Contact>,
}

impl Engine {
    /// Prepares the flows of `model`.
    pub fn new(model: &Model) -> Self {
        let (load_inertia, load_viscous) =
            model.play.map_or((0.0, 0.0), |p| (p.inertia, p.viscous));
        Self {
            free: Flow::new(model.inertia, model.viscous, model.lag),
            joint: Flow::new(
                model.inertia + load_inertia,
                model.viscous + load_viscous,
                model.lag,
            ),
            force: model.constant_force,
            friction: model.dry_friction,
            play: model.play,
            inertia: model.inertia,
            contact: Contact::new(model),
        }
    }

    /// Computes the flows over a duration that will recur, such as the sampling time.
    pub fn prepare(&mut self, h: f64) {
        self.free.prepare(h);
        if self.play.is_some() {
            self.joint.prepare(h);
        }
    }

    /// Moves `state` through `h` seconds under the held input `w` (after maps and dead time).
    pub fn advance(&self, state: &mut State, w: f64, h: f64) {
        if !self.free.lagged() {
            state.motion.z = w;
        }
        match self.play {
            None if self.friction == 0.0 => {
                state.motion = self.free.after_cached(state.motion, w, self.force, h);
            }
            None => match &self.contact {
                Some(contact) if contact.is_soft(h) => {
                    contact.advance(&self.free, &mut state.motion, &mut state.deflection, w, h);
                    state.mode = Mode::of(state.motion.v);
                }
                _ => self.advance_with_friction(state, w, h),
            },
            Some(play) => self.advance_with_play(state, play, w, h),
        }
    }

    fn advance_with_friction(&self, state: &mut State, w: f64, h: f64) {
        let mut left = h;
        for _ in 0..MAX_EVENTS {
            let (used, event) = body_event(
                &self.free,
                state.motion,
                state.mode,
                w,
                self.force,
                self.friction,
                left,
            );
            state.motion = used.motion;
            left -= used.time;
            match event {
                None => return,
                Some(mode) => state.mode = mode,
            }
            if left <= 0.0 {
                return;
            }
        }
        // Endless switching within one sample is sticking to all intents.
        state.mode = Mode::Stick;
        state.motion.v = 0.0;
    }

    fn advance_with_play(&self, state: &mut State, play: Play, w: f64, h: f64) {
        let mut left = h;
        for _ in 0..MAX_EVENTS {
            left -= if state.side == 0.0 {
                self.cross_gap(state, play, w, left, h)
            } else {
                self.push_load(state, play, w, left)
            };
            if left <= 0.0 {
                return;
            }
        }
        state.motion.x += state.motion.v * left;
    }

    /// Motion in contact until `left` is over or an event; returns the time used.
    fn push_load(&self, state: &mut State, play: Play, w: f64, left: f64) -> f64 {
        let side = state.side;
        let level = self.friction + play.dry_friction;
        let applied = state.motion.z + self.force;
        let release = |state: &mut State, mode: Mode| {
            state.load_velocity = state.motion.v;
            state.side = 0.0;
            state.mode = mode;
        };
        let stick = level > 0.0 && state.mode == Mode::Stick;
        if stick && applied * side < -self.friction {
            // The motor leaves backwards; the load stays where it is.
            release(state, Mode::of(-side));
            return 0.0;
        }
        let contact = |flow: &Flow, m: Motion, q: f64, sign: f64| {
            side * (play.inertia * flow.acceleration(m, q)
                + play.viscous * m.v
                + play.dry_friction * sign)
        };
        let sign = state.mode.sign();
        let q = self.force - sign * level;
        if !stick && contact(&self.joint, state.motion, q, sign) < 0.0 {
            release(state, state.mode);
            return 0.0;
        }
        let start = state.motion;
        let (used, event) = body_event(&self.joint, start, state.mode, w, self.force, level, left);
        if !stick {
            let end = contact(
                &self.joint,
                Motion {
                    v: used.motion.v,
                    ..used.motion
                },
                q,
                sign,
            );
            if end < 0.0 {
                let joint = &self.joint;
                let force_at = |t: f64| contact(joint, joint.after(start, w, q, t), q, sign);
                let t = root(used.time, force_at(0.0), end, force_at);
                state.motion = self.joint.after(start, w, q, t);
                release(state, state.mode);
                return t;
            }
        } else if used.motion.z + self.force < 0.0 && side > 0.0
            || used.motion.z + self.force > 0.0 && side < 0.0
        {
            let target = -side * self.friction - self.force;
            if (used.motion.z - target) * side < 0.0
                && let Some(t) = self.joint.lag_reaches(start.z, w, target)
                && t < used.time
            {
                state.motion.z = target;
                release(state, Mode::of(-side));
                return t;
            }
        }
        state.motion = used.motion;
        if let Some(mode) = event {
            state.mode = mode;
        }
        used.time
    }

    /// Motion in the gap until `left` is over or an event; returns the time used.
    fn cross_gap(&self, state: &mut State, play: Play, w: f64, left: f64, h: f64) -> f64 {
        if let Some(()) = self.touch(state, play, h) {
            return 0.0;
        }
        let start = *state;
        let (used, event) = body_event(
            &self.free,
            start.motion,
            start.mode,
            w,
            self.force,
            self.friction,
            left,
        );
        let q = self.force - start.mode.sign() * self.friction;
        let stuck = start.mode == Mode::Stick && self.friction > 0.0;
        let free = &self.free;
        let at = |t: f64| -> (f64, f64, Motion, f64) {
            let motion = if stuck {
                Motion {
                    z: free.after(start.motion, w, q, t).z,
                    ..start.motion
                }
            } else {
                free.after(start.motion, w, q, t)
            };
            let (moved, v2) = coast(play, start.load_velocity, t);
            (
                start.gap + motion.x - start.motion.x - moved,
                motion.v - v2,
                motion,
                v2,
            )
        };
        let (gap, relative, motion, v2) = at(used.time);
        let relative0 = start.motion.v - start.load_velocity;
        let beta = play.half_gap;
        // The gap may close at the end, or in between if the bodies turn towards each other again.
        let mut hit = (gap.abs() > beta).then_some((used.time, gap.signum()));
        if hit.is_none() && relative0 * relative < 0.0 {
            let turn = root(used.time, relative0, relative, |t| at(t).1);
            let bulge = at(turn).0;
            hit = (bulge.abs() > beta).then_some((turn, bulge.signum()));
        }
        if let Some((until, side)) = hit {
            let outside = |t: f64| side * at(t).0 - beta;
            let before = outside(0.0);
            let t = if before >= 0.0 {
                0.0
            } else {
                root(until, before, outside(until), outside)
            };
            let (_, _, motion, v2) = at(t);
            state.motion = motion;
            state.load_velocity = v2;
            state.gap = side * beta;
            self.impact(state, play, side, h);
            return t;
        }
        state.motion = Motion {
            v: used.motion.v,
            x: motion.x,
            z: motion.z,
        };
        state.gap = gap;
        state.load_velocity = v2;
        if let Some(mode) = event {
            state.mode = mode;
        }
        used.time
    }

    /// Contact at the edge of the gap without a flight before it.
    fn touch(&self, state: &mut State, play: Play, h: f64) -> Option<()> {
        let side = state.gap.signum();
        if state.gap.abs() < play.half_gap {
            return None;
        }
        state.gap = side * play.half_gap;
        let relative = (state.motion.v - state.load_velocity) * side;
        if relative < 0.0 || (relative == 0.0 && self.pressing(state, play, side) <= 0.0) {
            return None;
        }
        self.impact(state, play, side, h);
        Some(())
    }

    /// Acceleration of the motor towards the load on `side`, both free.
    fn pressing(&self, state: &State, play: Play, side: f64) -> f64 {
        let slip = |v: f64, f: f64, level: f64| {
            let mode = if v == 0.0 {
                Mode::from_rest(f, level)
            } else {
                Mode::of(v)
            };
            (mode, mode.sign() * level)
        };
        let applied = state.motion.z + self.force;
        let (mode, friction) = slip(state.motion.v, applied, self.friction);
        let motor = if mode == Mode::Stick && self.friction > 0.0 {
            0.0
        } else {
            self.free.acceleration(state.motion, self.force - friction)
        };
        let (_, load_friction) = slip(state.load_velocity, 0.0, play.dry_friction);
        let load = -(play.viscous * state.load_velocity + load_friction) / play.inertia;
        side * (motor - load)
    }

    /// Momentum-conserving impact on `side`; `h` is the length of the interval.
    fn impact(&self, state: &mut State, play: Play, side: f64, h: f64) {
        let (j1, j2) = (self.inertia, play.inertia);
        let (v1, v2) = (state.motion.v, state.load_velocity);
        let common = (j1 * v1 + j2 * v2) / (j1 + j2);
        let rebound = play.restitution * (v1 - v2);
        state.motion.v = common - j2 * rebound / (j1 + j2);
        state.load_velocity = common + j1 * rebound / (j1 + j2);
        let pressing = self.pressing(state, play, side);
        if 2.0 * rebound.abs() <= CAPTURE_SHARE * h * pressing.max(0.0) || rebound == 0.0 {
            state.motion.v = common;
            state.side = side;
            let applied = state.motion.z + self.force;
            let level = self.friction + play.dry_friction;
            state.mode = if common == 0.0 {
                Mode::from_rest(applied, level)
            } else {
                Mode::of(common)
            };
        } else {
            let applied = state.motion.z + self.force;
            let v = state.motion.v;
            state.mode = if v == 0.0 {
                Mode::from_rest(applied, self.friction)
            } else {
                Mode::of(v)
            };
        }
    }
}

/// How far a body came, and when.
struct Used {
    motion: Motion,
    time: f64,
}

/// Moves one body with dry friction for `left` seconds, or to its next change of mode.
fn body_event(
    flow: &Flow,
    start: Motion,
    mode: Mode,
    w: f64,
    force: f64,
    level: f64,
    left: f64,
) -> (Used, Option<Mode>) {
    if level == 0.0 {
        return (
            Used {
                motion: flow.after_cached(start, w, force, left),
                time: left,
            },
            None,
        );
    }
    if mode == Mode::Stick {
        return stuck_event(flow, start, w, force, level, left);
    }
    let sign = mode.sign();
    let q = force - sign * level;
    let end = flow.after_cached(start, w, q, left);
    let velocity_at = |flow: &Flow, t: f64| flow.after(start, w, q, t).v;
    let crossing = if end.v * sign < 0.0 {
        Some((left, end.v))
    } else if flow.lagged()
        && flow.acceleration(start, q) * sign < 0.0
        && flow.acceleration(end, q) * sign > 0.0
    {
        // Behind a lag the velocity may dip below zero in between.
        let slope = |t: f64| flow.acceleration(flow.after(start, w, q, t), q);
        let turn = root(left, slope(0.0), slope(left), slope);
        let lowest = velocity_at(flow, turn);
        (lowest * sign < 0.0).then_some((turn, lowest))
    } else {
        None
    };
    let Some((until, v_until)) = crossing else {
        return (
            Used {
                motion: end,
                time: left,
            },
            None,
        );
    };
    let time = if start.v * sign <= 0.0 {
        0.0
    } else {
        root(until, start.v, v_until, |t| velocity_at(flow, t))
    };
    let mut motion = flow.after(start, w, q, time);
    motion.v = 0.0;
    (
        Used { motion, time },
        Some(Mode::from_rest(motion.z + force, level)),
    )
}

/// Waits at rest for `left` seconds, or until the applied force overcomes friction.
fn stuck_event(
    flow: &Flow,
    start: Motion,
    w: f64,
    force: f64,
    level: f64,
    left: f64,
) -> (Used, Option<Mode>) {
    let rest = |z: f64, time: f64| Used {
        motion: Motion { v: 0.0, z, ..start },
        time,
    };
    let now = Mode::from_rest(start.z + force, level);
    if now != Mode::Stick {
        return (rest(start.z, 0.0), Some(now));
    }
    let z_end = flow.after(start, w, 0.0, left).z;
    let later = Mode::from_rest(z_end + force, level);
    if later == Mode::Stick {
        return (rest(z_end, left), None);
    }
    let target = later.sign() * level - force;
    let time = flow
        .lag_reaches(start.z, w, target)
        .map_or(0.0, |t| t.min(left));
    (rest(target, time), Some(later))
}

/// Distance and velocity of a load that coasts for `t` seconds from velocity `v`.
fn coast(play: Play, v: f64, t: f64) -> (f64, f64) {
    let lambda = play.viscous / play.inertia;
    let brake = play.dry_friction / play.inertia * Mode::of(v).sign();
    let free = |t: f64| {
        let phi1 = if lambda * t == 0.0 {
            t
        } else {
            -(-lambda * t).exp_m1() / lambda
        };
        let phi2 = if lambda * t < 1e-5 {
            t * t * (0.5 - lambda * t / 6.0)
        } else {
            (t - phi1) / lambda
        };
        (
            v * phi1 - brake * phi2,
            v * (-lambda * t).exp() - brake * phi1,
        )
    };
    if brake == 0.0 {
        return free(t);
    }
    let ratio = v / brake;
    let stop = if lambda * ratio < 1e-12 {
        ratio
    } else {
        (lambda * ratio).ln_1p() / lambda
    };
    if t < stop {
        free(t)
    } else {
        (free(stop).0, 0.0)
    }
}
