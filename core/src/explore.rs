//! Everything about one relay loop, for drawing: prediction beside simulation.

use crate::uncertain::brief;
use num_complex::Complex;
use serde::{Deserialize, Serialize};

use crate::limit_cycle::{
    Cycle, ExactCycle, Harmonic, Intersection, LongRun, Outcome, Prediction, Trust, dominant,
    harmonics, predict, typical_frequency,
};
use crate::message::{Message, fixed, says};
use crate::msg;
use crate::plant::{PlantError, StateSpace, TransferFunction, presets};
use crate::relay::{Relay, RelayError};
use crate::simulate::{Noise, Options, SimulateError, Trajectory, run, simulate};
use crate::tuning::{RelayGain, relay_gain};

/// A relay loop.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ExploreInput {
    /// The plant.
    pub plant: TransferFunction,
    /// The relay.
    pub relay: Relay,
    /// Noise on the output that the relay sees; only the simulation knows of it.
    #[serde(default)]
    pub noise: Option<Noise>,
}

impl Default for ExploreInput {
    fn default() -> Self {
        let plant = presets().into_iter().next().map(|p| p.plant);
        Self {
            plant: plant.unwrap_or_else(|| TransferFunction::new(&[1.0], &[1.0, 1.0], 0.0)),
            relay: Relay::default(),
            noise: None,
        }
    }
}

