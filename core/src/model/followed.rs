//! A load that follows a body which moves as measured.

use super::flow::{Flow, Motion};
use super::friction::{Mode, slide};
use super::load::Load;
use super::swing::{Parabola, Swing};

/// Times the noise of a joint's load by which it may be off: encoders do not err at random, and between samples the
/// body moves in a way of its own.
const WIDELY: f64 = 10.0;

/// Standard deviation of the noise of what a load follows: measured position, or the integral of measured velocity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FollowedNoise {
    /// Of the position, rad or m.
    Position(f64),
    /// Of the velocity, rad/s or m/s.
    Velocity(f64),
}

impl Load {
    /// Standard deviations of position and velocity of a load that follows a body with this noise, sampled every `h`
    /// seconds, behind a joint without play: a resonance that the noise excites (white noise of spectral density
    /// S on a lightly damped oscillator: S w / (4 zeta), e.g. Crandall and Mark 1963).
    pub(super) fn doubt(&self, noise: FollowedNoise, h: f64) -> [f64; 2] {
        let frequency = (self.coupling.stiffness / self.inertia).sqrt();
        let damping = self.decay();
        // A load with less damping has not yet forgotten how it began to follow.
        let damping = damping.max(1.0 / (WARM_UP as f64 * h));
        let excited = frequency * frequency * h / (2.0 * damping);
        let level = match noise {
            FollowedNoise::Position(level) => level,
            FollowedNoise::Velocity(level) => level / frequency,
        };
        // The twist counts from the measured position with its own noise.
        let x = WIDELY * level * (1.0 + excited).sqrt();
        [x, x * frequency]
    }

    /// Samples, `h` seconds apart, after which it has forgotten how it began to follow the body.
    fn warm_up(&self, h: f64) -> usize {
        if self.coupling.half_gap > 0.0 {
            return WARM_UP;
        }
        // A swing without damping is never forgotten: the cast saturates.
        let samples = (2.0 * FORGOTTEN / (self.decay() * h)).ceil();
        (samples as usize).clamp(WARM_UP, LONGEST_WARM_UP)
    }
}

/// State of a load that follows the body.
#[derive(Clone, Copy, Debug)]
pub(super) struct Followed {
    pub motion: Motion,
    pub mode: Mode,
}

/// A load that follows a body which moves as measured.
///
/// Since the body's motion is given, the load cannot drift away from it: its hidden state is known at
/// any time, however long ago the record began.
pub(super) struct Follower<'m> {
    load: &'m Load,
    flow: Flow,
    pub now: Followed,
    steps: u32,
    /// Time from a sample to the next for which its flow is prepared, s.
    usual: f64,
    /// In one step where the load neither turns nor comes or goes.
    swing: Option<Swing>,
    /// Sample up to which it has followed.
    sample: usize,
    /// Samples after which it has forgotten how it began.
    warm_up: usize,
}

/// Samples after which a load behind a gap has forgotten how it began: it is pushed along many times in them.
const WARM_UP: usize = 1500;

/// Time constants of its decay after which a load on a joint has, all but two hundredths; and samples at most, since a
/// load that hardly decays would be followed through all of the record.
const FORGOTTEN: f64 = 4.0;
const LONGEST_WARM_UP: usize = 4 * WARM_UP;

/// Most steps in an interval of a follower.
const MAX_FOLLOWER_STEPS: f64 = 32.0;

impl<'m> Follower<'m> {
    /// `load` at rest in the middle of the gap around `position`, to be moved in intervals of about
    /// `h` seconds.
    pub fn new(load: &'m Load, position: f64, h: f64) -> Self {
        let mut flow = Flow::new(load.inertia, load.viscous, None);
        let steps = (h / load.longest_step(f64::INFINITY))
            .ceil()
            .clamp(1.0, MAX_FOLLOWER_STEPS);
        flow.prepare(h);
        flow.prepare(h / steps);
        Self {
            load,
            flow,
            now: Followed {
                motion: Motion {
                    x: position,
                    ..Motion::default()
                },
                mode: Mode::Stick,
            },
            steps: steps as u32,
            usual: h,
            swing: Swing::new(load, h),
            sample: 0,
            warm_up: load.warm_up(h),
        }
    }

