//! A user's own force that jumps where the body turns, such as `-c*sign(v)`.
//!
//! A step over the turn would push the wrong way for a part of it, and the motion would depend on the values by leaps.
//! So the body is moved to the turn, and goes on from there; where the force holds it from both sides, it stays (A. F.
//! Filippov, Differential Equations with Discontinuous Righthand Sides, 1988).

use super::Engine;
use crate::model::state::State;
use crate::root::falsi;

/// Turns in one step after which the rest of it is one piece.
const MAX_TURNS: usize = 4;

/// Share of the forces that act from which a difference between both sides of rest is a jump.
const JUMP: f64 = 1e-6;

impl Engine<'_> {
    /// Whether a turn matters: a user's own force acts, and no friction of the library holds the body.
    pub(super) fn may_jump(&self) -> bool {
        let model = self.model;
        let rubs = model.friction.level > 0.0 || model.gear_friction > 0.0;
        !model.own_forces.is_empty() && model.load.is_none() && !rubs
    }

    /// A step of `h` seconds, stopped and begun anew where the body turns and a force jumps.
    pub(super) fn turning_step(&self, state: &mut State, w: f64, h: f64) {
        let mut left = h;
        for _ in 0..MAX_TURNS {
            if state.motion.v == 0.0 && self.holds(state) {
                state.wait(self.model, w, left);
                self.count(1);
                return;
            }
            let from = *state;
            self.one_way_step(state, w, left);
            if from.motion.v * state.motion.v >= 0.0 || !self.jumps(&from) {
                return;
            }
            let time = self.turn(&from, w, left, state.motion.v);
            *state = from;
            self.one_way_step(state, w, time);
            state.motion.v = 0.0;
            left -= time;
        }
        self.midpoint_step(state, w, left);
    }

    /// A step of the exponential midpoint rule with the forces of the side of rest on which it begins.
    fn one_way_step(&self, state: &mut State, w: f64, h: f64) {
        let mut middle = *state;
        self.move_held(&mut middle, self.held(state), w, 0.5 * h);
        if middle.motion.v * state.motion.v < 0.0 {
            middle.motion.v = f64::MIN_POSITIVE.copysign(state.motion.v);
        }
        self.move_held(state, self.held(&middle), w, h);
    }

    /// Time within `h` seconds after which the body turns; it has the velocity `end` after all of them.
    fn turn(&self, from: &State, w: f64, h: f64, end: f64) -> f64 {
        falsi(h, from.motion.v, end, |time| {
            let mut state = *from;
            self.one_way_step(&mut state, w, time);
            state.motion.v
        })
    }

    /// The net force just below and just above rest.
    fn around_rest(&self, state: &State) -> [f64; 2] {
        let (constant, rise) = self.model.late_load();
        let others = state.motion.z + constant + rise * state.time;
        let tiny = f64::MIN_POSITIVE;
        [-tiny, tiny].map(|v| others + self.smooth_force(state, state.motion.x, v))
    }

    fn jumps(&self, state: &State) -> bool {
        let [below, above] = self.around_rest(state);
        (above - below).abs() > JUMP * above.abs().max(below.abs())
    }

    /// Whether the body stays at rest: it is pushed back from both sides.
    fn holds(&self, state: &State) -> bool {
        let [below, above] = self.around_rest(state);
        below > above && below >= 0.0 && above <= 0.0
    }
}

#[cfg(test)]
mod tests {
    use crate::model::engine::Engine;
    use crate::model::state::State;
    use crate::model::{Instant, Model};

    const INERTIA: f64 = 9e-4;
    const LEVEL: f64 = 0.04;

    /// A body with the force `-c sign(v)` of a formula.
    fn rubbing() -> Model {
        let mut model = Model::body(INERTIA, 0.0);
        let force = |at: &Instant| {
            if at.velocity == 0.0 {
                0.0
            } else {
                -LEVEL * at.velocity.signum()
            }
        };
        model.own_forces.push(Box::new(force));
        model
    }

    fn moved(velocity: f64, input: f64, h: f64) -> State {
        let model = rubbing();
        let engine = Engine::new(&model);
        let mut state = State::at_rest(input).restarted(0.0, velocity);
        engine.advance(&mut state, input, h);
        state
    }

    #[test]
    fn a_body_turns_exactly_under_a_force_that_jumps() {
        let (v, input, h) = (0.05, -0.3, 4e-4);
        let turn = v * INERTIA / (LEVEL - input);
        let exact = (input + LEVEL) / INERTIA * (h - turn);
        assert!(turn < h);
        let end = moved(v, input, h).velocity();
        assert!((end - exact).abs() < 1e-10 * exact.abs(), "{end} {exact}");
    }

    #[test]
    fn a_formula_of_dry_friction_moves_a_body_as_dry_friction_does() {
        let formula = rubbing();
        let mut dry = Model::body(INERTIA, 0.0);
        dry.friction.level = LEVEL;
        let (formula, dry) = (Engine::new(&formula), Engine::new(&dry));
        let [mut a, mut b] = [State::at_rest(0.0).restarted(0.0, 0.01); 2];
        for i in 0..200 {
            let input = 0.3 * libm::sin(0.7 * f64::from(i)) * libm::sin(0.03 * f64::from(i));
            formula.advance(&mut a, input, 2e-4);
            dry.advance(&mut b, input, 2e-4);
            let off = (a.velocity() - b.velocity()).abs();
            assert!(off < 1e-9, "{i}: {} {}", a.velocity(), b.velocity());
        }
    }

    #[test]
    fn a_force_that_jumps_holds_a_body_that_is_pushed_by_less() {
        assert_eq!(moved(0.01, -0.03, 4e-3).velocity(), 0.0);
        assert_eq!(moved(0.0, 0.03, 4e-3).velocity(), 0.0);
        assert!(moved(0.0, 0.05, 4e-3).velocity() > 0.04);
    }
}
