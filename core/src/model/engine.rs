//! The hybrid engine: exact flow between events, modes for sticking, slipping and contact.

mod turns;

use std::cell::Cell;

use super::contact::Contact;
use super::flow::{Flow, Motion, Spring};
use super::friction::{Mode, Rubbing, slide};
use super::impacts::Impacts;
use super::joint::{Forces, Joint};
use super::load::STEP_RADIANS;
use super::state::State;
use super::{Instant, Model};

/// Halvings of an interval at most.
const MAX_HALVINGS: u32 = 6;

/// Change of a smooth force over half a step, as a share of what would change the velocity by its
/// own size, above which the step is halved.
const SMOOTH_SHARE: f64 = 0.05;

/// Change of velocity over a step, as a share of the Stribeck speed, above which the step is halved while the friction
/// level depends on it; and speed, in times of that, above which it no longer does.
const LEVEL_SHARE: f64 = 0.12;
const LEVELLED: f64 = 3.0;

/// The same where it is level to round-off: `exp(-6.2^2)` is below that.
const FLAT: f64 = 6.2;

/// Halvings for it at most: where a trial lets the level change within a sample, more would only take long.
const LEVEL_HALVINGS: u32 = 2;

/// Steps of a contact in an interval up to which its ends tell whether the contact lasts.
const SEEN_STEPS: f64 = 5.0;

/// Forces that are held over a step, besides the input.
#[derive(Clone, Copy, Debug)]
struct Held {
    /// On the body.
    body: f64,
    /// On the load.
    load: f64,
    /// Level of dry friction at the body.
    level: f64,
}

/// Moves a [`State`] through intervals of held input.
#[derive(Debug)]
pub struct Engine<'m> {
    model: &'m Model,
    body: Flow,
    /// The body of a process that swings.
    swinging: Option<Spring>,
    load: Option<Flow>,
    contact: Option<Contact>,
    /// Body and load as one, where no force depends on where and how fast they are.
    joint: Option<Joint>,
    /// Longest step while body and load touch, s.
    touching_step: f64,
    /// Nothing but the input, constant forces and dry friction of a fixed level acts.
    plain: bool,
    /// Pieces of motion so far.
    moves: Cell<u64>,
}

impl<'m> Engine<'m> {
    /// Prepares the flows of `model`.
    pub fn new(model: &'m Model) -> Self {
        let smooth = model.forces.is_empty()
            && model.own_forces.is_empty()
            && model.gear_friction == 0.0
            && model.friction.static_excess == 0.0
            && model.friction.rise == 0.0;
        Self {
            body: Flow::new(model.inertia, model.viscous, model.lag).with_direct(model.direct),
            swinging: model.spring.map(|stiffness| {
                let mu = model.lag.map(|tau| 1.0 / tau);
                Spring::new(1.0 / model.inertia, stiffness, model.viscous, mu)
                    .with_direct(model.direct)
            }),
            load: model
                .load
                .map(|load| Flow::new(load.inertia, load.viscous, None)),
            contact: Contact::new(model),
            joint: if smooth { Joint::new(model) } else { None },
            touching_step: model
                .load
                .map_or(f64::INFINITY, |load| load.longest_step(model.inertia)),
            plain: smooth
                && model.spring.is_none()
                && model.load.is_none()
                && model.late_load().1 == 0.0
                && model.slow_fall == 0.0,
            moves: Cell::new(0),
            model,
        }
    }

    /// Pieces of motion so far: the work that was done.
    pub(super) fn moves(&self) -> u64 {
        self.moves.get()
    }

    fn count(&self, moves: u32) {
        self.moves.set(self.moves.get() + u64::from(moves));
    }

    /// The elastic contact of dry friction, if there is one.
    pub(super) fn contact(&self) -> Option<&Contact> {
        self.contact.as_ref()
    }

    /// Computes the flows over a duration that will recur, such as the sampling time.
    pub fn prepare(&mut self, h: f64) {
        self.body.prepare(h);
        if self.plain {
            return;
        }
        if let Some(joint) = &mut self.joint {
            joint.prepare(h);
        }
        let halvings = self.touching_halvings(h);
        for part in 0..=halvings + 1 {
            let step = h / f64::from(1_u32 << part);
            self.body.prepare(step);
            if let Some(load) = &mut self.load {
                load.prepare(step);
            }
        }
    }

    /// Halvings of an interval of `h` seconds in which body and load touch.
    fn touching_halvings(&self, h: f64) -> u32 {
        (0..MAX_HALVINGS)
            .find(|k| h / f64::from(1_u32 << k) <= self.touching_step)
            .unwrap_or(MAX_HALVINGS)
    }

