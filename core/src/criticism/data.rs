//! A measurement made ready for fitting: noise levels, windows, held-back blocks.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use super::before::{begins_at_rest, begins_at_zero};
use super::cut::{self, Block, MIN_WINDOW};
use super::motion::Motion;
use super::noise::{Noise, noise_beside};
use super::output::Output;
use super::record::limited;
use super::window::drive_window;
use crate::crew::Crew;
use crate::diagnosis::CriticismError;
use crate::effect::Scales;
use crate::effect::baseline::{Baseline, GUESS_FACTOR};
use crate::measurement::{Channel, Kind, Measurement};
use crate::model::{Excitation, FollowedNoise, SeenLoad, Sensor, Start, smoothed};
use crate::sums::deviation;

/// Fewest windows or blocks, so that held-back data are more than one piece of luck.
const MIN_BLOCKS: usize = 20;

/// Most samples that a self-regulating process runs without a restart.
const PROCESS_WINDOW: usize = 20_000;

/// Samples in a block of a process on which a model is fitted or judged.
const PROCESS_BLOCK: usize = 50;

/// Samples around a window start from which its state is first guessed.
const GUESS_SAMPLES: usize = 5;

/// Pieces of motion for each sample after which no further model with a hidden body is tried, and none at all: where so
/// many do not explain a record, more would not, and it would take minutes. (A gap with friction takes some fifteen
/// thousand, three effects of which two show only together a hundred thousand.)
const MOST_MOVES: [f64; 2] = [40_000.0, 150_000.0];

/// A measurement made ready for fitting.
#[derive(Clone, Debug)]
pub(super) struct Data {
    /// Who does the parts of what is computed on it.
    pub crew: Crew,
    /// Pieces of motion that replays of it and of its parts took.
    moves: Arc<AtomicU64>,
    pub kind: Kind,
    /// What it is explained with at first.
    pub baseline: Baseline,
    pub excitation: Excitation,
    pub input: Vec<f64>,
    /// Of a process whose surroundings wander, the share by which each sample moves what is foretold of the next; 0 of
    /// others.
    pub wander: f64,
    pub time: Vec<f64>,
    pub outputs: Vec<Output>,
    /// Values of the outputs that stood alone and were put where their neighbours are.
    pub glitches: usize,
    /// Gaps in the time of a drive, over which the model does not run.
    pub pauses: usize,
    /// Sample before each contact with a load that the motor felt.
    pub felt: Vec<usize>,
    /// First sample of each window.
    pub windows: Vec<usize>,
    pub blocks: Vec<Block>,
    pub has_position: bool,
}

impl Data {
    pub fn new(measurement: &Measurement) -> Result<Self, CriticismError> {
        let input = &measurement.input.values;
        let noise = |c: &Channel| noise_beside(&c.values, input, &limited(c));
        let levels = measurement.outputs.iter().map(noise);
        Self::with_noise(measurement, &levels.collect::<Vec<_>>())
    }

    /// The same where the noise of each output is known.
    pub fn with_noise(measurement: &Measurement, noise: &[Noise]) -> Result<Self, CriticismError> {
        let input = &measurement.input.values;
        if input.iter().all(|u| *u == input[0]) {
            return Err(CriticismError::ConstantInput);
        }
        let mut glitches = 0;
        let outputs: Vec<Output> = measurement
            .outputs
            .iter()
            .zip(noise)
            .map(|(channel, noise)| {
                let (output, found) = Output::new(channel, &measurement.time, noise);
                glitches += found;
                output
            })
            .collect();
        if let Some(c) = measurement
            .outputs
            .iter()
            .find(|c| c.values.iter().all(|v| *v == c.values[0]))
        {
            return Err(CriticismError::ConstantOutput {
                name: c.name.clone(),
            });
        }
        let (pauses, windows, blocks) = windows_and_blocks(measurement, &outputs);
        Ok(Self {
            crew: Crew::default(),
            moves: Arc::default(),
            kind: measurement.kind,
            baseline: match measurement.kind {
                Kind::Drive => Baseline::Drive,
                Kind::Process => Baseline::Lag {
                    from_ambient: begins_at_zero(&outputs),
                },
            },
            excitation: excitation(measurement, &outputs),
            input: input.clone(),
            wander: 0.0,
            time: measurement.time.clone(),
            has_position: outputs.iter().any(|o| !o.is_velocity),
            outputs,
            glitches,
            pauses,
            felt: Vec::new(),
            windows,
            blocks,
        })
    }

    /// The same with a load that the motor felt at these times, s, in order.
    pub fn with_contacts(self, times: &[f64]) -> Self {
        let before = |t: &f64| self.time.partition_point(|at| at <= t).saturating_sub(1);
        let felt = times.iter().map(before).collect();
        Self { felt, ..self }
    }

    /// The same with a load that its contacts tell.
    pub fn with_seen_load(self, seen: SeenLoad) -> Self {
        Self {
            excitation: self.excitation.with_seen_load(seen),
            ..self
        }
    }