    /// Moves the load to position `x` with velocity `v` at a sample.
    pub fn place(&mut self, x: f64, v: f64, sample: usize) {
        (self.now.motion.x, self.now.motion.v) = (x, v);
        self.now.mode = Mode::of(v);
        self.sample = sample;
    }

    /// Follows up to a sample, not before the last one asked for; `h` tells the time from a sample to the
    /// next. A long way is cut short: the load then begins as if it had gone with the body.
    pub fn reach(&mut self, position: &[f64], sample: usize, h: impl Fn(usize) -> f64) {
        if sample > self.sample.saturating_add(self.warm_up) {
            self.sample = sample - self.warm_up;
            let (from, to) = (position[self.sample], position[self.sample + 1]);
            let v = (to - from) / h(self.sample);
            (self.now.motion.x, self.now.motion.v) = (from, v);
            self.now.mode = Mode::of(v);
        }
        self.follow(position, sample, h, |_, _| ());
    }

    /// Follows up to sample `to`; `h` tells the time from a sample to the next, and `torque` takes the mean torque or
    /// force on the load after each.
    fn follow(
        &mut self,
        position: &[f64],
        to: usize,
        h: impl Fn(usize) -> f64,
        mut torque: impl FnMut(usize, f64),
    ) {
        let plays = self.load.coupling.half_gap > 0.0;
        while self.sample < to {
            if plays {
                self.coast(position, to, &h, &mut torque);
            } else {
                self.hold(position, to, &h, &mut torque);
                self.glide(position, to, &h, &mut torque);
            }
            if self.sample < to {
                let sample = self.sample;
                torque(sample, self.step(position, h(sample)));
            }
        }
    }

    /// Follows up to sample `to` as long as a load on a joint without play goes on one way: what [`Self::step`] does,
    /// without asking at each sample what may happen.
    fn glide(
        &mut self,
        position: &[f64],
        to: usize,
        h: impl Fn(usize) -> f64,
        mut torque: impl FnMut(usize, f64),
    ) {
        let dry = self.load.dry_friction;
        let rubs = dry > 0.0;
        let sign = if rubs { self.now.mode.sign() } else { 0.0 };
        let (Some(swing), Some(first)) = (&self.swing, position.get(self.sample)) else {
            return;
        };
        if rubs && sign == 0.0 {
            return;
        }
        let friction = -sign * dry;
        let pull = swing.pull(friction);
        let mut swung = [self.now.motion.x - first, self.now.motion.v * swing.h];
        let begun = self.sample;
        while self.sample < to && h(self.sample) == swing.h {
            let course = Course::of(position, self.sample);
            let body = course.parabola(0.0);
            let next = swing.next(swung, &body, pull);
            if rubs && next[1] * sign <= 0.0 {
                break;
            }
            torque(self.sample, swing.torque(swung, next) - friction);
            swung = [next[0] - course.way, next[1]];
            self.sample += 1;
        }
        if self.sample > begun {
            let from = position[self.sample.min(position.len() - 1)];
            self.now.motion.x = from + swung[0];
            self.now.motion.v = swung[1] / swing.h;
            self.now.mode = Mode::of(self.now.motion.v);
        }
    }

