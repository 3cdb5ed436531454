//! The cycle in which a loop ends.
//!
//! A run shows its pattern: positions, and why each ends. Newton's method then finds the state and the durations that
//! repeat exactly, `x(T) = x(0)` with `C x = threshold` at each switch that a crossing causes; those that a clock
//! causes are known. A replay checks that the controller switches then and only then.

use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

use super::course::Course;
use super::pattern::Pattern;
use super::plant::Motion;
use super::relay::Position;
use super::run::{OnOffLoop, Switch};
use super::stability::multiplier;
use crate::message::{Message, fixed};
use crate::msg;
use crate::plant::MAX_ORDER;
use crate::simulate::{SimulateError, State};

/// A limit cycle of an on-off loop.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct OnOffCycle {
    /// Period, s.
    pub period: f64,
    /// Half of peak to peak, in the unit of the output.
    pub amplitude: f64,
    /// Smallest and largest output.
    pub range: [f64; 2],
    /// Positions with their durations in s, in the order of the cycle.
    pub positions: Vec<(Position, f64)>,
    /// Largest modulus of the eigenvalues of the map from one period to the next: what is left of a small disturbance.
    /// `None` where the output only touches a threshold.
    pub multiplier: Option<f64>,
    /// Whether small disturbances die out; `None` where it is not known.
    pub stable: Option<bool>,
}

/// What becomes of a loop.
#[derive(Clone, Debug, PartialEq)]
pub struct Settled {
    /// The cycle to which the run comes.
    pub simulated: Option<OnOffCycle>,
    /// The same to round-off, with its stability.
    pub exact: Option<OnOffCycle>,
    /// The position in which the controller stays for ever, where it does.
    pub rests: Option<Position>,
    /// The answer in a sentence.
    pub text: Message,
}

/// Switches after which a pattern is looked for, each time four times as many.
const FIRST_LOOK: usize = 40;
const LOOKS: usize = 5;

/// Typical times of the loop without a switch after which it is said to rest.
const LONG: f64 = 400.0;

/// Most positions of a pattern.
const LONGEST_PATTERN: usize = 24;

/// Share by which cycles may differ that are taken for the same: to begin Newton's method, and to be called settled.
const ALIKE: f64 = 1e-3;
const SETTLED: f64 = 1e-6;

/// Newton's method: steps, and the share of the period below which it is done.
const MAX_NEWTON: usize = 40;
const DONE: f64 = 1e-13;

/// Share of the period by which the replay may be off.
const REPLAY: f64 = 1e-7;

/// A multiplier this near 1 decides nothing.
const NEUTRAL: f64 = 1e-9;

/// Follows a loop until it repeats itself or rests, and finds its cycle exactly.
///
/// # Errors
/// What is wrong with the loop.
pub fn settled(loop_: &OnOffLoop) -> Result<Settled, SimulateError> {
    loop_.validate()?;
    let relay = &loop_.relay;
    let time = loop_.plant.typical_time()
        + loop_.lag()
        + relay.min_on
        + relay.min_off
        + loop_.clock().unwrap_or(0.0);
    let motion = loop_.plant.motion(10.0 * time);
    let x = loop_
        .initial
        .as_ref()
        .map_or([0.0; MAX_ORDER], |x| motion.inner(x));
    let most = FIRST_LOOK << (2 * LOOKS);
    let mut course = Course::new(loop_, &motion, x, most);
    let mut pattern = None;
    let mut exact = None;
    for look in 0..LOOKS {
        let wanted = FIRST_LOOK << (2 * look);
        while course.out.switches.len() < wanted && course.out.cut.is_none() {
            let before = course.out.switches.len();
            course.run(course.now + LONG * time);
            if course.out.switches.len() == before {
                return Ok(rest(&course));
            }
        }
        let switches = &course.out.switches;
        if let Some(found) = repeated(switches, ALIKE) {
            let solved = Pattern::of(loop_, &motion, found);
            exact = solved.and_then(|p| p.solve(&state_at(loop_, &motion, x, found)));
        }
        pattern = repeated(switches, SETTLED).map(simulated);
        if course.out.cut.is_some() || (pattern.is_some() && exact.is_some()) {
            break;
        }
    }
    if let Some((simulated, exact)) = pattern.as_mut().zip(exact.as_ref()) {
        simulated.judged_by(exact);
    }
    let text = said(pattern.as_ref(), exact.as_ref());
    Ok(Settled {
        simulated: pattern,
        exact,
        rests: None,
        text,
    })
}