    /// The same in windows each with one of the contacts that were felt.
    pub fn cut_at_contacts(self) -> Self {
        if self.felt.is_empty() {
            return self;
        }
        let usual = self.len() / self.windows.len().max(1);
        let windows = cut::at_contacts(&self.felt, &self.velocity_estimate(), usual);
        let blocks = cut::one_each(&windows, self.len());
        Self {
            windows,
            blocks,
            ..self
        }
    }

    /// Cuts a window of a drive into about so many, each a block of its own.
    pub fn cut_finer(&mut self, window: usize, pieces: usize) {
        let end = |w: usize| self.windows.get(w).copied().unwrap_or(self.len());
        let (from, to) = (end(window), end(window + 1));
        let velocity = self.velocity_estimate();
        let finer = cut::in_motion(&velocity[from..to], (to - from).div_ceil(pieces));
        self.windows
            .splice(window..=window, finer.into_iter().map(|cut| from + cut));
        self.blocks = cut::one_each(&self.windows, self.len());
    }

    /// The same with what is fitted held back, and fitted what is held back. Where a window is many blocks, the first
    /// of them is always fitted: without it the state in which the window begins is not told.
    pub fn turned(&self) -> Self {
        let mut turned = self.clone();
        for (k, block) in turned.blocks.iter_mut().enumerate() {
            let goes_on = self
                .blocks
                .get(k + 1)
                .is_some_and(|next| next.window == block.window);
            let begins = goes_on && block.from == self.windows[block.window];
            block.held_back = !block.held_back && !begins;
        }
        turned
    }

    /// Counts pieces of motion of a replay, of it or of a part.
    pub fn count_moves(&self, moves: u64) {
        self.moves.fetch_add(moves, Ordering::Relaxed);
    }

    /// Whether so many were needed that more would not explain it; models with a `hidden` body take the most by far.
    pub fn tried_enough(&self, hidden: bool) -> bool {
        let [of_hidden, of_all] = MOST_MOVES;
        let most = if hidden { of_hidden } else { of_all };
        self.moves.load(Ordering::Relaxed) as f64 > most * self.used() as f64
    }

    /// The record as it would be if this motion had been measured, without noise.
    pub fn saying(&self, motion: &Motion) -> Self {
        let mut said = self.clone();
        for output in &mut said.outputs {
            output.values = motion.of(output.is_velocity).to_vec();
        }
        said
    }

    /// Number of measured values of all outputs in a run of samples.
    pub fn measured(&self, from: usize, to: usize) -> usize {
        self.outputs.iter().map(|o| o.telling(from, to)).sum()
    }

    /// Whether each block begins anew: of a process that runs through, what is wrong in one goes on in the next.
    pub fn has_blocks_apart(&self) -> bool {
        self.blocks.len() == self.windows.len()
    }

    /// Samples that are used.
    pub fn used(&self) -> usize {
        self.blocks.iter().map(|b| b.to - b.from).sum()
    }

    /// First sample and end of each window.
    pub fn spans(&self) -> Vec<(usize, usize)> {
        let mut spans: Vec<(usize, usize)> = self.windows.iter().map(|w| (*w, *w)).collect();
        for block in &self.blocks {
            let span = &mut spans[block.window];
            span.1 = span.1.max(block.to);
        }
        spans
    }

    /// Runs of samples that are used without a break.
    pub fn runs(&self) -> Vec<(usize, usize)> {
        let mut runs: Vec<(usize, usize)> = Vec::new();
        for block in &self.blocks {
            match runs.last_mut() {
                Some(last) if last.1 == block.from => last.1 = block.to,
                _ => runs.push((block.from, block.to)),
            }
        }
        runs
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.time.len()
    }

    /// States of the windows read off the measured outputs, as a first guess. A position that was not measured is the
    /// integral of the velocity: forces may depend on it.
    pub fn guessed_starts(&self) -> Vec<Start> {
        let position = self.outputs.iter().find(|o| !o.is_velocity);
        let velocity = self.outputs.iter().find(|o| o.is_velocity);
        self.windows
            .iter()
            .map(|&sample| Start {
                sample,
                position: self.excitation.position_at(sample),
                velocity: velocity.map_or_else(
                    || position.map_or(0.0, |p| slope(&self.time, &p.values, sample)),
                    |v| v.values[sample],
                ),
                load: [0.0; 2],
            })
            .collect()
    }

    /// Typical sizes, given a baseline body.
    pub fn scales(&self, inertia: f64, viscous: f64) -> Scales {
        let (step, n) = (self.excitation.mean_step(), self.len());
        let speed = match self.outputs.iter().find(|o| o.is_velocity) {
            Some(v) => deviation(&v.values),
            None => deviation(&self.velocity_estimate()),
        };
        let position = match self.outputs.iter().find(|o| !o.is_velocity) {
            Some(x) => x.values.clone(),
            None => self.position_estimate(),
        };
        let (low, high) = position
            .iter()
            .fold((f64::MAX, f64::MIN), |(l, h), x| (l.min(*x), h.max(*x)));
        let constant = (inertia / viscous).abs();
        Scales {
            step,
            duration: step * (n - 1) as f64,
            force: deviation(&self.input),
            inertia,
            inertia_factor: GUESS_FACTOR,
            viscous: viscous.abs().max(inertia.abs() / (step * n as f64)),
            speed,
            travel: high - low,
            resolution: self
                .outputs
                .iter()
                .find(|o| !o.is_velocity)
                .map_or(0.0, |o| o.noise),
            time_constant: if constant.is_finite() {
                constant
            } else {
                step * n as f64
            },
        }
    }