/// Why a loop cannot be computed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ExploreError {
    /// The plant.
    Plant(#[from] PlantError),
    /// The relay.
    Relay(#[from] RelayError),
    /// The noise or the run.
    Simulate(#[from] SimulateError),
    /// A lag beside which the plant is over in no time: what follows it would be computed for minutes.
    Lag {
        /// Dead time and delay, s.
        lag: f64,
        /// The longest that is taken, s.
        most: f64,
    },
    /// The noise is no size.
    NoiseSize,
    /// The noise changes too fast to be simulated, or hardly ever.
    NoiseInterval,
}

impl ExploreError {
    /// In words.
    pub fn message(&self) -> Message {
        match self {
            Self::Plant(error) => error.message(),
            Self::Relay(error) => error.message(),
            Self::Simulate(error) => error.message(),
            Self::Lag { lag, most } => msg!(
                "its dead time and delay are {} s, but its fastest pole allows {} s at most",
                brief(*lag),
                brief(*most)
            ),
            Self::NoiseSize => "its noise must be 0 or more".into(),
            Self::NoiseInterval => "its noise must change every 0.001 to 1000 s".into(),
        }
    }
}

says!(ExploreError);

/// What there is to see.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ExploreData {
    /// Nyquist curve `P(jw)` with all delays, as real and imaginary parts.
    pub nyquist: Vec<[f64; 2]>,
    /// Its frequencies, rad/s.
    pub nyquist_frequency: Vec<f64>,
    /// `-1/N(a)`, the same way.
    pub inverse_df: Vec<[f64; 2]>,
    /// Where they meet.
    pub intersections: Vec<Intersection>,
    /// The exact cycle to which the loop goes, or the first that there is.
    pub exact: Option<Cycle>,
    /// What becomes of the loop in the end; `None` where no run is long enough to see it.
    pub outcome: Option<Outcome>,
    /// The cycle into which the simulation settles; with noise, the mean of many.
    pub simulated: Option<Cycle>,
    /// Switches of the relay per exact period in the later half of the simulation; 2 without noise.
    pub switches_per_period: Option<f64>,
    /// Ultimate gain by the relay, equation (9), with what the cycle shows of the plant and the true limits.
    pub ultimate: Option<RelayGain>,
    /// First harmonics of the output in the exact cycle.
    pub harmonics: Vec<Harmonic>,
    /// How far the describing function can be trusted here.
    pub trust: Trust,
    /// The answer in a sentence.
    pub text: Message,
    /// Whether the oscillation lasts, in words.
    pub stability: Message,
    /// Amplitude as it grows or fades in the simulation: `[t, a]`, half the distance of neighbouring
    /// extrema of the output, at the later one.
    pub swing: Vec<[f64; 2]>,
    /// Times of the simulation, s.
    pub time: Vec<f64>,
    /// Output.
    pub output: Vec<f64>,
    /// Acting input, `[t, u]` at the corners of its steps.
    pub input: Vec<[f64; 2]>,
    /// Output against its derivative.
    pub phase: Vec<[f64; 2]>,
    /// The last period of that.
    pub cycle: Vec<[f64; 2]>,
}

/// Dead time and delay per time constant of the fastest pole that are taken: the cost grows with them.
const MOST_LAG: f64 = 1e6;

/// Times between two values of the noise that are taken, s: shorter ones take minutes to simulate.
const NOISE_INTERVALS: std::ops::RangeInclusive<f64> = 1e-3..=1e3;

/// Values of the noise in a run: each takes some microseconds.
const MOST_NOISE: f64 = 500_000.0;

impl ExploreInput {
    /// Checks plant, relay and noise, and that the loop can be computed in a moment.
    pub fn validate(&self) -> Result<(), ExploreError> {
        self.plant.validate()?;
        self.relay.validate()?;
        let lag = self.plant.dead_time + self.relay.delay;
        let rates = self.plant.poles().into_iter().map(Complex::norm);
        let most = MOST_LAG / rates.fold(0.0, f64::max);
        if lag > most {
            return Err(ExploreError::Lag { lag, most });
        }
        match self.noise {
            Some(noise) if !(noise.std_dev >= 0.0 && noise.std_dev.is_finite()) => {
                Err(ExploreError::NoiseSize)
            }
            Some(noise) if !NOISE_INTERVALS.contains(&noise.interval) => {
                Err(ExploreError::NoiseInterval)
            }
            _ => Ok(()),
        }
    }
}

/// Points of the Nyquist curve.
const NYQUIST_POINTS: usize = 600;

/// Periods that are simulated, and samples in each.
const PERIODS: f64 = 14.0;
const SAMPLES_PER_PERIOD: f64 = 128.0;

/// Harmonics that are shown.
const HARMONICS: usize = 9;

impl ExploreData {
    /// The describing function's main prediction: a stable one if there is, or else the first.
    pub fn describing(&self) -> Option<&Intersection> {
        dominant(&self.intersections)
    }
}

/// Computes everything; the same input gives the same data.
pub fn compute(input: &ExploreInput) -> Result<ExploreData, ExploreError> {
    input.validate()?;
    let (plant, relay) = (&input.plant, &input.relay);
    let prediction = predict(plant, relay).map_err(|e| match e {
        crate::limit_cycle::PredictError::Plant(e) => ExploreError::Plant(e),
        crate::limit_cycle::PredictError::Relay(e) => ExploreError::Relay(e),
        crate::limit_cycle::PredictError::LongDelay { lag, most } => {
            ExploreError::Lag { lag, most }
        }
    })?;
    let main = dominant(&prediction.describing_function);
    let lag = plant.dead_time + relay.delay;
    let guess = main.map_or(10.0 / typical_frequency(plant) + 2.0 * lag, |i| {
        i.cycle.period
    });
    let exact = main_cycle(&prediction, guess);
    let period = exact.map_or(guess, |c| c.cycle.period);
    let step = period / SAMPLES_PER_PERIOD;
    let space = plant.state_space();
    let run = trajectory(input, &space, lag, step)?;
    let long_run = LongRun {
        plant,
        space: &space,
        relay,
        initial: None,
        push: step,
        noise: input.noise,
    }
    .run(&prediction)?;
    let simulated = long_run.cycle;
    let trust = match long_run.outcome {
        Some(outcome) => prediction.trust_after(plant, relay, outcome),
        None => prediction.trust.clone(),
    };
    let phase: Vec<[f64; 2]> = run
        .output
        .iter()
        .zip(&run.slope)
        .map(|(y, v)| [*y, *v])
        .collect();
    let last = (simulated.map_or(period, |c| c.period) / step).ceil() as usize + 1;
    let cycle = phase[phase.len().saturating_sub(last)..].to_vec();
    let end = run.time.last().copied().unwrap_or(0.0);
    let switches_per_period =
        exact.and_then(|c| Some(c.cycle.period * switch_rate(&run, 0.5 * end)?));
    let centre = main.map_or(typical_frequency(plant), |i| i.omega);
    let (nyquist_frequency, nyquist) = nyquist(plant, relay.delay, centre);
    Ok(ExploreData {
        nyquist,
        nyquist_frequency,
        inverse_df: inverse_df(relay, main),
        exact: exact.map(|c| c.cycle),
        simulated,
        switches_per_period,
        harmonics: exact.map_or_else(Vec::new, |c| harmonics(plant, relay, c, HARMONICS)),
        ultimate: exact
            .map(|c| c.cycle)
            .or(long_run.of_two_levels())
            .map(|c| relay_gain(plant, relay, &c)),
        text: long_run.text,
        outcome: long_run.outcome,
        stability: stability(exact, &prediction),
        swing: swing(&run.time, &run.output),
        trust,
        intersections: prediction.describing_function,
        input: crate::curve::corners(&run.input, end),
        time: run.time,
        output: run.output,
        phase,
        cycle,
    })
}

/// The stable exact cycle whose period is nearest to `period` in s, or else the nearest of all.
fn main_cycle(prediction: &Prediction, period: f64) -> Option<&ExactCycle> {
    let distance = |c: &&ExactCycle| libm::log(c.cycle.period / period).abs();
    let nearest = |a: &&ExactCycle, b: &&ExactCycle| distance(a).total_cmp(&distance(b));
    let all = || prediction.exact.iter();
    all()
        .filter(|c| c.cycle.stable == Some(true))
        .min_by(nearest)
        .or_else(|| all().min_by(nearest))
}

fn trajectory(
    input: &ExploreInput,
    space: &StateSpace,
    lag: f64,
    step: f64,
) -> Result<Trajectory, SimulateError> {
    let steps = (PERIODS * SAMPLES_PER_PERIOD) as usize;
    if input.noise.is_none() {
        return Ok(simulate(space, &input.relay, lag, step, steps));
    }
    let duration = step * steps as f64;
    check_noise(duration, input.noise)?;
    let options = Options {
        noise: input.noise,
        ..Options::new(duration, step)
    };
    run(space, &input.relay, lag, &options)
}

/// Whether the noise of a run is computed in a moment.
fn check_noise(duration: f64, noise: Option<Noise>) -> Result<(), SimulateError> {
    let values = noise.map_or(0.0, |n| duration / n.interval);
    if values <= MOST_NOISE {
        return Ok(());
    }
    Err(SimulateError::Option {
        name: "number of noise values",
        value: values.round(),
        range: "at most 500,000: a faster loop or a longer interval",
    })
}

/// Switches per second after `from` s, counted from the first to the last of them, so that the ends of
/// the run do not matter.
fn switch_rate(run: &Trajectory, from: f64) -> Option<f64> {
    let all = || run.rises.iter().chain(&run.falls).filter(|t| **t > from);
    let first = all().copied().reduce(f64::min)?;
    let last = all().copied().reduce(f64::max)?;
    let rate = (all().count() - 1) as f64 / (last - first);
    rate.is_finite().then_some(rate)
}

/// What becomes of a small disturbance, of which so much is left after a period.
fn disturbed(stable: Option<bool>, left: f64) -> Message {
    let share = percent(left);
    match (stable, left < 1.0) {
        (Some(true), true) => msg!(
            "Stable: a small disturbance shrinks to {} in one period.",
            share
        ),
        (Some(true), false) => msg!(
            "Stable: a small disturbance grows to {} in one period.",
            share
        ),
        (Some(false), true) => msg!(
            "Unstable: a small disturbance shrinks to {} in one period.",
            share
        ),
        (Some(false), false) => msg!(
            "Unstable: a small disturbance grows to {} in one period.",
            share
        ),
        (None, true) => msg!(
            "Its stability is not known: a small disturbance shrinks to {} in one period.",
            share
        ),
        (None, false) => msg!(
            "Its stability is not known: a small disturbance grows to {} in one period.",
            share
        ),
    }
}

fn stability(exact: Option<&ExactCycle>, prediction: &Prediction) -> Message {
    let Some(cycle) = exact else {
        let rests = prediction.existence.filter(|e| !e.holds);
        return rests.map_or_else(
            || "There is no exact cycle with two switches a period.".into(),
            |e| {
                msg!(
                    "No cycle: with the relay held, the output goes to {} or {}, which is not beyond both thresholds.",
                    fixed(e.equilibria[0], 3),
                    fixed(e.equilibria[1], 3)
                )
            },
        );
    };
    let stable = cycle.cycle.stable;
    let verdict = match (stable, cycle.multiplier) {
        (_, Some(m)) => disturbed(stable, m),
        (Some(true), None) => "Stable.".into(),
        (Some(false), None) => "Unstable.".into(),
        (None, None) => "Its stability is not known.".into(),
    };
    let others = prediction.exact.len().saturating_sub(1);
    let rest = match others {
        0 => Message::default(),
        1 => "One more exact cycle exists.".into(),
        n => msg!("{} more exact cycles exist.", n),
    };
    verdict.and(rest)
}

/// A share in per cent, with as many digits as are read.
pub fn percent(share: f64) -> Message {
    let value = 100.0 * share;
    if value < 0.01 {
        "less than 0.01 %".into()
    } else if value < 1.0 {
        format!("{value:.2} %").into()
    } else {
        format!("{value:.0} %").into()
    }
}

/// Half the distance of neighbouring extrema of a sampled output, at the time of the later one.
fn swing(time: &[f64], output: &[f64]) -> Vec<[f64; 2]> {
    let mut found = Vec::new();
    let mut before: Option<f64> = None;
    for (y, t) in output.windows(3).zip(time.iter().skip(1)) {
        if (y[1] - y[0]) * (y[2] - y[1]) < 0.0 || (y[1] != y[0] && y[2] == y[1]) {
            if let Some(before) = before {
                found.push([*t, 0.5 * (y[1] - before).abs()]);
            }
            before = Some(y[1]);
        }
    }
    found
}

/// Frequencies around `centre`, rad/s, and what the plant does there with all delays.
fn nyquist(plant: &TransferFunction, delay: f64, centre: f64) -> (Vec<f64>, Vec<[f64; 2]>) {
    (0..NYQUIST_POINTS)
        .map(|i| {
            let w = centre * libm::pow(10_f64, -2.0 + 3.5 * i as f64 / (NYQUIST_POINTS - 1) as f64);
            let p = plant.response(w) * Complex::from_polar(1.0, -w * delay);
            (w, [p.re, p.im])
        })
        .filter(|(_, p)| p[0].is_finite() && p[1].is_finite())
        .unzip()
}

/// `-1/N(a)` from the smallest amplitude to twice the predicted one.
fn inverse_df(relay: &Relay, dominant: Option<&Intersection>) -> Vec<[f64; 2]> {
    let reach = dominant.map_or(4.0 * relay.hysteresis.max(relay.gain), |i| {
        2.5 * i.cycle.amplitude
    });
    let largest = reach.max(1.5 * relay.hysteresis);
    [relay.hysteresis, largest]
        .map(|a| relay.inverse_describing_function(a))
        .to_vec()
}