    /// Follows up to sample `to` as long as a load behind a gap meets neither side and does not turn: what
    /// [`Self::step`] does, without asking at each sample what else may happen.
    fn coast(
        &mut self,
        position: &[f64],
        to: usize,
        h: impl Fn(usize) -> f64,
        mut torque: impl FnMut(usize, f64),
    ) {
        let (step, dry) = (self.usual, self.load.dry_friction);
        let rubs = dry > 0.0;
        let sign = if rubs { self.now.mode.sign() } else { 0.0 };
        let sticks = rubs && sign == 0.0;
        let Some(free) = self.flow.prepared(step) else {
            return;
        };
        while self.sample < to && h(self.sample) == step {
            let Some([from, next]) = position.get(self.sample..self.sample + 2) else {
                return;
            };
            let Motion { x, v, .. } = self.now.motion;
            if self
                .load
                .may_touch(from - x, (next - from) / step - v, step)
            {
                return;
            }
            if !sticks {
                let end = self.flow.apply(free, self.now.motion, 0.0, -sign * dry);
                if rubs && end.v * sign <= 0.0 {
                    return;
                }
                self.now.motion = end;
            }
            torque(self.sample, 0.0);
            self.sample += 1;
        }
    }

    /// Follows up to sample `to` as long as the friction of a load on a joint without play holds it.
    fn hold(
        &mut self,
        position: &[f64],
        to: usize,
        h: impl Fn(usize) -> f64,
        mut torque: impl FnMut(usize, f64),
    ) {
        let (coupling, dry) = (self.load.coupling, self.load.dry_friction);
        if dry <= 0.0 || self.now.mode != Mode::Stick {
            return;
        }
        while self.sample < to {
            let h = h(self.sample);
            let course = Course::of(position, self.sample);
            let Parabola { from, begin, bend } = course.parabola(0.0);
            let twist = from - self.now.motion.x;
            let ends = [(0.0, begin), (course.way, begin + bend)];
            let holds =
                |(way, velocity)| coupling.unlimited(twist + way, velocity / h).abs() <= dry;
            if !ends.into_iter().all(holds) {
                return;
            }
            let mean = twist + 0.5 * course.way - bend / 12.0;
            torque(self.sample, coupling.unlimited(mean, course.way / h));
            self.sample += 1;
        }
    }

    /// Moves on to the next sample, `h` seconds later; mean torque or force on the load.
    fn step(&mut self, position: &[f64], h: f64) -> f64 {
        let torque = self.advance(position, self.sample, h);
        self.sample += 1;
        torque
    }

    /// Moves the load in one step while the body goes along its `course`; mean torque or force on it. `None` where the
    /// load turns or sticks, or comes or goes.
    fn swing_along(&mut self, course: &Course, h: f64) -> Option<f64> {
        let swing = self.swing.as_ref().filter(|s| s.h == h)?;
        let (coupling, dry) = (self.load.coupling, self.load.dry_friction);
        let Course { from, way, bend } = *course;
        let twist = from - self.now.motion.x;
        let side = twist.signum();
        let body = course.parabola(side * coupling.half_gap);
        if !coupling.joins(side, twist, body.begin / h - self.now.motion.v) {
            return None;
        }
        let rubs = dry > 0.0;
        let sign = if rubs { self.now.mode.sign() } else { 0.0 };
        if rubs && sign == 0.0 {
            return None;
        }
        let (end, torque) = swing.advance(self.now.motion, &body, -sign * dry);
        let turns = rubs && end.v * sign <= 0.0;
        let rate = (body.begin + bend) / h - end.v;
        if turns || !coupling.joins(side, from + way - end.x, rate) {
            return None;
        }
        self.now = Followed {
            motion: end,
            mode: Mode::of(end.v),
        };
        Some(torque)
    }

