//! Whether a servo comes to rest, or the cycle in which it ends.
//!
//! The motion is looked at where the motor comes to a standstill: position, integral and play are all that is left of
//! the state there. Once a sequence of standstills repeats, Newton's method finds the state that repeats exactly; the
//! slope of the map from one period to the next says what becomes of small disturbances.

use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

use super::course::{Course, End, Place};
use super::run::at_rest;
use super::servo::{Servo, ServoError};
use crate::message::{Message, fixed};
use crate::msg;
use crate::uncertain::digits;

/// Digits of a position that is said.
const DIGITS: i32 = 5;

/// A hunting cycle.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct HuntingCycle {
    /// Period, s.
    pub period: f64,
    /// Half of peak to peak of the measured position, rad (or m).
    pub amplitude: f64,
    /// The same of the motor's.
    pub motor_amplitude: f64,
    /// Smallest and largest measured position.
    pub range: [f64; 2],
    /// Share of the period in which the motor sticks.
    pub stuck: f64,
    /// Largest modulus of the eigenvalues of the map from one period to the next.
    pub multiplier: Option<f64>,
    /// Whether small disturbances die out; `None` where it is not known.
    pub stable: Option<bool>,
}

/// What becomes of a servo.
#[derive(Clone, Debug, PartialEq)]
pub struct Settled {
    /// The cycle to which the run comes.
    pub simulated: Option<HuntingCycle>,
    /// The same to round-off, with its stability.
    pub exact: Option<HuntingCycle>,
    /// Distance from the reference at which it comes to rest, where it does.
    pub error_at_rest: Option<f64>,
    /// It runs away.
    pub unbounded: bool,
    /// The answer in a sentence.
    pub text: Message,
}

/// Standstills after which a cycle is looked for, each time four times as many.
const FIRST_LOOK: usize = 60;
const LOOKS: usize = 4;

/// Longest run without a standstill, in typical times.
const LONG: f64 = 1e5;

/// How often it is looked whether it creeps, in typical times.
const OFTEN: f64 = 30.0;

/// Most standstills in a period.
const LONGEST_PATTERN: usize = 16;

/// Share by which standstills may differ that are taken for the same: to begin Newton's method, and to be called
/// settled.
const ALIKE: f64 = 1e-2;
const SETTLED: f64 = 1e-6;

/// A swing below this share of the way to the reference has died.
const DEAD: f64 = 1e-8;

/// Newton's method: steps, the step for slopes as a share of the amplitude, and the change at which it is done.
const MAX_NEWTON: usize = 20;
const SLOPE: f64 = 1e-5;
const DONE: f64 = 1e-9;

/// A multiplier this near 1 decides nothing.
const NEUTRAL: f64 = 1e-4;

/// A standstill after a motion in one direction.
#[derive(Clone, Copy, Debug)]
struct Stand {
    time: f64,
    way: f64,
    place: Place,
    /// How long it stuck before that motion, s.
    stuck: f64,
}

/// Follows a servo from rest at 0 until it repeats itself, rests or runs away, and finds its cycle exactly.
///
/// # Errors
/// What of the servo cannot be.
pub fn settled(servo: &Servo) -> Result<Settled, ServoError> {
    servo.validate()?;
    let (place, size) = at_rest(servo);
    let mut course = Course::new(servo, place, size);
    let mut stands: Vec<Stand> = Vec::new();
    let (mut simulated, mut exact) = (None, None);
    for look in 0..LOOKS {
        let wanted = FIRST_LOOK << (2 * look);
        while stands.len() < wanted {
            match next_stand(&mut course, size) {
                Ok(stand) => stands.push(stand),
                Err(End::Cut) => return Ok(runs_away()),
                Err(_) => return Ok(rests(servo, &course.place)),
            }
            if let [.., a, b] = stands.as_slice()
                && (a.place.x - b.place.x).abs() < DEAD * size
                && (servo.reference - b.place.w).abs() < DEAD * size
            {
                return Ok(rests(servo, &course.place));
            }
        }
        if let Some(pattern) = repeated(&stands, ALIKE) {
            exact = solve(servo, size, pattern);
        }
        simulated = repeated(&stands, SETTLED).map(cycle_of);
        if simulated.is_some() && exact.is_some() {
            break;
        }
    }
    if let Some((simulated, exact)) = simulated.as_mut().zip(exact.as_ref()) {
        judge(simulated, exact);
    }
    let text = match exact.as_ref().or(simulated.as_ref()) {
        Some(cycle) => msg!(
            "It hunts: the measured position swings to and fro by {} (half of peak to peak) with a period of {} s, \
             and the motor sticks for {} % of the time.",
            digits(cycle.amplitude, DIGITS),
            fixed(cycle.period, 4),
            fixed(100.0 * cycle.stuck, 0)
        ),
        None => "It hunts in a pattern of many swings, or in none that repeats.".into(),
    };
    Ok(Settled {
        simulated,
        exact,
        error_at_rest: None,
        unbounded: false,
        text,
    })
}

