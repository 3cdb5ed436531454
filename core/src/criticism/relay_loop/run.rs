//! The cycle of a loop: period and amplitude, of a record or of a model that runs in it.

use super::rule::Rule;
use super::tuning::{FEWEST_CYCLES, SEED};
use crate::criticism::output::Output;
use crate::model::{Model, Sensor, run_controlled_from};
use crate::random::Random;

/// What a loop does in the second half of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cycle {
    /// Mean, samples.
    pub period: f64,
    /// Half of what the signal spans in a cycle, median.
    pub amplitude: f64,
}

impl Cycle {
    /// That of an input and the signal that its relay saw.
    pub fn of(input: &[f64], signal: &[f64]) -> Option<Self> {
        let rises: Vec<usize> = (input.len() / 2 + 1..input.len())
            .filter(|i| input[*i] > input[i - 1])
            .collect();
        let cycles = rises.len().checked_sub(1).filter(|n| *n >= FEWEST_CYCLES)?;
        let period = (rises[cycles] - rises[0]) as f64 / cycles as f64;
        let spans = rises.windows(2).map(|pair| {
            let cycle = signal[pair[0]..pair[1]].iter();
            let ends = cycle.fold([f64::MAX, f64::MIN], |[a, b], y| [a.min(*y), b.max(*y)]);
            0.5 * (ends[1] - ends[0])
        });
        let mut spans: Vec<f64> = spans.collect();
        spans.sort_by(f64::total_cmp);
        let amplitude = spans[cycles / 2];
        let sound = amplitude.is_finite() && amplitude > 0.0;
        sound.then_some(Self { period, amplitude })
    }
}

/// How the signal of a relay shows what it is of.
#[derive(Clone, Copy, Debug)]
pub(super) enum Sight {
    /// In steps.
    Counted(f64),
    /// With white noise of this standard deviation.
    Noisy(f64),
}

impl Sight {
    /// That of a measured output.
    pub fn of(output: &Output) -> Self {
        if output.counted && output.step > 0.0 {
            Self::Counted(output.step)
        } else {
            Self::Noisy(output.noise)
        }
    }

    fn shown(self, value: f64, random: &mut Random) -> f64 {
        match self {
            Self::Counted(step) => (value / step).round() * step,
            Self::Noisy(noise) => value + noise * random.normal(),
        }
    }
}

/// How a loop is run, and where it begins.
#[derive(Clone, Copy, Debug)]
pub(super) struct Begin {
    /// Sampling time, s.
    pub step: f64,
    pub samples: usize,
    pub position: f64,
    pub velocity: f64,
    pub input: f64,
    /// The relay sees the velocity, or the output of a process.
    pub sees_velocity: bool,
    pub sight: Sight,
    pub sensor: Sensor,
}

/// Input and signal of the relay of a model that runs in its loop.
pub(super) fn run(model: &Model, rule: &Rule, begin: &Begin) -> (Vec<f64>, Vec<f64>) {
    let mut upper = rule.is_upper(begin.input);
    let mut seen: Vec<f64> = Vec::with_capacity(begin.samples);
    let mut random = Random::new(SEED);
    let run = run_controlled_from(
        model,
        begin.step,
        begin.samples,
        begin.sensor,
        [begin.position, begin.velocity],
        |_, position, velocity| {
            let value = if begin.sees_velocity {
                velocity
            } else {
                position
            };
            seen.push(begin.sight.shown(value, &mut random));
            let told = (seen.len() - 1).checked_sub(rule.late).map(|k| seen[k]);
            upper = told.map_or(upper, |told| rule.is_upper_after(told, upper));
            rule.level(upper)
        },
    );
    (run.input, seen)
}
