//! The measured input that drives a model, with what else was measured of a load and by a slow sensor.

use super::bristle::Steady;
use super::followed::FollowedNoise;
use super::seen_load::SeenLoad;

/// A time step within this share of the mean one counts as equal: files round their time column.
const UNIFORM_TOLERANCE: f64 = 0.02;

/// A measured input, held between samples.
#[derive(Clone, Debug, PartialEq)]
pub struct Excitation {
    pub(super) time: Vec<f64>,
    pub(super) input: Vec<f64>,
    /// Input before the record starts.
    pub(super) before: f64,
    /// Nothing moves at first, wherever it is.
    pub(super) at_rest: bool,
    /// Sampling time in s, if equal throughout.
    pub(super) step: Option<f64>,
    pub(super) slow_sensor: Sensor,
    /// What a slow sensor showed: the measured values of its output, or empty.
    pub(super) shown: Vec<f64>,
    /// Position that a load follows, free of noise as far as known; empty for a process.
    pub(super) position: Vec<f64>,
    /// The noise of what it stands for.
    pub(super) noise: Option<FollowedNoise>,
    /// The same without its trembling.
    pub(super) steady: Option<Steady>,
    /// The load, where the motor felt its contacts.
    pub(super) seen: Option<SeenLoad>,
    /// Sample ranges that are simulated, ascending; between them only hidden states go on.
    pub(super) runs: Vec<(usize, usize)>,
}

/// Which output a slow sensor shows: a counting encoder is not slow, but the velocity made from it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sensor {
    /// The velocity, or the output of a process.
    Velocity,
    /// The position, where nothing else is measured.
    Position,
}

impl Excitation {
    /// `time` in s strictly increasing, `input` as long; `before` acted until the record starts;
    /// `position` that a load follows, as long or empty, with the noise of what was measured.
    pub fn new(
        time: &[f64],
        input: &[f64],
        before: f64,
        slow_sensor: Sensor,
        position: Vec<f64>,
        noise: Option<FollowedNoise>,
    ) -> Self {
        let n = time.len();
        let mean = (time[n - 1] - time[0]) / (n - 1) as f64;
        let uniform = time
            .iter()
            .enumerate()
            .all(|(i, t)| (t - time[0] - mean * i as f64).abs() < UNIFORM_TOLERANCE * mean);
        Self {
            time: time.to_vec(),
            input: input.to_vec(),
            before,
            at_rest: false,
            step: uniform.then_some(mean),
            slow_sensor,
            shown: Vec::new(),
            steady: noise.map(|noise| match noise {
                FollowedNoise::Position(level) => Steady::new(&position, level),
                FollowedNoise::Velocity(level) => Steady::new(&position, level * mean),
            }),
            position,
            noise,
            seen: None,
            runs: vec![(0, time.len())],
        }
    }

    /// The same with what a slow sensor showed, which tells its state where a run begins within the record.
    #[must_use]
    pub(crate) fn with_shown(self, shown: Vec<f64>) -> Self {
        Self { shown, ..self }
    }

    /// The same where nothing moves at first, or something does.
    #[must_use]
    pub(crate) fn at_rest_at_first(self, at_rest: bool) -> Self {
        Self { at_rest, ..self }
    }

    /// The same with a load that the motor felt.
    #[must_use]
    pub(crate) fn with_seen_load(self, seen: SeenLoad) -> Self {
        let seen = Some(seen);
        Self { seen, ..self }
    }

    /// Position that a load follows; empty for a process.
    pub(crate) fn followed(&self) -> &[f64] {
        &self.position
    }

    /// Whether a load is told by contacts that the motor felt.
    pub(crate) fn sees_load(&self) -> bool {
        self.seen.is_some()
    }

    /// The same, to be simulated in these sample ranges (ascending, apart) only; each begins at a start.
    #[must_use]
    pub fn within(&self, runs: Vec<(usize, usize)>) -> Self {
        Self {
            runs,
            ..self.clone()
        }
    }

    /// The first `n` samples.
    #[must_use]
    pub fn head(&self, n: usize) -> Self {
        Self {
            time: self.time[..n].to_vec(),
            input: self.input[..n].to_vec(),
            position: self.position.iter().take(n).copied().collect(),
            shown: self.shown.iter().take(n).copied().collect(),
            steady: self.steady.as_ref().map(|s| s.head(n)),
            seen: self.seen.clone(),
            runs: vec![(0, n)],
            ..*self
        }
    }

    /// Measured or estimated position at a sample; 0 of a process.
    pub(crate) fn position_at(&self, sample: usize) -> f64 {
        self.position.get(sample).copied().unwrap_or(0.0)
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.time.len()
    }

    /// Whether there is no sample.
    pub fn is_empty(&self) -> bool {
        self.time.is_empty()
    }

    /// Mean sampling time, s.
    pub fn mean_step(&self) -> f64 {
        (self.time[self.len() - 1] - self.time[0]) / (self.len() - 1) as f64
    }

    /// Time from a sample to the next, s.
    pub(super) fn step_after(&self, i: usize) -> f64 {
        self.step.unwrap_or_else(|| self.time[i + 1] - self.time[i])
    }

    /// Mean velocity from a sample to the next.
    pub(super) fn speed_after(&self, i: usize) -> f64 {
        (self.position[i + 1] - self.position[i]) / self.step_after(i)
    }
}