fn rests(servo: &Servo, place: &Place) -> Settled {
    let error = servo.reference - place.w;
    Settled {
        simulated: None,
        exact: None,
        error_at_rest: Some(error),
        unbounded: false,
        text: msg!(
            "It does not hunt: it comes to rest {} from its reference.",
            digits(error, DIGITS)
        ),
    }
}

fn runs_away() -> Settled {
    Settled {
        simulated: None,
        exact: None,
        error_at_rest: None,
        unbounded: true,
        text: "The loop is unstable: its oscillation grows without bound.".into(),
    }
}

/// Goes on to the next standstill; what it came to where there is none, rest if it creeps to its reference.
fn next_stand(course: &mut Course<'_>, size: f64) -> Result<Stand, End> {
    let typical = course.servo.typical_time();
    let begin = course.now;
    let mut broke_away = begin;
    while course.now < begin + LONG * typical {
        let way = course.way;
        match course.advance(course.now + OFTEN * typical) {
            End::Breakaway => broke_away = course.now,
            End::Standstill if way != 0.0 => {
                return Ok(Stand {
                    time: course.now,
                    way,
                    place: course.place,
                    stuck: broke_away - begin,
                });
            }
            End::Time => {
                let Place { v, w, .. } = course.place;
                let left = (course.servo.reference - w).abs().max(v.abs() * typical);
                if way != 0.0 && left < DEAD * size {
                    return Err(End::Rest);
                }
            }
            End::Standstill => {}
            other => return Err(other),
        }
    }
    Err(End::Rest)
}

/// The last whole pattern, with the standstill before it.
fn repeated(stands: &[Stand], tolerance: f64) -> Option<&[Stand]> {
    (1..=LONGEST_PATTERN).find_map(|length| {
        let from = stands.len().checked_sub(2 * length + 1)?;
        let part = &stands[from..];
        let [low, high] = extent(&part[length..], |p| p.x);
        let period = part[2 * length].time - part[length].time;
        let alike = |a: f64, b: f64, size: f64| (a - b).abs() <= tolerance * size;
        let same = (1..=length).all(|i| {
            let (a, b) = (&part[i], &part[i + length]);
            let took = [
                a.time - part[i - 1].time,
                b.time - part[i + length - 1].time,
            ];
            a.way == b.way
                && alike(a.place.x, b.place.x, high - low)
                && alike(a.place.w, b.place.w, high - low)
                && alike(took[0], took[1], period)
        });
        (same && high > low).then(|| &part[length..])
    })
}

fn extent(stands: &[Stand], value: impl Fn(&Place) -> f64) -> [f64; 2] {
    let all = stands.iter().map(|s| value(&s.place));
    all.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| {
        [low.min(v), high.max(v)]
    })
}

fn cycle_of(pattern: &[Stand]) -> HuntingCycle {
    let period = pattern[pattern.len() - 1].time - pattern[0].time;
    let (range, motor) = (extent(pattern, |p| p.w), extent(pattern, |p| p.x));
    HuntingCycle {
        period,
        amplitude: 0.5 * (range[1] - range[0]),
        motor_amplitude: 0.5 * (motor[1] - motor[0]),
        range,
        stuck: pattern[1..].iter().map(|s| s.stuck).sum::<f64>() / period,
        multiplier: None,
        stable: None,
    }
}

/// The run's cycle takes the stability of the exact one, if that is the one that it repeats.
fn judge(simulated: &mut HuntingCycle, exact: &HuntingCycle) {
    let alike = |a: f64, b: f64| (a - b).abs() <= ALIKE * b;
    if alike(simulated.period, exact.period) && alike(simulated.amplitude, exact.amplitude) {
        (simulated.multiplier, simulated.stable) = (exact.multiplier, exact.stable);
    }
}

