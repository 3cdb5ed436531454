//! What becomes of a loop, by a run that is as long as it takes.

use std::f64::consts::PI;

use nalgebra::DVector;
use num_complex::Complex;

use super::divergence::UnstableModes;
use super::existence::ON_AXIS;
use super::noisy::{NoisyCycle, noisy_cycle};
use super::pattern::{self, OneCycle, SAME_CYCLE};
use super::{Cycle, ExactCycle, Outcome, Prediction, dominant, typical_frequency, words};
use crate::message::Message;
use crate::plant::{MAX_ORDER, StateSpace, TransferFunction};
use crate::relay::Relay;
use crate::simulate::{Cut, Engine, Flow, Noise, Options, SimulateError, Sliding, Trajectory};

/// A loop whose outcome is asked for.
#[derive(Clone, Debug)]
pub struct LongRun<'a> {
    /// The plant, for its poles and dead time.
    pub plant: &'a TransferFunction,
    /// The same without dead time.
    pub space: &'a StateSpace,
    /// The relay.
    pub relay: &'a Relay,
    /// State at the start; at rest if `None`, an ideal relay without delay after `push` s of upward push.
    pub initial: Option<&'a DVector<f64>>,
    /// Duration of that push, s.
    pub push: f64,
    /// Measurement noise.
    pub noise: Option<Noise>,
}

/// What became of it.
#[derive(Clone, Debug, PartialEq)]
pub struct LongRunResult {
    /// In a word; `None` where a part of the plant is so fast that no run is long enough.
    pub outcome: Option<Outcome>,
    /// Period and amplitude in the end; means with noise.
    pub cycle: Option<Cycle>,
    /// Standard deviations of period (s) and amplitude from cycle to cycle, with noise.
    pub scatter: Option<[f64; 2]>,
    /// How long the output slides along the threshold in each cycle, s: the relay is then not one of two levels.
    pub slides: f64,
    /// In a sentence or two.
    pub text: Message,
}

/// Typical periods of the first part of a run; each further part doubles the whole.
const FIRST_PERIODS: f64 = 20.0;

/// Slowest time constants after which a plant with a constant input has come to rest: `e^-20` is 2e-9.
const REST_CONSTANTS: f64 = 20.0;

/// Switches after which a run is given up, and after which the one that takes its place is where nothing was seen: what
/// leaves an unstable cycle by a ten-thousandth a period takes tens of thousands.
const MOST_SWITCHES: [usize; 2] = [20_000, 200_000];

/// Parts of a run, each as long as all before: enough for ten million typical periods.
const MOST_PARTS: usize = 20;

/// Cycles of a run in noise.
const NOISY_CYCLES: f64 = 60.0;

/// Noise values that such a run takes at most: each takes a microsecond or two.
const MOST_NOISE: f64 = 500_000.0;

/// Samples in a cycle of it.
const NOISY_SAMPLES: f64 = 64.0;

