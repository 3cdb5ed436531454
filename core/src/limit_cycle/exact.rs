//! Exact limit cycles, equation (3): no harmonic is neglected.
//!
//! Between switches the state moves by matrix exponentials, so that a cycle with one rise and one fall of
//! the relay is a root of a few smooth equations (Tsypkin 1984; Åström 1995). Every root is then
//! replayed for one period: only those whose first crossings are the assumed ones are cycles.

use nalgebra::{DMatrix, DVector};

use super::MAX_INTERSECTIONS;
use super::cycle::Cycle;
use super::history::History;
use super::stability;
use crate::plant::StateSpace;
use crate::relay::Relay;
use crate::root::illinois;
use crate::simulate::{Change, Engine, Flow, State};

/// An exact limit cycle with one rise and one fall per period.
#[derive(Clone, Debug, PartialEq)]
pub struct ExactCycle {
    /// Period, amplitude (half of peak to peak) and stability.
    pub cycle: Cycle,
    /// Time with `h = +1`, then with `h = -1`, s.
    pub durations: [f64; 2],
    /// Smallest and largest output.
    pub range: [f64; 2],
    /// State of the plant when the relay rises.
    pub start: DVector<f64>,
    /// Largest modulus of the multipliers of the Poincare map over one period; below 1 small
    /// disturbances die out, at 1 to round-off they stay.
    pub multiplier: Option<f64>,
}

/// Ratio of neighbouring half periods in a scan.
const SCAN_RATIO: f64 = 1.02;

/// Scanned half periods reach from the guess divided to the guess multiplied by this.
const SCAN_REACH: f64 = 5.0;

/// Step of the scan as share of the distance of neighbouring cycles of a long delay.
const FAMILY_STEP: f64 = 0.25;

/// Share of the period to which the replay must meet the switches that were assumed.
const REPLAY: f64 = 1e-7;

/// A Newton step below this share of the period ends the search.
const NEWTON_DONE: f64 = 1e-13;

/// Most Newton steps; from a close guess five are usual.
const MAX_NEWTON: usize = 40;

/// Smallest step of the way from a symmetric relay to an asymmetric one.
const SMALLEST_STEP: f64 = 1.0 / 256.0;

/// Multipliers this close to 1 do not tell whether a disturbance dies out: several half periods within a delay that is
/// far longer than all that the plant does just come round again, but for round-off.
const NEUTRAL: f64 = 1e-12;

/// Switches of the run that looks for an asymmetric cycle where continuation fails.
const SEARCH_SWITCHES: usize = 400;

/// The exact limit cycle nearest to the half period `guess` in s, for any relay; `lag` is the relay's
/// delay and the dead time in s. `None` where there is no cycle with two switches a period.
///
/// A symmetric relay has the symmetric cycle (both durations the same). An asymmetric one is reached
/// from it by continuation in the mean output, or else from a simulation.
pub fn exact_cycle(plant: &StateSpace, relay: &Relay, lag: f64, guess: f64) -> Option<ExactCycle> {
    let search = Search::new(plant, relay, lag, guess)?;
    if relay.is_symmetric() {
        return search.symmetric(relay);
    }
    search.asymmetric(relay)
}

/// All symmetric cycles with half periods between a fifth and five times `guess` s, shortest first; for an
/// asymmetric relay those that continue them.
pub fn exact_cycles(plant: &StateSpace, relay: &Relay, lag: f64, guess: f64) -> Vec<ExactCycle> {
    let Some(search) = Search::new(plant, relay, lag, guess) else {
        return Vec::new();
    };
    let even = centred(relay, 0.0);
    let symmetric: Vec<ExactCycle> = search
        .roots(&even)
        .into_iter()
        .filter_map(|h| search.finish(&even, [h, h], search.start(&even, h)?))
        .filter(|c| c.cycle.stable != Some(false) || c.durations[0] >= search.least_of_family())
        .collect();
    if relay.is_symmetric() {
        return symmetric;
    }
    let mut found: Vec<ExactCycle> = symmetric
        .iter()
        .filter_map(|c| search.continued(relay, c))
        .collect();
    if found.is_empty() {
        found.extend(search.simulated(relay));
    }
    found.dedup_by(|a, b| (a.cycle.period / b.cycle.period - 1.0).abs() < REPLAY);
    found
}

/// Half periods of which [`continuum`] looks at the balance, as multiples of the guess.
const TRIED: [f64; 7] = [0.2, 0.4, 0.7, 1.0, 1.6, 2.5, 5.0];

/// Balance, as share of the swing, that is none but round-off.
const BALANCED: f64 = 1e-10;

