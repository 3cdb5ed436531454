//! The run from event to event.

use super::runge_kutta::step;
use super::servo::Servo;
use crate::root::illinois;
use crate::simulate::{Noise, NoiseAlong};

/// Accuracy of a step, as a share of the scales of the motion.
const TOLERANCE: f64 = 1e-11;

/// Longest step, in typical times of the loop.
const LONGEST: f64 = 0.1;

/// Shortest step, in the same.
const SHORTEST: f64 = 1e-12;

/// It runs away that is so many times as far away as it should go.
const RUNAWAY: f64 = 1e6;

/// Steps after which a run is cut.
const MAX_STEPS: usize = 4_000_000;

/// A rest in which the integral would need more than so many typical times to break it is for ever.
const FOR_EVER: f64 = 1e6;

/// Where everything is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Place {
    /// Position of the motor.
    pub x: f64,
    /// Its velocity.
    pub v: f64,
    /// The controller's integral.
    pub integral: f64,
    /// Position behind the play.
    pub w: f64,
    /// By how much the controller sees that wrong; 0 without noise.
    pub noise: f64,
}

impl Place {
    /// The position that the controller sees.
    pub fn seen(&self) -> f64 {
        self.w + self.noise
    }
}

/// What ended a piece of the motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum End {
    /// The time was up.
    Time,
    /// The motor came to a standstill.
    Standstill,
    /// It broke away.
    Breakaway,
    /// It rests for ever.
    Rest,
    /// It runs away, or took too many steps.
    Cut,
}

/// A servo on its way.
pub(super) struct Course<'a> {
    pub servo: &'a Servo,
    pub now: f64,
    pub place: Place,
    /// Direction of the motion, 1 or -1; 0 while it sticks.
    pub way: f64,
    h: f64,
    steps: usize,
    /// Size of positions, for the accuracy.
    size: f64,
    noise: Option<NoiseAlong>,
}

impl<'a> Course<'a> {
    pub fn new(servo: &'a Servo, place: Place, size: f64) -> Self {
        let mut course = Self {
            servo,
            now: 0.0,
            place,
            way: 0.0,
            h: 0.01 * servo.typical_time(),
            steps: 0,
            size,
            noise: None,
        };
        if place.v == 0.0 {
            course.set_off();
        } else {
            course.way = place.v.signum();
        }
        course
    }

    /// A servo at rest at a place, with noise on the position that its controller sees.
    pub fn in_noise(servo: &'a Servo, place: Place, size: f64, noise: Option<Noise>) -> Self {
        let noise = noise.map(|noise| NoiseAlong::new(noise, 0));
        let seen = noise.as_ref().map_or(0.0, |noise| noise.at(0.0));
        let place = Place {
            noise: seen,
            ..place
        };
        Self {
            noise,
            ..Self::new(servo, place, size)
        }
    }

    /// Force on a motor at rest, but for friction.
    fn force(&self, place: &Place) -> f64 {
        let u = self.servo.asked(place.seen(), place.v, place.integral);
        self.servo.limited(u) - self.servo.cogging(place.x)
    }

    /// From a standstill: sticks, or moves with the force.
    fn set_off(&mut self) {
        self.place.v = 0.0;
        let force = self.force(&self.place);
        let sticks = force.abs() <= self.servo.friction.breakaway();
        self.way = if sticks { 0.0 } else { force.signum() };
    }

    /// Moves on to the next event, at most to `until` s.
    pub fn advance(&mut self, until: f64) -> End {
        let mut slope = 0.0;
        let mut until = until;
        if let Some(noise) = &mut self.noise {
            noise.go_to(self.now);
            self.place.noise = noise.at(self.now);
            slope = noise.slope();
            until = until.min(noise.end());
        }
        if self.way != 0.0 {
            self.slip(until, slope)
        } else if self.noise.is_some() {
            self.stick_in_noise(until, slope)
        } else {
            self.stick(until)
        }
    }