impl LongRun<'_> {
    /// Runs the loop until its outcome shows; `prediction` says which cycles there are.
    ///
    /// # Errors
    /// What is wrong with the noise.
    pub fn run(&self, prediction: &Prediction) -> Result<LongRunResult, SimulateError> {
        let period = self.typical_period(prediction);
        if let Some(noise) = self.noise {
            self.check(noise)?;
            return Ok(self.run_noisy(noise, period, prediction));
        }
        let flow = Flow::single(self.space, FIRST_PERIODS * period);
        let view = View::new(self, prediction);
        for (i, switches) in MOST_SWITCHES.into_iter().enumerate() {
            let is_last = i + 1 == MOST_SWITCHES.len();
            if let Some(result) = self.run_once(&flow, period, switches, &view, is_last) {
                return Ok(result);
            }
        }
        Ok(LongRunResult::of(None, words::too_slow()))
    }

    /// One run with at most so many switches; `None` where they do not show the outcome and more may.
    fn run_once(
        &self,
        flow: &Flow,
        period: f64,
        switches: usize,
        view: &View<'_>,
        is_last: bool,
    ) -> Option<LongRunResult> {
        let mut engine = self.engine(flow, period, switches);
        let mut end = FIRST_PERIODS * period;
        for part in 1..=MOST_PARTS {
            let goes_on = engine.run(end);
            let seen = Seen {
                run: engine.trajectory(0)?,
                slides: engine.slides_since(),
                time: end,
                state: flow.outer(&engine.x),
                last: part == MOST_PARTS || (is_last && !goes_on),
            };
            let result = view.judge(&seen);
            if result.is_some() || !goes_on {
                return result;
            }
            end *= 2.0;
        }
        None
    }

    fn lag(&self) -> f64 {
        self.plant.dead_time + self.relay.delay
    }

    /// The stable exact cycle's period, or else what the describing function or the plant shows, s.
    fn typical_period(&self, prediction: &Prediction) -> f64 {
        let exact = prediction.exact.iter();
        let stable = exact
            .filter(|c| c.cycle.stable == Some(true))
            .map(|c| c.cycle.period);
        stable
            .reduce(f64::max)
            .or_else(|| dominant(&prediction.describing_function).map(|i| i.cycle.period))
            .unwrap_or_else(|| 2.0 * PI / typical_frequency(self.plant) + 2.0 * self.lag())
    }

    fn engine<'f>(&self, flow: &'f Flow, period: f64, switches: usize) -> Engine<'f> {
        let stuck = self.relay.hysteresis == 0.0 && self.lag() == 0.0;
        let mut x = self.initial.map_or([0.0; MAX_ORDER], |x| flow.inner(x));
        if stuck && self.initial.is_none() {
            x = flow.after(&x, &[self.relay.output(false)], self.push);
        }
        let mut engine = Engine::new(flow, &[*self.relay], &[self.lag()], x, switches);
        if stuck {
            engine.allow_sliding(Sliding::new(self.space, flow, FIRST_PERIODS * period));
        }
        engine
    }

    /// Whether the noise can be.
    fn check(&self, noise: Noise) -> Result<(), SimulateError> {
        let duration = if noise.interval > 0.0 {
            noise.interval
        } else {
            1.0
        };
        let options = Options {
            noise: Some(noise),
            step: None,
            ..Options::new(duration, duration)
        };
        options.check(self.space.b.len())
    }

    fn run_noisy(&self, noise: Noise, period: f64, prediction: &Prediction) -> LongRunResult {
        let duration = (NOISY_CYCLES * period).min(MOST_NOISE * noise.interval);
        let flow = Flow::single(self.space, period);
        let mut engine = self.engine(&flow, period, MOST_SWITCHES[1]);
        engine.add_noise(noise);
        let step = period / NOISY_SAMPLES;
        engine.sample_every(step);
        let unstable = UnstableModes::new(self.space, &self.plant.poles(), self.relay);
        let mut end = 0.0;
        let mut goes_on = true;
        while goes_on && end < duration {
            end += period;
            goes_on = engine.run(end);
            if unstable.is_lost(&flow.outer(&engine.x)) {
                return LongRunResult::of(Some(Outcome::Unbounded), words::unstable());
            }
        }
        let run = engine.finish().into_iter().next().unwrap_or_default();
        if run.cut == Some(Cut::TooFast) {
            return LongRunResult::of(None, words::too_fast());
        }
        let late = run
            .rises
            .iter()
            .chain(&run.falls)
            .filter(|t| **t > 0.5 * end)
            .count();
        if late == 0 {
            return LongRunResult::of(Some(Outcome::Rest), words::rest_in_noise());
        }
        let Some(found) = noisy_cycle(&run) else {
            let text = words::chatter_at_rest(late, 0.5 * end);
            return LongRunResult::of(Some(Outcome::Chatter), text);
        };
        noisy_result(&found, self.relay, noise, prediction)
    }
}

fn noisy_result(
    found: &NoisyCycle,
    relay: &Relay,
    noise: Noise,
    prediction: &Prediction,
) -> LongRunResult {
    let outcome = if found.chatters() {
        Outcome::Chatter
    } else {
        Outcome::NoisyLimitCycle
    };
    LongRunResult {
        outcome: Some(outcome),
        cycle: Some(Cycle {
            period: found.period[0],
            amplitude: found.amplitude[0],
            stable: None,
        }),
        scatter: Some([found.period[1], found.amplitude[1]]),
        slides: 0.0,
        text: words::noisy(found, relay, noise, prediction),
    }
}

impl LongRunResult {
    /// The cycle of which equation (9) speaks: not one of a continuum, of which each has another gain, and none whose
    /// relay slides.
    pub fn of_two_levels(&self) -> Option<Cycle> {
        let told = self.outcome != Some(Outcome::Continuum) && self.slides == 0.0;
        self.cycle.filter(|_| told)
    }

