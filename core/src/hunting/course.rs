//! The run from event to event.

use super::runge_kutta::step;
use super::servo::Servo;
use crate::root::illinois;

/// Accuracy of a step, as a share of the scales of the motion.
const TOLERANCE: f64 = 1e-11;

/// Longest step, in typical times of the loop.
const LONGEST: f64 = 0.1;

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
        };
        if place.v == 0.0 {
            course.set_off();
        } else {
            course.way = place.v.signum();
        }
        course
    }

    /// Force on a motor at rest, but for friction.
    fn force(&self, place: &Place) -> f64 {
        let u = self.servo.asked(place.w, place.v, place.integral);
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
        if self.way == 0.0 {
            self.stick(until)
        } else {
            self.slip(until)
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

    /// Moves in one direction, until it stands or the time is up.
    fn slip(&mut self, until: f64) -> End {
        let (servo, way) = (self.servo, self.way);
        let typical = servo.typical_time();
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
            // Behind the play it stays, or goes along at a distance.
            let taken = self.place.x - way * servo.half_gap;
            let along = way * (taken - self.place.w) >= 0.0;
            if along {
                self.place.w = taken;
            }
            let fixed = self.place.w;
            let behind = |x: f64| {
                if along {
                    x - way * servo.half_gap
                } else {
                    fixed
                }
            };
            let rate = |y: &[f64; 3]| {
                let [x, v, integral] = *y;
                let w = behind(x);
                let u = servo.limited(servo.asked(w, v, integral));
                let dry = way * servo.friction.moving(v);
                let force = u - servo.viscous * v - dry - servo.cogging(x);
                [
                    v,
                    force / servo.inertia,
                    servo.integral_rate(w, v, integral),
                ]
            };
            let from = [self.place.x, self.place.v, self.place.integral];
            let mut h = self.h.min(LONGEST * typical).min(left);
            let (mut to, share) = {
                let (to, error) = step(&rate, &from, h);
                let reach = self.size.max(from[0].abs()).max(from[1].abs() * typical);
                let stiffness = servo.controller.proportional;
                let scales = [reach, reach / typical, stiffness * reach];
                let off = error.iter().zip(scales).map(|(e, s)| (e / s).abs());
                (to, off.fold(0.0, f64::max) / TOLERANCE)
            };
            let factor = 0.9 * libm::pow(share.max(1e-10), -0.2);
            if share > 1.0 && h > 1e-12 * typical {
                self.h = h * factor.max(0.2);
                continue;
            }
            self.h = (h * factor.clamp(0.2, 4.0)).max(1e-12 * typical);
            let at = |h: f64| step(&rate, &from, h).0;
            let mut stands = way * to[1] <= 0.0 && way * from[1] > 0.0;
            // Just broken away it has no speed as yet; it may turn back at once.
            let failed = way * to[1] <= 0.0 && way * from[1] <= 0.0;
            if stands {
                h = illinois((0.0, from[1]), (h, to[1]), |h| at(h)[1]);
                to = at(h);
            }
            let engages = |x: f64| way * (x - way * servo.half_gap - fixed);
            if !along && engages(to[0]) > 0.0 {
                let gap = |h: f64| engages(at(h)[0]);
                h = illinois((0.0, gap(0.0)), (h, gap(h)), gap);
                to = at(h);
                stands = false;
            }
            self.now = if h == left { until } else { self.now + h };
            self.place = Place {
                x: to[0],
                v: to[1],
                integral: to[2],
                w: behind(to[0]),
            };
            if !along && engages(to[0]).abs() <= 1e-12 * self.size {
                self.place.w = self.place.x - way * servo.half_gap;
            }
            if stands || failed {
                self.set_off();
                return End::Standstill;
            }
            if self.now >= until {
                return End::Time;
            }
        }
    }
}
