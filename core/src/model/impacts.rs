//! Body and load that come together and part between two samples.
//!
//! Each flies freely until the twist reaches the half gap; in contact both move on the joint, until that would pull.
//! Coming and going are located as events: with a damped contact the force jumps there, so that steps of any given
//! length would be off by a part of such a jump, and after some contacts the whole motion would.

use super::Load;
use super::flow::Flow;
use super::friction::{Mode, Rubbing, slide};
use super::joint::{Forces, Joined, Joint};
use super::state::State;
use crate::root::falsi;

/// Events in one interval after which the rest is left to small steps.
const MAX_EVENTS: usize = 24;

/// Radians of the contact's oscillation in one piece, over which its power series is exact, and parts of a piece at
/// which it is looked whether the contact has ended.
const PIECE_RADIANS: f64 = 0.5;
const PARTS: u32 = 4;

/// A model with a gap, and what acts on it over an interval.
pub(super) struct Impacts<'a> {
    pub body: &'a Flow,
    pub load_flow: &'a Flow,
    pub joint: &'a Joint,
    pub load: &'a Load,
    /// Input before the lag.
    pub input: f64,
    /// On the body, besides the input and dry friction.
    pub force: f64,
    /// Of dry friction of the body.
    pub level: f64,
    /// Whether that gives way where the body turns, so that it is no constant force from there on.
    pub bends_at_turns: bool,
    /// In one radian of the contact's oscillation.
    pub radian: f64,
}