    fn of(outcome: Option<Outcome>, text: Message) -> Self {
        Self {
            outcome,
            cycle: None,
            scatter: None,
            slides: 0.0,
            text,
        }
    }

    fn cycle(
        outcome: Outcome,
        [period, amplitude]: OneCycle,
        stable: Option<bool>,
        text: Message,
    ) -> Self {
        Self {
            cycle: Some(Cycle {
                period,
                amplitude,
                stable,
            }),
            ..Self::of(Some(outcome), text)
        }
    }
}

/// A run so far.
struct Seen<'r> {
    run: &'r Trajectory,
    /// Since when it has been sliding, s.
    slides: Option<f64>,
    time: f64,
    state: DVector<f64>,
    /// Nothing more will be seen.
    last: bool,
}

/// What is known before the run.
struct View<'a> {
    relay: &'a Relay,
    prediction: &'a Prediction,
    unstable: UnstableModes,
    /// All poles lie in the left half plane: a bounded input has a bounded output.
    bounded: bool,
    /// The slowest time constant, s.
    slowest: f64,
    lag: f64,
}

impl<'a> View<'a> {
    fn new(run: &'a LongRun<'_>, prediction: &'a Prediction) -> Self {
        let poles = run.plant.poles();
        let axis = ON_AXIS * poles.iter().map(|p| p.norm()).fold(0.0, f64::max);
        let off_axis: Vec<Complex<f64>> = poles.iter().copied().filter(|p| p.re > axis).collect();
        let rates = poles.iter().map(|p| -p.re);
        Self {
            relay: run.relay,
            prediction,
            unstable: UnstableModes::new(run.space, &off_axis, run.relay),
            bounded: poles.iter().all(|p| p.re < -axis),
            slowest: rates
                .filter(|r| *r > axis)
                .map(|r| 1.0 / r)
                .fold(0.0, f64::max),
            lag: run.lag(),
        }
    }

    /// The outcome, if the run shows it by now.
    fn judge(&self, seen: &Seen<'_>) -> Option<LongRunResult> {
        if seen.run.cut == Some(Cut::TooFast) {
            return Some(LongRunResult::of(None, words::too_fast()));
        }
        let cycles = pattern::cycles(seen.run);
        if self.unstable.is_lost(&seen.state) {
            return Some(LongRunResult::of(
                Some(Outcome::Unbounded),
                words::unstable(),
            ));
        }
        self.at_rest(seen)
            .or_else(|| self.settled(seen, &cycles))
            .or_else(|| self.growing(&cycles))
            .or_else(|| Self::repeating(&cycles))
            .or_else(|| seen.last.then(|| self.in_the_end(seen, &cycles)))
    }

    /// The relay has stopped to switch, or holds the output.
    fn at_rest(&self, seen: &Seen<'_>) -> Option<LongRunResult> {
        if let Some(since) = seen.slides
            && seen.time - since > REST_CONSTANTS * self.slowest + 0.5 * seen.time
        {
            let rests = seen.state.amax() <= SAME_CYCLE * self.relay.gain;
            return Some(LongRunResult::of(
                Some(Outcome::Sliding),
                words::sliding(since, rests),
            ));
        }
        if seen.run.cut == Some(Cut::Chattering) {
            let ideal = self.relay.hysteresis == 0.0 && self.lag == 0.0;
            return Some(if ideal {
                LongRunResult::of(Some(Outcome::Sliding), words::accumulates(seen.run.end()))
            } else {
                LongRunResult::of(Some(Outcome::Chatter), words::chatters())
            });
        }
        let last = seen
            .run
            .rises
            .iter()
            .chain(&seen.run.falls)
            .copied()
            .fold(0.0, f64::max);
        let slid = seen.run.sliding.last().map_or(0.0, |s| s[1]);
        let calm = seen.time - last.max(slid) - self.lag;
        if seen.slides.is_some() || calm < 0.5 * seen.time || calm < REST_CONSTANTS * self.slowest {
            return None;
        }
        let high = seen.run.rises.last() > seen.run.falls.last();
        if self.bounded {
            let level = self
                .prediction
                .existence
                .map(|e| e.equilibria[usize::from(!high)]);
            return Some(LongRunResult::of(
                Some(Outcome::Rest),
                words::rest(level, seen.run.rises.len()),
            ));
        }
        (seen.last && self.relay.output(high) != 0.0)
            .then(|| LongRunResult::of(Some(Outcome::Unbounded), words::held()))
    }