/// Cycles of a loop in which every half period balances, so that each start has its own cycle: examples at half, once
/// and twice the half period `guess` in s. `None` for any other loop.
///
/// `1/s^2` under an ideal relay is one: period `4 sqrt(2a/k)` at any amplitude `a`.
pub(super) fn continuum(
    plant: &StateSpace,
    relay: &Relay,
    lag: f64,
    guess: f64,
) -> Option<Vec<Cycle>> {
    let search = Search::new(plant, relay, lag, guess)?;
    if !relay.is_symmetric() {
        return None;
    }
    let balances = |h: f64| {
        let Some(x) = search.start(relay, h) else {
            return false;
        };
        let middle = search.after(relay, [h, h], &x, 0.5 * h);
        let swing = middle.map_or(0.0, |m| search.flow.output(&m, 0).abs());
        search.balance(relay, h).abs() <= BALANCED * swing
    };
    if !TRIED.iter().all(|share| balances(share * guess)) {
        return None;
    }
    let example = |share: f64| {
        let h = share * guess;
        let cycle = search.finish(relay, [h, h], search.start(relay, h)?)?.cycle;
        Some(Cycle {
            stable: None,
            ..cycle
        })
    };
    Some([0.5, 1.0, 2.0].into_iter().filter_map(example).collect())
}

/// The exact limit cycle into which a simulation from rest settles, if it does; `guess` in s is the half period by
/// which the length of the run goes.
pub(super) fn settled_cycle(
    plant: &StateSpace,
    relay: &Relay,
    lag: f64,
    guess: f64,
) -> Option<ExactCycle> {
    Search::new(plant, relay, lag, guess)?.simulated(relay)
}

/// The exact symmetric limit cycle, equation (3), near the half period `guess` in s; `None` where
/// there is none with the relay's first crossing at its end.
///
/// With half period `h` and total delay `L = m h + L'`, `0 <= L' < h`, the state at an upward switch
/// obeys `(I + e^{Ah}) x0 = (-1)^m k [G(h-L') - e^{A(h-L')} G(L')]`, `C x0 = eps`. Asymmetry and bias are
/// left out.
pub fn exact_symmetric(plant: &StateSpace, relay: &Relay, lag: f64, guess: f64) -> Option<Cycle> {
    let even = centred(relay, 0.0);
    let search = Search::new(plant, &even, lag, guess)?;
    Some(search.symmetric(&even)?.cycle)
}

/// The same relay with the mean of its outputs at `mean`.
fn centred(relay: &Relay, mean: f64) -> Relay {
    Relay {
        asymmetry: 0.0,
        bias: mean,
        ..*relay
    }
}

struct Search {
    flow: Flow,
    lag: f64,
    guess: f64,
}

impl Search {
    fn new(plant: &StateSpace, relay: &Relay, lag: f64, guess: f64) -> Option<Self> {
        let positive = |v: f64| v.is_finite() && v > 0.0;
        if plant.validate().is_err()
            || relay.validate().is_err()
            || !positive(guess)
            || !(lag == 0.0 || positive(lag))
        {
            return None;
        }
        Some(Self {
            flow: Flow::single(plant, 2.0 * guess),
            lag,
            guess,
        })
    }

    /// State at the rise of a symmetric cycle of half period `h`: `(I + e^{Ah}) x0 = -x(h; x0 = 0)`.
    fn start(&self, relay: &Relay, h: f64) -> Option<State> {
        let forced = self.after(relay, [h, h], &[0.0; crate::plant::MAX_ORDER], h)?;
        let columns = self.flow.transition(h);
        let n = self.flow.n;
        let map = DMatrix::from_fn(n, n, |i, j| columns[j][i] + if i == j { 1.0 } else { 0.0 });
        let right = DVector::from_fn(n, |i, _| -forced[i]);
        let x = map.lu().solve(&right)?;
        let mut start = [0.0; crate::plant::MAX_ORDER];
        for (s, x) in start.iter_mut().zip(x.iter()) {
            *s = *x;
        }
        start.iter().all(|v| v.is_finite()).then_some(start)
    }

    /// How far the output at the assumed rise lies above the threshold.
    fn balance(&self, relay: &Relay, h: f64) -> f64 {
        self.start(relay, h)
            .map_or(f64::NAN, |x| self.flow.output(&x, 0) - relay.hysteresis)
    }

    /// State `t` s after the rise, `t` at most one period, the input being that of the cycle.
    fn after(&self, relay: &Relay, durations: [f64; 2], x: &State, t: f64) -> Option<State> {
        let history = History::new(relay, durations, self.lag)?;
        let mut x = *x;
        let (mut now, mut u) = (0.0, history.input);
        let ahead = durations[0] + self.lag;
        let fall = Change {
            time: ahead,
            channel: 0,
            value: relay.output(false),
        };
        for change in history.pending.iter().chain([&fall]) {
            if change.time >= t {
                break;
            }
            x = self.flow.after(&x, &[u], change.time - now);
            (now, u) = (change.time, change.value);
        }
        Some(self.flow.after(&x, &[u], t - now))
    }

