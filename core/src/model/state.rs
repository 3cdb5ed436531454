//! State of the whole model.

use super::Model;
use super::flow::Motion;
use super::followed::Followed;
use super::friction::Mode;
use super::joint::Joined;

/// State of the whole model. Position and velocity are what a window estimates; the rest is
/// hidden and carried from window to window.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct State {
    pub(super) motion: Motion,
    pub(super) mode: Mode,
    /// Elastic deflection of the contact of dry friction.
    pub(super) deflection: f64,
    /// x1 - x2.
    pub(super) twist: f64,
    /// Motion of the load; its position is told by the twist.
    pub(super) load: Motion,
    pub(super) load_mode: Mode,
    /// Time since the first sample, s.
    pub(super) time: f64,
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

    /// In contact with a load at this twist, both moving.
    #[cfg(test)]
    pub(super) fn touching(twist: f64, velocity: f64, load_velocity: f64) -> Self {
        let moving = |v| Motion {
            v,
            ..Motion::default()
        };
        Self {
            motion: moving(velocity),
            mode: Mode::of(velocity),
            twist,
            load: moving(load_velocity),
            load_mode: Mode::of(load_velocity),
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

    /// x1 - x2 of a drive with a load.
    pub fn twist(&self) -> f64 {
        self.twist
    }

    /// Velocity of the load.
    pub fn load_velocity(&self) -> f64 {
        self.load.v
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

    /// Body and load at the ends of a joint with this play to their side.
    pub(super) fn joined(&self, play: f64) -> Joined {
        Joined {
            body: self.motion,
            twist: self.twist - play,
            load: self.load.v,
        }
    }

    /// Takes up where they came to in `time` seconds; their modes stay.
    pub(super) fn join(&mut self, next: &Joined, play: f64, time: f64) {
        let twist = next.twist + play;
        self.load.x += (next.body.x - self.motion.x) - (twist - self.twist);
        self.motion = next.body;
        self.twist = twist;
        self.load.v = next.load;
        self.time += time;
    }

    /// Lets time pass without motion: only the lagged input goes on.
    pub(super) fn wait(&mut self, model: &Model, w: f64, h: f64) {
        self.motion.z = match model.lag {
            Some(tau) => w + (self.motion.z - w) * libm::exp(-h / tau),
            None => w,
        };
        self.time += h;
    }

    /// The same, this many seconds after the first sample.
    #[must_use]
    pub(super) fn at_time(&self, time: f64) -> Self {
        Self { time, ..*self }
    }

    /// The same with the contact of dry friction at this deflection.
    #[must_use]
    pub(super) fn with_deflection(&self, deflection: f64) -> Self {
        Self {
            deflection,
            ..*self
        }
    }

    /// The same with the load where it followed the body, shifted in position and velocity; `position` is where the
    /// body was measured.
    #[must_use]
    pub(super) fn with_load(&self, load: &Followed, position: f64, shift: [f64; 2]) -> Self {
        let mut next = *self;
        next.twist = position - load.motion.x - shift[0];
        next.load = load.motion;
        next.load_mode = load.mode;
        if shift[1] != 0.0 {
            next.load.v += shift[1];
            next.load_mode = Mode::of(next.load.v);
        }
        next
    }
}