    /// It repeats a cycle that no disturbance takes it away from.
    fn settled(&self, seen: &Seen<'_>, cycles: &[OneCycle]) -> Option<LongRunResult> {
        let last = pattern::settled(cycles)?;
        let stable = match self.exact(&last, SAME_CYCLE) {
            Some(exact) if exact.cycle.stable == Some(false) => return None,
            _ if self.prediction.continuum.is_some() => {
                let text = words::continuum(&last, self.prediction.continuum.as_deref());
                return Some(LongRunResult::cycle(Outcome::Continuum, last, None, text));
            }
            Some(exact) => exact.cycle.stable,
            None => Some(true),
        };
        let mut text = words::limit_cycle(&last, stable, self.prediction);
        let to = seen.run.rises.last().copied().unwrap_or(0.0);
        let overlap = |s: &[f64; 2]| (s[1].min(to) - s[0].max(to - last[0])).max(0.0);
        let slid: f64 = seen.run.sliding.iter().map(overlap).sum();
        if slid > 0.0 {
            text.add(words::slides_within(slid));
        }
        let found = LongRunResult::cycle(Outcome::LimitCycle, last, stable, text);
        Some(LongRunResult {
            slides: slid,
            ..found
        })
    }

    fn growing(&self, cycles: &[OneCycle]) -> Option<LongRunResult> {
        (!self.bounded && pattern::grows(cycles)).then(|| {
            let text = words::grows(cycles);
            LongRunResult::of(Some(Outcome::Unbounded), text)
        })
    }

    fn repeating(cycles: &[OneCycle]) -> Option<LongRunResult> {
        let count = pattern::repeated(cycles)?;
        let pattern = &cycles[cycles.len() - count..];
        // A run that has all but settled repeats patterns of any length.
        let first = pattern.first()?;
        if pattern
            .iter()
            .all(|c| pattern::difference(c, first) < SAME_CYCLE)
        {
            return None;
        }
        let text = words::pattern(pattern);
        let amplitude = pattern.iter().map(|c| c[1]).fold(0.0, f64::max);
        let period = pattern.iter().map(|c| c[0]).sum();
        Some(LongRunResult::cycle(
            Outcome::LongPattern,
            [period, amplitude],
            None,
            text,
        ))
    }

    /// The run is over: what is most like what was seen?
    fn in_the_end(&self, seen: &Seen<'_>, cycles: &[OneCycle]) -> LongRunResult {
        if let Some(since) = seen.slides {
            return LongRunResult::of(Some(Outcome::Sliding), words::sliding(since, false));
        }
        let Some(last) = cycles.last() else {
            return LongRunResult::of(None, words::too_slow());
        };
        let middle = &cycles[cycles.len() / 2];
        let stable = self
            .prediction
            .exact
            .iter()
            .filter(|c| c.cycle.stable != Some(false));
        let nears = |exact: &&ExactCycle| {
            let of = [exact.cycle.period, exact.cycle.amplitude];
            pattern::difference(last, &of) < 0.5 * pattern::difference(middle, &of)
        };
        if let Some(exact) = stable.into_iter().find(nears) {
            let goal = [exact.cycle.period, exact.cycle.amplitude];
            let text = words::limit_cycle(&goal, exact.cycle.stable, self.prediction);
            return LongRunResult::cycle(Outcome::LimitCycle, goal, exact.cycle.stable, text);
        }
        let text = match self.exact(last, NEAR_UNSTABLE) {
            Some(exact) if exact.cycle.stable == Some(false) => words::leaves(exact, cycles),
            _ => words::irregular(cycles),
        };
        LongRunResult::cycle(Outcome::LongPattern, *last, None, text)
    }

    fn exact(&self, cycle: &OneCycle, tolerance: f64) -> Option<&ExactCycle> {
        self.prediction
            .exact
            .iter()
            .find(|c| pattern::difference(cycle, &[c.cycle.period, c.cycle.amplitude]) < tolerance)
    }
}

/// Relative distance from an unstable cycle at which a run that leaves it slowly is still said to do so.
const NEAR_UNSTABLE: f64 = 0.01;