    /// Moves `state` through `h` seconds under the held input `w` (after maps and dead time).
    pub fn advance(&self, state: &mut State, w: f64, h: f64) {
        if !self.body.lagged() {
            state.motion.z = w;
        }
        if self.plain {
            let held = Held {
                body: self.model.late_load().0,
                load: 0.0,
                level: self.model.friction.level,
            };
            self.advance_body(state, held, w, h);
            return;
        }
        if self.swing(state, w, h) {
            return;
        }
        let touching = self
            .model
            .load
            .is_some_and(|load| load.may_touch(state.twist, state.motion.v - state.load.v, h));
        if !touching && self.joint.is_some() || self.is_levelled(state, h) {
            // No force changes with the motion on the way.
            let mut middle = *state;
            middle.time += 0.5 * h;
            let held = self.held(&middle);
            return self.move_held(state, held, w, h);
        }
        let h = if touching { self.meet(state, w, h) } else { h };
        if h <= 0.0 {
            return;
        }
        let mut halvings = if touching {
            self.touching_halvings(h)
        } else {
            0
        };
        halvings = halvings
            .max(self.smooth_halvings(state, h))
            .max(self.level_halvings(state, h));
        let step = h / f64::from(1_u32 << halvings);
        for _ in 0..1_u32 << halvings {
            if self.may_jump() {
                self.turning_step(state, w, step);
            } else {
                self.midpoint_step(state, w, step);
            }
        }
    }

    /// The elastic contact of dry friction, where it shows in `h` seconds.
    fn bristle(&self, h: f64) -> Option<&Contact> {
        let rubs = self.model.friction.level > 0.0;
        self.contact.as_ref().filter(|c| rubs && c.is_soft(h))
    }

    /// Whether it is bending: until it slips, the friction is no constant force.
    fn bends(&self, state: &State, h: f64) -> bool {
        let level = self.model.friction.level;
        let bending = |c: &Contact| !c.slips(state.deflection, state.motion.v, level);
        self.bristle(h).is_some_and(bending)
    }

    /// Load on the body besides friction, in the middle of the next `h` seconds.
    fn late_load(&self, state: &State, h: f64) -> f64 {
        let (constant, rise) = self.model.late_load();
        constant + rise * (state.time + 0.5 * h)
    }

    /// Moves body and load in one exact step; false where that is not possible: one of them turns or sticks, or they
    /// come together or apart.
    fn swing(&self, state: &mut State, w: f64, h: f64) -> bool {
        let (Some(joint), Some(load)) = (&self.joint, &self.model.load) else {
            return false;
        };
        if self.bends(state, h) {
            return false;
        }
        let body = Rubbing::new(state.mode, self.model.friction.level);
        let other = Rubbing::new(state.load_mode, load.dry_friction);
        if body.sticks || other.sticks {
            return false;
        }
        let half_gap = load.coupling.half_gap;
        if half_gap > 0.0 && h > SEEN_STEPS * self.touching_step {
            // They might come apart and together again unseen.
            return false;
        }
        let side = state.twist.signum();
        let joins = |twist, rate| load.coupling.joins(side, twist, rate);
        if !joins(state.twist, state.motion.v - state.load.v) {
            return false;
        }
        let forces = Forces {
            input: w,
            body: self.late_load(state, h) - body.way * body.level,
            load: -other.way * other.level,
        };
        let play = side * half_gap;
        let Some(next) = joint.after(&state.joined(play), &forces, h) else {
            return false;
        };
        let turns = |way: f64, v: f64| way != 0.0 && way * v <= 0.0;
        if turns(body.way, next.body.v)
            || turns(other.way, next.load)
            || !joins(next.twist + play, next.body.v - next.load)
        {
            return false;
        }
        state.join(&next, play, h);
        (state.mode, state.load_mode) = (Mode::of(next.body.v), Mode::of(next.load));
        self.count(1);
        true
    }

    /// Moves body and load, which may come together or part, for `h` seconds but for what is returned and left to small
    /// steps.
    fn meet(&self, state: &mut State, w: f64, h: f64) -> f64 {
        let (Some(joint), Some(flow), Some(load)) = (&self.joint, &self.load, &self.model.load)
        else {
            return h;
        };
        if load.coupling.half_gap == 0.0 || self.bends(state, h) {
            return h;
        }
        let impacts = Impacts {
            body: &self.body,
            load_flow: flow,
            joint,
            load,
            input: w,
            force: self.late_load(state, h),
            level: self.model.friction.level,
            bends_at_turns: self.bristle(h).is_some(),
            radian: self.touching_step / STEP_RADIANS,
        };
        let mut pieces = 0;
        let left = impacts.advance(state, h, &mut pieces);
        self.count(pieces);
        left
    }

    /// One step of the exponential midpoint rule.
    fn midpoint_step(&self, state: &mut State, w: f64, h: f64) {
        let mut middle = *state;
        self.move_held(&mut middle, self.held(state), w, 0.5 * h);
        self.move_held(state, self.held(&middle), w, h);
    }

    /// Halvings that the smooth forces ask for: their change over half a step must be small.
    fn smooth_halvings(&self, state: &State, h: f64) -> u32 {
        if self.model.forces.is_empty() && self.model.own_forces.is_empty() {
            return 0;
        }
        let force = |x: f64, v: f64| self.smooth_force(state, x, v);
        let Motion { x, v, .. } = state.motion;
        let before = force(x, v);
        (0..MAX_HALVINGS)
            .find(|k| {
                let step = h / f64::from(1_u32 << k);
                let change = (force(x + 0.5 * step * v, v) - before).abs();
                change * step <= SMOOTH_SHARE * (self.model.inertia * v).abs()
            })
            .unwrap_or(MAX_HALVINGS)
    }