/// The map from a standstill to the one a period later, in as many numbers as are free there.
struct Map<'a> {
    servo: &'a Servo,
    size: f64,
    ways: Vec<f64>,
    /// The integral where the controller has none: it stays as it is.
    no_integral: Option<f64>,
    /// Distance of motor and measured position where the play is taken up.
    taken_up: Option<f64>,
}

impl Map<'_> {
    fn place(&self, s: &DVector<f64>) -> Place {
        let mut rest = s.iter().skip(1).copied();
        let integral = self.no_integral.or_else(|| rest.next());
        let w = self.taken_up.map(|gap| s[0] - gap).or_else(|| rest.next());
        Place {
            x: s[0],
            v: 0.0,
            integral: integral.unwrap_or_default(),
            w: w.unwrap_or_default(),
            noise: 0.0,
        }
    }

    /// What is free: position, integral where there is one, measured position where it may stand within the play.
    fn free(&self, [x, integral, w]: [f64; 3]) -> DVector<f64> {
        let integral = self.no_integral.is_none().then_some(integral);
        let w = self.taken_up.is_none().then_some(w);
        let free = [Some(x), integral, w].into_iter().flatten().collect();
        DVector::from_vec(free)
    }

    fn vector(&self, place: &Place) -> DVector<f64> {
        self.free([place.x, place.integral, place.w])
    }

    /// The standstills of one period.
    fn period(&self, from: &DVector<f64>) -> Option<Vec<Stand>> {
        let mut course = Course::new(self.servo, self.place(from), self.size);
        let mut stands = vec![Stand {
            time: 0.0,
            way: 0.0,
            place: course.place,
            stuck: 0.0,
        }];
        for way in &self.ways {
            let stand = next_stand(&mut course, self.size).ok()?;
            if stand.way != *way {
                return None;
            }
            stands.push(stand);
        }
        Some(stands)
    }

    fn end(&self, from: &DVector<f64>) -> Option<DVector<f64>> {
        self.period(from)?.last().map(|s| self.vector(&s.place))
    }

    fn slope(&self, at: &DVector<f64>, scales: &[f64]) -> Option<DMatrix<f64>> {
        let n = at.len();
        let mut slope = DMatrix::zeros(n, n);
        for j in 0..n {
            let h = SLOPE * scales[j];
            let (mut low, mut high) = (at.clone(), at.clone());
            low[j] -= h;
            high[j] += h;
            let column = (self.end(&high)? - self.end(&low)?) / (2.0 * h);
            slope.set_column(j, &column);
        }
        Some(slope)
    }
}

/// The cycle near a pattern.
fn solve(servo: &Servo, size: f64, pattern: &[Stand]) -> Option<HuntingCycle> {
    let last = pattern.last()?;
    let rough = cycle_of(pattern);
    let amplitude = rough.motor_amplitude;
    let distance = last.place.x - last.place.w;
    let taken = (distance.abs() - servo.half_gap).abs() <= 1e-9 * amplitude;
    let map = Map {
        servo,
        size,
        ways: pattern[1..].iter().map(|s| s.way).collect(),
        no_integral: (servo.controller.integral == 0.0).then_some(last.place.integral),
        taken_up: taken.then_some(distance),
    };
    let scales = map.free([
        amplitude,
        servo.controller.proportional * amplitude,
        amplitude,
    ]);
    let scales = scales.as_slice();
    let mut at = map.vector(&last.place);
    let n = at.len();
    for _ in 0..MAX_NEWTON {
        let slope = map.slope(&at, scales)?;
        let residual = map.end(&at)? - &at;
        let step = (DMatrix::identity(n, n) - &slope).lu().solve(&residual)?;
        at += &step;
        let moved = step.iter().zip(scales).map(|(s, scale)| (s / scale).abs());
        let moved = moved.fold(0.0, f64::max);
        if !moved.is_finite() || moved > 1.0 {
            return None;
        }
        if moved < DONE {
            let mut cycle = cycle_of(&map.period(&at)?);
            let values = nalgebra::Schur::try_new(slope, 1e-14, 10_000)?.complex_eigenvalues();
            let largest = values.iter().fold(0.0_f64, |m, v| v.norm().max(m));
            cycle.multiplier = Some(largest);
            cycle.stable = ((largest - 1.0).abs() > NEUTRAL).then_some(largest < 1.0);
            return Some(cycle);
        }
    }
    None
}