impl Impacts<'_> {
    /// Moves `state` on for `h` seconds, but for what is returned: the rest after very many events, or after a turn
    /// from which friction bends. The number of pieces is added to `pieces`.
    pub fn advance(&self, state: &mut State, h: f64, pieces: &mut u32) -> f64 {
        let mut left = h;
        let mut touches = self.pushes(state);
        if touches {
            self.release(state);
        }
        for _ in 0..MAX_EVENTS {
            if !(left > 0.0 && state.motion.v.is_finite()) {
                return 0.0;
            }
            *pieces += 1;
            let (used, touching) = if touches {
                self.press(state, left)
            } else {
                let turn = self.turns_after(state, left);
                let (used, touching) = self.fly(state, left.min(turn));
                if !touching && used >= turn {
                    state.motion.v = 0.0;
                }
                (used, touching)
            };
            left -= used;
            if self.bends_at_turns && state.motion.v == 0.0 {
                return left.max(0.0);
            }
            if touching && !touches {
                self.release(state);
            }
            touches = touching;
        }
        left.max(0.0)
    }

    /// Has what is at rest stick or slip as the forces in contact want: they have changed at once.
    fn release(&self, state: &mut State) {
        let torque = self.unlimited(state, state.twist.signum());
        let body = Rubbing::new(state.mode, self.level);
        if body.level > 0.0 && (body.sticks || state.motion.v == 0.0) {
            state.mode = Mode::from_rest(state.motion.z + self.force - torque, body.level);
        }
        let load = Rubbing::new(state.load_mode, self.load.dry_friction);
        if load.level > 0.0 && (load.sticks || state.load.v == 0.0) {
            state.load_mode = Mode::from_rest(torque, load.level);
        }
    }

    /// Whether they push each other.
    fn pushes(&self, state: &State) -> bool {
        let rate = state.motion.v - state.load.v;
        self.load
            .coupling
            .joins(state.twist.signum(), state.twist, rate)
    }

    /// Free flight for at most `left` seconds, until they meet; the time used, and whether they did.
    fn fly(&self, state: &mut State, left: f64) -> (f64, bool) {
        let gap = self.load.coupling.half_gap;
        let start = *state;
        let end = self.flown(&start, left);
        // Where they turn back on the way they may have been farther apart than at its end.
        let (before, after) = (start.motion.v - start.load.v, end.motion.v - end.load.v);
        let turn = left * before / (before - after);
        let farthest = if before * after < 0.0 && turn < left {
            Some((turn, self.flown(&start, turn)))
        } else {
            None
        };
        for (time, there) in farthest.into_iter().chain([(left, end)]) {
            if !self.pushes(&there) {
                continue;
            }
            let side = there.twist.signum();
            let beyond = |s: &State| side * s.twist - gap;
            let from = beyond(&start);
            if from < 0.0 {
                let used = falsi(time, from, beyond(&there), |t| {
                    beyond(&self.flown(&start, t))
                });
                *state = self.flown(&start, used);
                state.twist = side * gap;
                return (used, true);
            }
            // They had parted while the contact was still pressed, and push each other again before it had sprung back.
            let force = |s: &State| side * self.unlimited(s, side);
            let used = falsi(time, force(&start).min(0.0), force(&there), |t| {
                force(&self.flown(&start, t))
            });
            *state = self.flown(&start, used);
            return (used, true);
        }
        *state = end;
        (left, false)
    }

    /// Time of free flight after which the body turns and friction bends, if it does within `left` seconds.
    fn turns_after(&self, state: &State, left: f64) -> f64 {
        let way = state.mode.sign();
        if !self.bends_at_turns || way == 0.0 {
            return f64::INFINITY;
        }
        let force = self.force - way * self.level;
        let end = self
            .body
            .after_cached(state.motion, self.input, force, left);
        if way * end.v > 0.0 {
            return f64::INFINITY;
        }
        self.body
            .stops(state.motion, self.input, force, left, end.v)
    }

    /// What the contact would do if it could pull.
    fn unlimited(&self, state: &State, side: f64) -> f64 {
        let joint = &self.load.coupling;
        let rate = state.motion.v - state.load.v;
        joint.unlimited(state.twist - side * joint.half_gap, rate)
    }

    /// State after free flight.
    fn flown(&self, state: &State, time: f64) -> State {
        let mut next = *state;
        let (w, force, level) = (self.input, self.force, self.level);
        slide(
            self.body,
            &mut next.motion,
            &mut next.mode,
            w,
            force,
            level,
            time,
        );
        let (load, rubs) = (&mut next.load, self.load.dry_friction);
        slide(
            self.load_flow,
            load,
            &mut next.load_mode,
            0.0,
            0.0,
            rubs,
            time,
        );
        next.twist += (next.motion.x - state.motion.x) - (next.load.x - state.load.x);
        next.time += time;
        next
    }

    /// Motion in contact for a piece of at most `left` seconds, or until an event; the time used, and whether the
    /// contact goes on.
    fn press(&self, state: &mut State, left: f64) -> (f64, bool) {
        let joint = &self.load.coupling;
        let side = state.twist.signum();
        let play = side * joint.half_gap;
        let body = Rubbing::new(state.mode, self.level);
        let load = Rubbing::new(state.load_mode, self.load.dry_friction);
        let forces = Forces {
            input: self.input,
            body: self.force - body.way * body.level,
            load: -load.way * load.level,
        };
        let stick = [body.sticks, load.sticks];
        let series = self.joint.series(&state.joined(play), &forces, stick);
        let torque = |at: &Joined| joint.unlimited(at.twist, at.body.v - at.load);
        // What acts on each besides its dry friction.
        let on_body = |at: &Joined| at.body.z + self.force - torque(at);
        let margins = |t: f64| {
            let at = series.at(t);
            [
                side * torque(&at),
                body.margin(at.body.v, on_body(&at)),
                load.margin(at.load, torque(&at)),
            ]
        };
        let piece = left.min(PIECE_RADIANS * self.radian);
        let mut event = None;
        let (mut before, mut last) = (0.0, margins(0.0));
        for part in 1..=PARTS {
            let time = piece * f64::from(part) / f64::from(PARTS);
            let now = margins(time);
            let ended = (0..now.len()).filter(|k| now[*k] <= 0.0 && last[*k] > 0.0);
            let times = ended.map(|k| {
                let within = falsi(time - before, last[k], now[k], |t| margins(before + t)[k]);
                (before + within, k)
            });
            event = times.min_by(|a, b| a.0.total_cmp(&b.0));
            if event.is_some() {
                break;
            }
            (before, last) = (time, now);
        }
        let (used, ended) = event.map_or((piece, None), |(time, k)| (time, Some(k)));
        let mut next = series.at(used);
        match ended {
            Some(1) => {
                next.body.v = 0.0;
                state.mode = body.after_event(on_body(&next));
            }
            Some(2) => {
                next.load = 0.0;
                state.load_mode = load.after_event(torque(&next));
            }
            _ => {}
        }
        state.join(&next, play, used);
        if self.level == 0.0 {
            state.mode = Mode::of(next.body.v);
        }
        if self.load.dry_friction == 0.0 {
            state.load_mode = Mode::of(next.load);
        }
        (used, ended != Some(0))
    }
}

#[cfg(test)]
mod tests {
    use crate::model::runge_kutta::integrate;
    use crate::model::{Coupling, Engine, Load, Model, State};

