//! Friction of a gear: a share of what its teeth carry.
//!
//! They carry what the motor pushes and what pushes against it: an arm that is lifted presses them twice, by the motor
//! and by its weight (M. Duclusaud and others, Extended friction models for the physics simulation of servo actuators,
//! 2024). In a drive on which nothing else acts that is a share of the input.

use super::{Instant, Model};

impl Model {
    /// Level of the friction of the gear. What pushes against the motor is what would act at rest: gravity, springs and
    /// loads, but no drag.
    pub(super) fn level_of_gear(&self, now: &Instant) -> f64 {
        if self.gear_friction == 0.0 {
            return 0.0;
        }
        let at_rest = Instant {
            velocity: 0.0,
            ..*now
        };
        let forces: f64 = self.forces.iter().map(|f| f(now.position, 0.0)).sum();
        let own: f64 = self.own_forces.iter().map(|f| f(&at_rest)).sum();
        let (constant, rise) = self.late_load();
        let load = forces + own + constant + rise * now.time;
        self.gear_friction * (now.input - load).abs()
    }
}

#[cfg(test)]
mod tests {
    use crate::model::{Engine, Model, State};

    const INERTIA: f64 = 0.07;
    const SHARE: f64 = 0.25;

    /// Velocity after `h` seconds from `velocity`, under an input and a load.
    fn moved(velocity: f64, input: f64, load: f64, h: f64) -> f64 {
        let mut model = Model::body(INERTIA, 0.0);
        (model.gear_friction, model.constant_force) = (SHARE, load);
        let mut state = State::at_rest(input).restarted(0.0, velocity);
        Engine::new(&model).advance(&mut state, input, h);
        state.velocity()
    }

    #[test]
    fn the_teeth_rub_by_the_push_of_the_motor_and_of_what_it_pushes_against() {
        let h = 5e-3;
        // Lifting presses them, and so does letting down; what pushes the same way relieves them.
        let cases: [[f64; 3]; 3] = [[2.0, 5.0, -4.0], [-2.0, 3.0, -4.0], [2.0, 3.0, 1.0]];
        for [velocity, input, load] in cases {
            let friction = -SHARE * (input - load).abs() * velocity.signum();
            let exact = velocity + (input + load + friction) / INERTIA * h;
            let found = moved(velocity, input, load, h);
            assert!((found - exact).abs() < 1e-12, "{found} {exact}");
        }
    }

    #[test]
    fn it_holds_an_arm_until_the_difference_of_both_overcomes_it() {
        // It rubs with 0.25 (u + 4) and is pushed by u - 4: it breaks loose at 20/3.
        assert_eq!(moved(0.0, 6.6, -4.0, 5e-3), 0.0);
        assert!(moved(0.0, 6.7, -4.0, 5e-3) > 0.0);
        // A weight alone is more than a quarter of itself.
        assert!(moved(0.0, 0.0, -4.0, 5e-3) < 0.0);
    }
}