fn rest(course: &Course<'_>) -> Settled {
    let last = course.position.name();
    Settled {
        simulated: None,
        exact: None,
        rests: Some(course.position),
        text: msg!(
            "The controller stays {} and no longer switches: no oscillation.",
            last
        ),
    }
}

fn said(simulated: Option<&OnOffCycle>, exact: Option<&OnOffCycle>) -> Message {
    let Some(cycle) = exact.or(simulated) else {
        return "It oscillates in a pattern of many cycles, or in none that repeats.".into();
    };
    let [low, high] = cycle.range;
    let switches = cycle.positions.len();
    let stable = match cycle.stable {
        Some(true) => "It is stable.",
        Some(false) => "It is not stable.",
        None if exact.is_some() => "A small change of the start leads to a different one.",
        None => "",
    };
    msg!(
        "It oscillates between {} and {} with a period of {} s and {} switches in each.",
        fixed(low, 4),
        fixed(high, 4),
        fixed(cycle.period, 4),
        switches
    )
    .and(stable)
}

/// The last whole pattern of a run, with the switch at its begin before it.
fn repeated(switches: &[Switch], tolerance: f64) -> Option<&[Switch]> {
    (1..=LONGEST_PATTERN).find_map(|length| {
        let from = switches.len().checked_sub(2 * length + 1)?;
        let part = &switches[from..];
        let period = part[2 * length].time - part[length].time;
        let same = (1..=length).all(|i| {
            let (a, b) = (&part[i], &part[i + length]);
            let durations = [a, b]
                .map(|s| s.time) // from the switch before
                .into_iter()
                .zip([part[i - 1].time, part[i + length - 1].time])
                .map(|(end, begin)| end - begin)
                .collect::<Vec<_>>();
            let reach = (b.swing[1] - b.swing[0]).max(a.swing[1] - a.swing[0]);
            let alike = |a: f64, b: f64, size: f64| (a - b).abs() <= tolerance * size;
            a.to == b.to
                && a.cause == b.cause
                && alike(durations[0], durations[1], period)
                && alike(a.swing[0], b.swing[0], reach)
                && alike(a.swing[1], b.swing[1], reach)
        });
        same.then(|| &part[length..])
    })
}

/// The cycle as a run shows it.
fn simulated(switches: &[Switch]) -> OnOffCycle {
    let positions = switches
        .windows(2)
        .map(|pair| (pair[0].to, pair[1].time - pair[0].time))
        .collect();
    OnOffCycle::new(positions, range(&switches[1..]))
}

fn range(switches: &[Switch]) -> [f64; 2] {
    let all = switches.iter().map(|s| s.swing);
    all.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], s| {
        [low.min(s[0]), high.max(s[1])]
    })
}

impl OnOffCycle {
    fn new(positions: Vec<(Position, f64)>, range: [f64; 2]) -> Self {
        Self {
            period: positions.iter().map(|p| p.1).sum(),
            amplitude: 0.5 * (range[1] - range[0]),
            range,
            positions,
            multiplier: None,
            stable: None,
        }
    }

    /// Takes the stability of the exact cycle, if that is the one that the run repeats.
    fn judged_by(&mut self, exact: &Self) {
        let alike = |a: f64, b: f64| (a - b).abs() <= ALIKE * b;
        if alike(self.period, exact.period) && alike(self.amplitude, exact.amplitude) {
            (self.multiplier, self.stable) = (exact.multiplier, exact.stable);
        }
    }
}

/// The state in which a run from `x` switched first in the pattern.
fn state_at(loop_: &OnOffLoop, motion: &Motion, x: State, pattern: &[Switch]) -> State {
    let mut course = Course::new(loop_, motion, x, usize::MAX);
    course.run(pattern[0].time);
    course.x
}