    /// Half periods that balance, near ones of the guess in both directions.
    fn roots(&self, relay: &Relay) -> Vec<f64> {
        let mut found = Vec::new();
        let mut low = {
            let h = self.guess / SCAN_REACH;
            (h, self.balance(relay, h))
        };
        while low.0 < self.guess * SCAN_REACH {
            let h = low.0 + self.scan_step(low.0);
            let high = (h, self.balance(relay, h));
            found.extend(self.root(relay, low, high));
            low = high;
        }
        found
    }

    /// Step of the scan from the half period `h`: a delay has cycles about `h^2/delay` apart, of which none may be
    /// missed.
    fn scan_step(&self, h: f64) -> f64 {
        let step = (SCAN_RATIO - 1.0) * h;
        if h < self.least_of_family() {
            step
        } else {
            step.min(FAMILY_STEP * h * h / self.lag)
        }
    }

    /// Half period of the shortest unstable cycle of a dead time that is reported, s: there are infinitely many.
    fn least_of_family(&self) -> f64 {
        self.lag / (2 * MAX_INTERSECTIONS) as f64
    }

    /// The root between two half periods, if the balance changes sign there without a jump.
    fn root(&self, relay: &Relay, low: (f64, f64), high: (f64, f64)) -> Option<f64> {
        if !(low.1.is_finite() && high.1.is_finite()) || (low.1 < 0.0) == (high.1 < 0.0) {
            return None;
        }
        let h = illinois(low, high, |h| self.balance(relay, h));
        // A jump of the balance (where the delay passes a multiple of h) is no root.
        let size = low.1.abs() + high.1.abs() + relay.hysteresis;
        (self.balance(relay, h).abs() <= 1e-7 * size).then_some(h)
    }

    /// The symmetric cycle nearest to the guess: intervals on either side, nearest first.
    fn symmetric(&self, relay: &Relay) -> Option<ExactCycle> {
        let count = (libm::log(SCAN_REACH) / libm::log(SCAN_RATIO)).ceil() as i32;
        let at = |i: i32| {
            let h = self.guess * SCAN_RATIO.powi(i);
            (h, self.balance(relay, h))
        };
        let (mut below, mut above) = (at(0), at(0));
        for i in 1..=count {
            let (next_below, next_above) = (at(-i), at(i));
            for (low, high) in [(next_below, below), (above, next_above)] {
                let found = self
                    .root(relay, low, high)
                    .and_then(|h| self.finish(relay, [h, h], self.start(relay, h)?));
                if found.is_some() {
                    return found;
                }
            }
            (below, above) = (next_below, next_above);
        }
        None
    }

    /// The cycle of an asymmetric relay.
    fn asymmetric(&self, relay: &Relay) -> Option<ExactCycle> {
        self.symmetric(&centred(relay, 0.0))
            .and_then(|c| self.continued(relay, &c))
            .or_else(|| self.simulated(relay))
    }

    /// Follows a cycle of the symmetric relay to the asymmetric one.
    fn continued(&self, relay: &Relay, from: &ExactCycle) -> Option<ExactCycle> {
        let mean = relay.mean_output();
        let (mut durations, mut x) = (from.durations, self.flow.inner(&from.start));
        let (mut done, mut step) = (0.0_f64, 1.0_f64);
        while done < 1.0 {
            let next = (done + step).min(1.0);
            if let Some(found) = self.newton(&centred(relay, mean * next), durations, &x) {
                (durations, x) = found;
                done = next;
                step *= 2.0;
            } else {
                step *= 0.5;
                if step < SMALLEST_STEP {
                    return None;
                }
            }
        }
        self.finish(relay, durations, x)
    }

    /// Starts from where a simulation has gone.
    fn simulated(&self, relay: &Relay) -> Option<ExactCycle> {
        let at_rest = [0.0; crate::plant::MAX_ORDER];
        let first = self
            .flow
            .after(&at_rest, &[relay.output(false)], 0.01 * self.guess);
        let run = |end: f64| {
            let mut engine =
                Engine::new(&self.flow, &[*relay], &[self.lag], first, SEARCH_SWITCHES);
            engine.run(end);
            engine
        };
        let long = run(self.guess * SEARCH_SWITCHES as f64);
        let trajectory = long.trajectory(0)?;
        let [.., earlier, last] = trajectory.rises.as_slice() else {
            return None;
        };
        let fall = trajectory.falls.iter().rev().find(|t| *t < last)?;
        let durations = [fall - earlier, last - fall];
        let x = run(*last).x;
        let (durations, x) = self.newton(relay, durations, &x)?;
        self.finish(relay, durations, x)
    }

