//! State of a drive between events.

use super::trajectory::Side;

/// How a mass rubs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Friction {
    /// Held at rest.
    Stuck,
    /// Moves (or begins to move) up.
    Up,
    /// Moves down.
    Down,
}

impl Friction {
    /// Sign of the motion.
    pub fn sign(self) -> f64 {
        match self {
            Self::Stuck => 0.0,
            Self::Up => 1.0,
            Self::Down => -1.0,
        }
    }

    pub(super) fn towards(direction: f64) -> Self {
        if direction < 0.0 {
            Self::Down
        } else {
            Self::Up
        }
    }

    /// Of a mass with velocity `v` under a `force` besides its friction of this level.
    pub fn of(v: f64, force: f64, level: f64) -> Self {
        if v != 0.0 {
            Self::towards(v)
        } else if level > 0.0 && force.abs() <= level {
            Self::Stuck
        } else {
            Self::towards(force)
        }
    }
}

/// State of a drive: what moves continuously, and the modes.
#[derive(Clone, Copy, Debug)]
pub(super) struct State {
    pub x1: f64,
    pub v1: f64,
    pub v2: f64,
    /// `x1 - x2`, kept by itself so that the ends of the gap are met exactly.
    pub gap: f64,
    pub motor: Friction,
    pub load: Friction,
    /// Where the masses touch.
    pub joint: Option<Side>,
}