    /// Measured velocity, or slopes of the measured position.
    pub fn velocity_estimate(&self) -> Vec<f64> {
        velocity_estimate(&self.time, &self.outputs)
    }

    /// Dry friction per viscous friction, m/s or rad/s, that takes the same energy from the measured motion.
    pub fn rubbing_speed(&self) -> f64 {
        let velocity = self.velocity_estimate();
        let square: f64 = velocity.iter().map(|v| v * v).sum();
        square / velocity.iter().map(|v| v.abs()).sum::<f64>()
    }

    /// Measured position, or the integral of the measured velocity from 0.
    pub fn position_estimate(&self) -> Vec<f64> {
        position_estimate(&self.time, &self.outputs)
    }
}

/// Number of gaps in the time, first samples of the windows, and the blocks of a record as it is at first.
fn windows_and_blocks(
    measurement: &Measurement,
    outputs: &[Output],
) -> (usize, Vec<usize>, Vec<Block>) {
    let n = measurement.len();
    match measurement.kind {
        Kind::Drive => {
            let longest = (n / MIN_BLOCKS).max(MIN_WINDOW);
            let length = drive_window(outputs, longest);
            let velocity = velocity_estimate(&measurement.time, outputs);
            let pauses = cut::pauses(&measurement.time);
            let windows = cut::between(&pauses, &velocity, length);
            let blocks = cut::one_each(&windows, n);
            (pauses.len(), windows, blocks)
        }
        Kind::Process => {
            let block = (n / MIN_BLOCKS).clamp(MIN_WINDOW, PROCESS_BLOCK);
            let windows = cut::evenly(n, PROCESS_WINDOW);
            let blocks = cut::blocks(n, block, &windows);
            (0, windows, blocks)
        }
    }
}

/// What acts in every replay: the input, what came before it, and what the sensors say of the motion.
fn excitation(measurement: &Measurement, outputs: &[Output]) -> Excitation {
    let (time, input) = (&measurement.time, &measurement.input.values);
    let at_rest = begins_at_rest(measurement.kind, input, outputs);
    let before = if at_rest { 0.0 } else { input[0] };
    let velocity = outputs.iter().find(|o| o.is_velocity);
    let sensor = if velocity.is_some() {
        Sensor::Velocity
    } else {
        Sensor::Position
    };
    let shown = velocity.or(outputs.first());
    let shown = shown.map_or_else(Vec::new, |o| o.values.clone());
    let position = match measurement.kind {
        Kind::Drive => {
            let seen = |is_velocity: bool| {
                let output = outputs.iter().find(|o| o.is_velocity == is_velocity);
                output.map(|o| (o.values.as_slice(), o.noise))
            };
            smoothed(time, seen(false), seen(true))
        }
        Kind::Process => Vec::new(),
    };
    let position_first = outputs.iter().min_by_key(|o| o.is_velocity);
    let followed = position_first.map(|o| {
        if o.is_velocity {
            FollowedNoise::Velocity(o.noise)
        } else {
            FollowedNoise::Position(o.noise)
        }
    });
    Excitation::new(time, input, before, sensor, position, followed)
        .with_shown(shown)
        .at_rest_at_first(at_rest)
}

/// Slope of `values` near a sample, per second.
fn slope(time: &[f64], values: &[f64], sample: usize) -> f64 {
    let from = sample.saturating_sub(GUESS_SAMPLES / 2);
    let to = (from + GUESS_SAMPLES).min(values.len()) - 1;
    (values[to] - values[from]) / (time[to] - time[from])
}

/// Measured velocity, or slopes of the measured position.
fn velocity_estimate(time: &[f64], outputs: &[Output]) -> Vec<f64> {
    if let Some(v) = outputs.iter().find(|o| o.is_velocity) {
        return v.values.clone();
    }
    outputs.first().map_or_else(Vec::new, |x| {
        (0..time.len()).map(|i| slope(time, &x.values, i)).collect()
    })
}

/// Measured position, or the integral of the measured velocity from 0.
fn position_estimate(time: &[f64], outputs: &[Output]) -> Vec<f64> {
    if let Some(x) = outputs.iter().find(|o| !o.is_velocity) {
        return x.values.clone();
    }
    let mut sum = 0.0;
    outputs.first().map_or_else(Vec::new, |v| {
        (0..time.len())
            .map(|i| {
                if i > 0 {
                    sum += 0.5 * (v.values[i] + v.values[i - 1]) * (time[i] - time[i - 1]);
                }
                sum
            })
            .collect()
    })
}