    /// Newton's method for state and durations: `x(T) = x0`, `C x0 = eps`, `C x(h1) = -eps`. It needs
    /// no inverse of `I - e^{AT}`, so that integrators are no special case.
    fn newton(&self, relay: &Relay, mut h: [f64; 2], x: &State) -> Option<([f64; 2], State)> {
        let n = self.flow.n;
        let mut x = *x;
        let mut calm = 0;
        for _ in 0..MAX_NEWTON {
            let residual = self.residual(relay, h, &x)?;
            let period = h[0] + h[1];
            let (whole, part) = (self.flow.transition(period), self.flow.transition(h[0]));
            let row = self.flow.row(0);
            let mut jacobian = DMatrix::zeros(n + 2, n + 2);
            for j in 0..n {
                for i in 0..n {
                    jacobian[(i, j)] = whole[j][i] - if i == j { 1.0 } else { 0.0 };
                }
                jacobian[(n, j)] = row[j];
                jacobian[(n + 1, j)] = self.flow.output(&part[j], 0);
            }
            // A difference is good enough for the slope: it only sets the speed of convergence.
            let difference = 1e-6 * period;
            for k in 0..2 {
                let mut shifted = h;
                shifted[k] += difference;
                let moved = self.residual(relay, shifted, &x)?;
                for i in 0..n + 2 {
                    jacobian[(i, n + k)] = (moved[i] - residual[i]) / difference;
                }
            }
            let step = jacobian.lu().solve(&residual)?;
            let mut share = 1.0;
            for k in 0..2 {
                while h[k] - share * step[n + k] <= 0.1 * h[k] && share > 1e-3 {
                    share *= 0.5;
                }
            }
            for (x, s) in x.iter_mut().zip(step.iter()).take(n) {
                *x -= share * s;
            }
            for k in 0..2 {
                h[k] -= share * step[n + k];
            }
            if !h.iter().all(|h| h.is_finite() && *h > 0.0) {
                return None;
            }
            let moved = step[n].abs().max(step[n + 1].abs());
            // The second small step takes the state along to round-off as well.
            calm = if moved < NEWTON_DONE * period {
                calm + 1
            } else {
                0
            };
            if calm == 2 || (calm == 1 && moved == 0.0) {
                return Some((h, x));
            }
        }
        None
    }

    fn residual(&self, relay: &Relay, h: [f64; 2], x: &State) -> Option<DVector<f64>> {
        let n = self.flow.n;
        let end = self.after(relay, h, x, h[0] + h[1])?;
        let middle = self.after(relay, h, x, h[0])?;
        let residual = DVector::from_fn(n + 2, |i, _| match i.checked_sub(n) {
            None => end[i] - x[i],
            Some(0) => self.flow.output(x, 0) - relay.hysteresis,
            Some(_) => self.flow.output(&middle, 0) + relay.hysteresis,
        });
        residual.iter().all(|v| v.is_finite()).then_some(residual)
    }

    /// Replays one period: whether the switches are the first ones, and how far the output swings.
    fn finish(&self, relay: &Relay, durations: [f64; 2], x: State) -> Option<ExactCycle> {
        let period = durations[0] + durations[1];
        let history = History::new(relay, durations, self.lag)?;
        let mut engine = Engine::new(&self.flow, &[*relay], &[self.lag], x, 4);
        engine.set(0, true, history.input, &history.pending);
        engine.watch();
        engine.run(period * (1.0 - REPLAY));
        let switches = engine.trajectory(0)?;
        let [fall] = switches.falls.as_slice() else {
            return None;
        };
        if !switches.rises.is_empty() || (fall - durations[0]).abs() > REPLAY * period {
            return None;
        }
        let range = engine.swing(0)?;
        let at_fall = self.after(relay, durations, &x, durations[0])?;
        let at_end = self.after(relay, durations, &x, period)?;
        let multiplier = stability::multiplier(
            &self.flow,
            relay,
            self.lag,
            durations,
            &history,
            [&at_fall, &at_end],
        );
        Some(ExactCycle {
            cycle: Cycle {
                period,
                amplitude: 0.5 * (range[1] - range[0]),
                stable: multiplier
                    .filter(|m| (m - 1.0).abs() > NEUTRAL)
                    .map(|m| m < 1.0),
            },
            durations,
            range,
            start: self.flow.outer(&x),
            multiplier,
        })
    }
}