    const STEP: f64 = 2e-4;

    const STIFFNESS: f64 = 800.0;

    /// A motor and a load as heavy in a gap, with dry friction of both.
    fn model(dry: [f64; 2], stiffness: f64) -> Model {
        let mut model = Model::body(9e-4, 2e-3);
        model.friction.level = dry[0];
        model.load = Some(Load {
            inertia: 8e-4,
            viscous: 1e-3,
            dry_friction: dry[1],
            coupling: Coupling {
                half_gap: 0.004,
                stiffness,
                damping: 0.15 * (stiffness / STIFFNESS).sqrt(),
            },
        });
        model
    }

    /// `x, s, v, u, z` with `s` the twist and `z` the deflection of the bristle of the body, in many small steps.
    fn integrated(model: &Model, from: [f64; 5], input: f64) -> [f64; 5] {
        let load = model.load.expect("a load");
        let friction = &model.friction;
        let stiffness = friction.level / friction.presliding;
        let damping = 2.0 * friction.contact_damping * (stiffness * model.inertia).sqrt();
        let rates = |[_, s, v, u, z]: [f64; 5], _| {
            let force = load.coupling.force(s, v - u);
            let rubs = |v: f64, level: f64| if v == 0.0 { 0.0 } else { level * v.signum() };
            let (rate, rubbing) = if friction.presliding > 0.0 {
                let rate = v - v.abs() * z / friction.presliding;
                (rate, stiffness * z + damping * rate)
            } else {
                (0.0, rubs(v, friction.level))
            };
            let body = input - model.viscous * v - rubbing - force;
            let other = force - load.viscous * u - rubs(u, load.dry_friction);
            [v, v - u, body / model.inertia, other / load.inertia, rate]
        };
        integrate(rates, from, STEP, 32_000)
    }

    /// Largest deviation of position and velocity over some contacts.
    fn farthest_off(model: &Model) -> [f64; 2] {
        let mut engine = Engine::new(model);
        engine.prepare(STEP);
        let mut state = State::at_rest(0.0);
        let mut exact = [0.0; 5];
        let mut off = [0.0_f64; 2];
        for k in 0..300 {
            let time = STEP * f64::from(k);
            let input = 0.12 * libm::sin(150.0 * time) + 0.1 * libm::sin(397.0 * time);
            engine.advance(&mut state, input, STEP);
            exact = integrated(model, exact, input);
            off[0] = off[0].max((state.position() - exact[0]).abs());
            off[1] = off[1].max((state.velocity() - exact[2]).abs());
        }
        off
    }

    #[test]
    fn body_and_load_meet_and_part_as_integrated_in_small_steps() {
        let [x, v] = farthest_off(&model([0.0, 0.0], STIFFNESS));
        assert!(x < 1e-7 && v < 1e-4, "{x} {v}");
    }

    #[test]
    fn so_they_do_where_both_rub() {
        let [x, v] = farthest_off(&model([0.01, 0.005], STIFFNESS));
        assert!(x < 1e-7 && v < 1e-4, "{x} {v}");
    }

    #[test]
    fn so_they_do_where_the_friction_of_the_body_gives_way() {
        let mut model = model([0.05, 0.005], STIFFNESS);
        (model.friction.presliding, model.friction.contact_damping) = (2e-5, 0.1);
        let [x, v] = farthest_off(&model);
        assert!(x < 1e-6 && v < 2e-3, "{x} {v}");
    }

    #[test]
    fn a_contact_may_be_over_between_two_samples() {
        // It swings by four radians in one.
        let [x, v] = farthest_off(&model([0.0, 0.0], 200.0 * STIFFNESS));
        assert!(x < 1e-6 && v < 1e-3, "{x} {v}");
    }

    #[test]
    fn wild_states_and_contacts_end_without_a_panic() {
        let wild = [f64::NAN, f64::INFINITY, -1e308, 1e200, 0.0];
        for stiffness in [1e-300, STIFFNESS, 1e300] {
            for dry in [[0.0, 0.0], [0.01, 0.005]] {
                let model = model(dry, stiffness);
                let mut engine = Engine::new(&model);
                engine.prepare(STEP);
                for v in wild {
                    for twist in [0.0, 0.005, f64::NAN, 1e300] {
                        let mut state = State::touching(twist, v, 1.0);
                        engine.advance(&mut state, 0.1, STEP);
                        engine.advance(&mut state, v, STEP);
                    }
                }
            }
        }
    }
}