    /// At rest the integral alone moves, to where friction can no longer hold it.
    fn stick(&mut self, until: f64) -> End {
        let servo = self.servo;
        let place = self.place;
        let c = &servo.controller;
        let error = servo.reference - place.w;
        let rate = servo.integral_rate(place.w, 0.0, place.integral);
        if rate == 0.0 {
            self.now = until;
            return End::Rest;
        }
        // The output that would break it away, on the side to which the integral goes.
        let side = rate.signum();
        let needed = side * servo.friction.breakaway() + servo.cogging(place.x);
        let goal = needed - c.proportional * error;
        let reachable = servo.limited(needed) == needed;
        let wait = (goal - place.integral) / rate;
        let long = FOR_EVER * servo.typical_time();
        if !reachable || wait > long {
            self.now = until;
            return End::Rest;
        }
        let wait = wait.max(0.0);
        if self.now + wait > until {
            self.place.integral += rate * (until - self.now);
            self.now = until;
            return End::Time;
        }
        self.place.integral = goal;
        self.now += wait;
        self.way = side;
        End::Breakaway
    }

    /// The same while the noise moves by `slope` a second, which makes a parabola of the output that is asked for.
    fn stick_in_noise(&mut self, until: f64, slope: f64) -> End {
        let (servo, place) = (self.servo, self.place);
        let c = &servo.controller;
        let asked = servo.asked(place.seen(), 0.0, place.integral);
        let rate = servo.integral_rate(place.seen(), 0.0, place.integral);
        let parabola = [
            asked,
            rate - c.proportional * slope,
            -0.5 * c.integral * slope,
        ];
        let cogging = servo.cogging(place.x);
        let breaks = |side: f64| {
            let needed = side * servo.friction.breakaway() + cogging;
            let reachable = servo.limited(needed) == needed;
            // How far beyond what friction holds.
            let [start, slope, bend] = parabola;
            let beyond = [side * (start - needed), side * slope, side * bend];
            Some(side).zip(first_above(beyond).filter(|_| reachable))
        };
        let both = [1.0, -1.0].into_iter().filter_map(breaks);
        let first = both.min_by(|a, b| a.1.total_cmp(&b.1));
        let left = until - self.now;
        let broken = first.filter(|(_, wait)| *wait <= left);
        let wait = broken.map_or(left, |(_, wait)| wait);
        self.place.integral += wait * (rate - 0.5 * c.integral * slope * wait);
        self.place.noise += slope * wait;
        let Some((side, _)) = broken else {
            self.now = until;
            return End::Time;
        };
        self.now += wait;
        self.way = side;
        End::Breakaway
    }

    /// Moves in one direction, until it stands or the time is up, while the noise moves by `noise` a second.
    fn slip(&mut self, until: f64, noise: f64) -> End {
        let way = self.way;
        loop {
            self.steps += 1;
            let finite = self.place.x.is_finite() && self.place.v.is_finite();
            if self.steps > MAX_STEPS || !finite || self.place.x.abs() > RUNAWAY * self.size {
                return End::Cut;
            }
            let left = until - self.now;
            if left <= 0.0 {
                return End::Time;
            }
            let slip = Slip::new(self.servo, way, noise, &mut self.place);
            let Place {
                x,
                v,
                integral,
                noise: seen,
                ..
            } = self.place;
            let from = [x, v, integral, seen];
            let (mut h, mut to) = self.step(&slip, &from, left);
            let at = |h: f64| step(&|y| slip.rate(y), &from, h).0;
            let mut stands = way * to[1] <= 0.0 && way * from[1] > 0.0;
            // Just broken away it has no speed as yet; it may turn back at once.
            let failed = way * to[1] <= 0.0 && way * from[1] <= 0.0;
            if stands {
                h = illinois((0.0, from[1]), (h, to[1]), |h| at(h)[1]);
                to = at(h);
            }
            let takes_up = !slip.along && slip.ahead(to[0]) > 0.0;
            if takes_up {
                let gap = |h: f64| slip.ahead(at(h)[0]);
                h = illinois((0.0, gap(0.0)), (h, gap(h)), gap);
                to = at(h);
                stands = false;
            }
            self.now = if h == left { until } else { self.now + h };
            let w = if takes_up {
                slip.taken(to[0])
            } else {
                slip.behind(to[0])
            };
            let [x, v, integral, noise] = to;
            self.place = Place {
                x,
                v,
                integral,
                w,
                noise,
            };
            if stands || failed {
                self.set_off();
                return End::Standstill;
            }
        }
    }