    /// Halvings that a friction level asks for which falls with the speed.
    fn level_halvings(&self, state: &State, h: f64) -> u32 {
        let friction = &self.model.friction;
        let (v, gained) = (state.motion.v.abs(), self.gained(state, h));
        if friction.static_excess == 0.0 || v > LEVELLED * friction.stribeck_speed + gained {
            return 0;
        }
        let most = LEVEL_SHARE * friction.stribeck_speed;
        (0..LEVEL_HALVINGS)
            .find(|k| gained / f64::from(1_u32 << k) <= most)
            .unwrap_or(LEVEL_HALVINGS)
    }

    /// Whether nothing but a friction level changes with the motion, and the body is and stays too fast for that.
    fn is_levelled(&self, state: &State, h: f64) -> bool {
        let model = self.model;
        let smooth = model.load.is_none() && model.is_same_everywhere() && model.slow_fall == 0.0;
        let slowest = state.motion.v.abs() - self.gained(state, h);
        smooth && slowest > FLAT * model.friction.stribeck_speed
    }

    /// Change of velocity in `h` seconds at most.
    fn gained(&self, state: &State, h: f64) -> f64 {
        let force = state.motion.z.abs() + self.model.friction.breakaway();
        h * force / self.model.inertia.abs()
    }

    /// Sum of the smooth forces in a state moved to `x` and `v`.
    fn smooth_force(&self, state: &State, x: f64, v: f64) -> f64 {
        let [x, v] = self.model.seen([x, v]);
        let force: f64 = self.model.forces.iter().map(|f| f(x, v)).sum();
        if self.model.own_forces.is_empty() {
            return force;
        }
        let at = instant(state, x, v);
        force + self.model.own_forces.iter().map(|f| f(&at)).sum::<f64>()
    }

    /// Forces in a state.
    fn held(&self, state: &State) -> Held {
        let Motion { x, v, .. } = state.motion;
        let model = self.model;
        let between = model.load.map_or(0.0, |load| {
            load.coupling.force(state.twist, v - state.load.v)
        });
        let own = self.smooth_force(state, x, v);
        let (constant, rise) = model.late_load();
        let body = constant + rise * state.time + own - between;
        Held {
            body: body + self.slower(state, body),
            load: between,
            level: model.friction.level_at(x, v) + model.level_of_gear(&instant(state, x, v)),
        }
    }

    /// What makes a process slower one way than the other: with the inertia `J (1 + a)` when it falls and `J (1 - a)`
    /// when it rises, `held` acts like a force more on `J`.
    fn slower(&self, state: &State, held: f64) -> f64 {
        let asymmetry = self.model.slow_fall;
        if asymmetry == 0.0 || self.swinging.is_some() {
            return 0.0;
        }
        let Motion { v, z, .. } = state.motion;
        let net = z + held - self.model.viscous * v;
        let share = if net * self.model.inertia < 0.0 {
            1.0 + asymmetry
        } else {
            1.0 - asymmetry
        };
        net * (1.0 / share - 1.0)
    }

    /// Moves body and load under held forces.
    fn move_held(&self, state: &mut State, held: Held, w: f64, h: f64) {
        let x = state.motion.x;
        self.advance_body(state, held, w, h);
        state.time += h;
        if let (Some(flow), Some(load)) = (&self.load, &self.model.load) {
            let x2 = state.load.x;
            slide(
                flow,
                &mut state.load,
                &mut state.load_mode,
                0.0,
                held.load,
                load.dry_friction,
                h,
            );
            state.twist += (state.motion.x - x) - (state.load.x - x2);
        }
    }

    fn advance_body(&self, state: &mut State, held: Held, w: f64, h: f64) {
        if let Some(spring) = &self.swinging {
            self.count(1);
            state.motion = spring.after(state.motion, w, held.body, h);
            return;
        }
        match &self.contact {
            // Also where a wild state has made the level no number.
            _ if held.level.is_nan() || held.level <= 0.0 => {
                self.count(1);
                state.motion = self.body.after_cached(state.motion, w, held.body, h);
            }
            Some(contact) if contact.is_soft(h) => {
                let (motion, deflection) = (&mut state.motion, &mut state.deflection);
                let pieces =
                    contact.advance(&self.body, motion, deflection, held.body, held.level, w, h);
                self.count(pieces);
                state.mode = Mode::of(state.motion.v);
            }
            _ => {
                let (motion, mode) = (&mut state.motion, &mut state.mode);
                slide(&self.body, motion, mode, w, held.body, held.level, h);
                self.count(1);
            }
        }
    }
}

/// What acts in a state moved to `x` and `v`, as a force sees it.
fn instant(state: &State, x: f64, v: f64) -> Instant {
    Instant {
        position: x,
        velocity: v,
        input: state.motion.z,
        time: state.time,
    }
}
