//! Rigid dry friction: sticking and slipping as modes of one body, found by exact flows.

use super::flow::{Flow, Motion};
use crate::root::falsi;

/// Changes of mode in one interval of held input after which the body is taken to stick: a run never
/// hangs on infinitely many of them.
const MAX_EVENTS: usize = 64;

/// Sign of motion of a body, or sticking.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub(super) enum Mode {
    /// At rest, held by dry friction.
    #[default]
    Stick,
    /// Moves towards positive positions.
    Forward,
    /// Moves towards negative positions.
    Backward,
}

impl Mode {
    pub fn of(v: f64) -> Self {
        if v > 0.0 {
            Self::Forward
        } else if v < 0.0 {
            Self::Backward
        } else {
            Self::Stick
        }
    }

    /// Mode of a body at rest under force `f` with friction `level`.
    pub fn from_rest(f: f64, level: f64) -> Self {
        if f.abs() <= level {
            Self::Stick
        } else {
            Self::of(f)
        }
    }

    pub fn sign(self) -> f64 {
        match self {
            Self::Stick => 0.0,
            Self::Forward => 1.0,
            Self::Backward => -1.0,
        }
    }
}

/// Dry friction of one body over a piece of its motion.
pub(super) struct Rubbing {
    pub level: f64,
    /// 1 where it slips forwards, -1 backwards, 0 where it sticks or does not rub.
    pub way: f64,
    pub sticks: bool,
}

impl Rubbing {
    pub fn new(mode: Mode, level: f64) -> Self {
        let way = if level > 0.0 { mode.sign() } else { 0.0 };
        Self {
            level,
            way,
            sticks: level > 0.0 && way == 0.0,
        }
    }

    /// Above 0 until it turns or breaks loose.
    pub fn margin(&self, velocity: f64, force: f64) -> f64 {
        if self.sticks {
            self.level - force.abs()
        } else if self.way == 0.0 {
            f64::INFINITY
        } else {
            self.way * velocity
        }
    }

    /// Mode after it has turned or broken loose under this force.
    pub fn after_event(&self, force: f64) -> Mode {
        if self.sticks {
            Mode::of(force)
        } else {
            Mode::from_rest(force, self.level)
        }
    }
}

/// Moves one body for `h` seconds under the input `w` and a held `force`, with friction `level`.
pub(super) fn slide(
    flow: &Flow,
    motion: &mut Motion,
    mode: &mut Mode,
    w: f64,
    force: f64,
    level: f64,
    h: f64,
) {
    let mut left = h;
    for _ in 0..MAX_EVENTS {
        let (used, event) = body_event(flow, *motion, *mode, w, force, level, left);
        *motion = used.motion;
        left -= used.time;
        match event {
            None => return,
            Some(next) => *mode = next,
        }
        if left <= 0.0 {
            return;
        }
    }
    // Endless switching within one sample is sticking to all intents.
    *mode = Mode::Stick;
    motion.v = 0.0;
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
        let turn = falsi(left, slope(0.0), slope(left), slope);
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
        flow.stops(start, w, q, until, v_until)
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
    let z_end = flow.input_after(start, w, left);
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