    /// Moves the body along `position` from sample `i` to the next one in `h` seconds, on a parabola
    /// bent like the samples around; mean torque or force on the load.
    fn advance(&mut self, position: &[f64], i: usize, h: f64) -> f64 {
        let course = Course::of(position, i);
        if let Some(torque) = self.swing_along(&course, h) {
            return torque;
        }
        let Course { from, way, bend } = course;
        let v1 = way / h;
        let touching = self
            .load
            .may_touch(from - self.now.motion.x, v1 - self.now.motion.v, h);
        let steps = if touching { self.steps } else { 1 };
        let part = h / f64::from(steps);
        let mut sum = 0.0;
        for k in 0..steps {
            let share = (f64::from(k) + 0.5) / f64::from(steps);
            let middle = from + way * share - 0.5 * bend * share * (1.0 - share);
            let rate = v1 - 0.5 * bend * (1.0 - 2.0 * share) / h;
            let twist = middle - self.now.motion.x - 0.5 * part * self.now.motion.v;
            let force = self.load.coupling.force(twist, rate - self.now.motion.v);
            sum += force;
            slide(
                &self.flow,
                &mut self.now.motion,
                &mut self.now.mode,
                0.0,
                force,
                self.load.dry_friction,
                part,
            );
        }
        sum / f64::from(steps)
    }
}

/// How the body goes on from one sample to the next: a parabola, bent like the samples around.
struct Course {
    from: f64,
    way: f64,
    bend: f64,
}

impl Course {
    /// From sample `i`; the samples are taken as equally spaced.
    fn of(position: &[f64], i: usize) -> Self {
        let around = i
            .checked_sub(1)
            .and_then(|before| position.get(before..i + 3));
        if let Some([before, from, to, after]) = around {
            // Mean second difference.
            return Self {
                from: *from,
                way: to - from,
                bend: 0.5 * (after - to - from + before),
            };
        }
        let at = |j: usize| position[j.min(position.len() - 1)];
        Self {
            from: at(i),
            way: at(i + 1) - at(i),
            bend: 0.0,
        }
    }

    /// The same, seen from where it begins but for `play`.
    fn parabola(&self, play: f64) -> Parabola {
        Parabola {
            from: self.from - play,
            begin: self.way - 0.5 * self.bend,
            bend: self.bend,
        }
    }
}

/// Torque or force that `load` would put on a body which is moved as measured: `position` at equal steps of
/// `h` seconds. It is found at the samples of `spans` (first and end, ascending) and is 0 elsewhere.
pub fn load_torque(load: &Load, position: &[f64], h: f64, spans: &[(usize, usize)]) -> Vec<f64> {
    let mut torque = vec![0.0; position.len()];
    let Some(first) = position.first() else {
        return torque;
    };
    let mut follower = Follower::new(load, *first, h);
    for (from, to) in spans {
        if torque.get(*from..*to).is_none() {
            continue;
        }
        follower.reach(position, *from, |_| h);
        follower.follow(position, *to, |_| h, |i, value| torque[i] = value);
    }
    torque
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Coupling;

    #[test]
    fn following_many_samples_at_once_is_following_them_one_by_one() {
        let h = 2e-4;
        let position: Vec<f64> = (0..4000)
            .map(|i| {
                0.3 * libm::sin(0.011 * f64::from(i)) + 0.05 * libm::sin(1e-5 * f64::from(i * i))
            })
            .collect();
        for dry_friction in [0.0, 0.05, 0.5, 1.5] {
            let load = Load {
                inertia: 7e-4,
                viscous: 1e-3,
                dry_friction,
                coupling: Coupling {
                    half_gap: 0.0,
                    stiffness: 5.0,
                    damping: 4e-3,
                },
            };
            let at_once = load_torque(&load, &position, h, &[(0, position.len())]);
            let mut follower = Follower::new(&load, position[0], h);
            let mut held = 0;
            for (i, at_once) in at_once.iter().enumerate() {
                let one = follower.step(&position, h);
                held += usize::from(follower.now.mode == Mode::Stick);
                // A load that is held is asked in the middles of short steps there; torques are about 1 N m.
                assert!(
                    (at_once - one).abs() < 1e-4,
                    "{dry_friction}, {i}: {at_once} is not {one}"
                );
            }
            if dry_friction == 1.5 {
                assert!((100..3900).contains(&held), "{held} samples held");
            }
        }
    }
}