impl Pattern<'_> {
    /// The cycle near a state at the begin of the pattern.
    fn solve(mut self, near: &State) -> Option<OnOffCycle> {
        let n = self.loop_.plant.order();
        let free: Vec<usize> = (0..self.causes.len())
            .filter(|i| self.threshold(*i).is_some())
            .collect();
        let (mut x, mut h) = (*near, self.durations.clone());
        let mut calm = 0;
        for _ in 0..MAX_NEWTON {
            let residual = self.residual(&h, &x)?;
            let period: f64 = h.iter().sum();
            let size = residual.len();
            let mut jacobian = DMatrix::zeros(size, size);
            for j in 0..size {
                let (mut moved, mut durations) = (x, h.clone());
                // The states enter linearly; a difference is good enough for the slope in time.
                let difference = match j.checked_sub(n) {
                    None => {
                        moved[j] += 1.0;
                        1.0
                    }
                    Some(k) => {
                        durations[free[k]] += 1e-6 * period;
                        1e-6 * period
                    }
                };
                let column = (self.residual(&durations, &moved)? - &residual) / difference;
                jacobian.set_column(j, &column);
            }
            let step = jacobian.lu().solve(&residual)?;
            let mut share = 1.0;
            for (k, i) in free.iter().enumerate() {
                while h[*i] - share * step[n + k] <= 0.1 * h[*i] && share > 1e-3 {
                    share *= 0.5;
                }
            }
            for i in 0..n {
                x[i] -= share * step[i];
            }
            for (k, i) in free.iter().enumerate() {
                h[*i] -= share * step[n + k];
            }
            let moved = step.iter().skip(n).fold(0.0_f64, |m, s| m.max(s.abs()));
            if !step.iter().all(|s| s.is_finite()) || h.iter().any(|h| *h <= 0.0) {
                return None;
            }
            // The second small step takes the state along to round-off as well.
            calm = if moved <= DONE * period { calm + 1 } else { 0 };
            if calm == 2 {
                self.durations = h;
                return self.replayed(&x);
            }
        }
        None
    }

    /// Replays one period: whether the switches are those of the pattern, and how far the output swings.
    fn replayed(&self, x: &State) -> Option<OnOffCycle> {
        let period: f64 = self.durations.iter().sum();
        let (u, arrivals) = self.arrivals(&self.durations);
        let mut begin = 0.0;
        let mut on_their_way = Vec::new();
        let lag = self.loop_.lag();
        for duration in &self.durations {
            // When this position began in the periods before.
            let mut past = begin;
            while past > -lag {
                if past <= 0.0 {
                    on_their_way.push(past + lag);
                }
                past -= period;
            }
            begin += duration;
        }
        let count = on_their_way.len();
        let pending: Vec<(f64, f64)> = if count == 0 {
            Vec::new()
        } else {
            on_their_way.sort_by(f64::total_cmp);
            let values = arrivals.iter().map(|a| a.value).cycle();
            on_their_way.into_iter().zip(values).collect()
        };
        let course = Course::new(self.loop_, self.motion, *x, 2 * self.positions.len() + 2);
        let mut course = course.just_switched(self.positions[0], u, &pending);
        course.run(period * (1.0 + REPLAY));
        let switches = &course.out.switches;
        let mut end = 0.0;
        for (i, duration) in self.durations.iter().enumerate() {
            end += duration;
            let switch = switches.get(i)?;
            let to = self.positions[(i + 1) % self.positions.len()];
            if switch.to != to || (switch.time - end).abs() > REPLAY * period {
                return None;
            }
        }
        let positions = self.positions.iter().copied();
        let positions: Vec<_> = positions.zip(self.durations.iter().copied()).collect();
        let mut cycle = OnOffCycle::new(positions, range(switches.get(..self.durations.len())?));
        cycle.multiplier = multiplier(self, &self.durations, &self.states(&self.durations, x));
        cycle.stable = cycle
            .multiplier
            .filter(|m| (m - 1.0).abs() > NEUTRAL)
            .map(|m| m < 1.0);
        Some(cycle)
    }
}