    /// A step of `left` s at most that is accurate enough, and where it leads.
    fn step(&mut self, slip: &Slip<'_>, from: &[f64; 4], left: f64) -> (f64, [f64; 4]) {
        let typical = self.servo.typical_time();
        let reach = self.size.max(from[0].abs()).max(from[1].abs() * typical);
        let stiffness = self.servo.controller.proportional;
        let scales = [reach, reach / typical, stiffness * reach];
        let shortest = SHORTEST * typical;
        loop {
            let h = self.h.min(LONGEST * typical).min(left);
            let (to, error) = step(&|y| slip.rate(y), from, h);
            let off = error.iter().zip(scales).map(|(e, s)| (e / s).abs());
            let share = off.fold(0.0, f64::max) / TOLERANCE;
            let factor = 0.9 * libm::pow(share.max(1e-10), -0.2);
            if share > 1.0 && h > shortest {
                self.h = h * factor.max(0.2);
                continue;
            }
            self.h = (h * factor.clamp(0.2, 4.0)).max(shortest);
            return (h, to);
        }
    }
}

/// A motion in one direction: what is behind the play stays, or goes along at a distance.
struct Slip<'a> {
    servo: &'a Servo,
    way: f64,
    /// How the noise moves, 1/s.
    noise: f64,
    along: bool,
    fixed: f64,
}

impl<'a> Slip<'a> {
    /// The motion from a place, of which what is behind the play is set right where it goes along.
    fn new(servo: &'a Servo, way: f64, noise: f64, place: &mut Place) -> Self {
        let taken = place.x - way * servo.half_gap;
        let along = way * (taken - place.w) >= 0.0;
        if along {
            place.w = taken;
        }
        Self {
            servo,
            way,
            noise,
            along,
            fixed: place.w,
        }
    }

    /// Where what goes along is.
    fn taken(&self, x: f64) -> f64 {
        x - self.way * self.servo.half_gap
    }

    fn behind(&self, x: f64) -> f64 {
        if self.along {
            self.taken(x)
        } else {
            self.fixed
        }
    }

    /// How far the motor is beyond where it takes along what is behind the play.
    fn ahead(&self, x: f64) -> f64 {
        self.way * (self.taken(x) - self.fixed)
    }

    /// How position, velocity, integral and noise change.
    fn rate(&self, y: &[f64; 4]) -> [f64; 4] {
        let ([x, v, integral, noise], servo) = (*y, self.servo);
        let w = self.behind(x) + noise;
        let u = servo.limited(servo.asked(w, v, integral));
        let dry = self.way * servo.friction.moving(v);
        let force = u - servo.viscous * v - dry - servo.cogging(x);
        [
            v,
            force / servo.inertia,
            servo.integral_rate(w, v, integral),
            self.noise,
        ]
    }
}

/// When `a + b t + c t^2`, which is not above 0 at first, rises through 0; at once where it is there and rises.
fn first_above([a, b, c]: [f64; 3]) -> Option<f64> {
    if a >= 0.0 && (b > 0.0 || (b == 0.0 && c > 0.0)) {
        return Some(0.0);
    }
    let a = a.min(0.0);
    // The root at which it rises, written so that no digits are lost.
    let root = (b * b - 4.0 * a * c).sqrt();
    let time = if b > 0.0 {
        -2.0 * a / (b + root)
    } else {
        (root - b) / (2.0 * c)
    };
    (time.is_finite() && time > 0.0).then_some(time)
}
