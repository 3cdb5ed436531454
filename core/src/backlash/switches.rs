//! Where in a sample does the relay switch?
//!
//! A recorder may write the torque at the instant of each sample, which says nothing of a switch between two samples:
//! taken for the mean of the sample it is wrong by up to twice the gain there, which looks like an impact. The velocity
//! shows the switch: it runs along one line before and along another one after it, and they meet where the torque
//! changed (Hinkley 1969). A torque that was held from sample to sample, or averaged, has its change at the end of a
//! sample, and the same construction finds it there.

use super::record::Record;
use crate::order::median;

/// Share by which the change of the slope at a switch may differ from the usual one before something else must have
/// happened next to it; the line on the other side then places the switch.
const AS_USUAL: f64 = 0.25;

/// How far outside of its sample the lines may meet, in samples, before something else must have happened in it.
const OUTSIDE: f64 = 0.25;

/// Share of a sample of the old torque where something else happened: unknown, so the middle.
const UNKNOWN: f64 = 0.5;

/// Change of the torque, as share of the relay's swing, from which on it is one: a flip of the asymmetry is as well.
const CHANGES: f64 = 0.05;

/// Standard deviation of a share of a sample that may be any.
const UNIFORM: f64 = 0.288_675_134_594_812_9;

/// The torque over each sample.
pub(super) struct MeanInput {
    /// N m or N.
    pub mean: Vec<f64>,
    /// Standard deviation of it where a switch cannot be placed, since another one is next to it; N m or N.
    pub spread: Vec<f64>,
}

/// Samples in which the torque changes.
pub(super) struct Switches {
    /// The sample from whose torque to the next one's it changes.
    pub at: Vec<usize>,
    /// Least change.
    least: f64,
}

impl Switches {
    /// All changes of the torque; `swing`: the relay's two levels apart.
    pub fn new(record: &Record, swing: f64) -> Self {
        let least = CHANGES * swing;
        let changes = record.input.windows(2).enumerate();
        let at = changes
            .filter(|(_, u)| (u[1] - u[0]).abs() > least)
            .map(|(i, _)| i)
            .collect();
        Self { at, least }
    }

    /// The mean torque of each sample, up to the next one, with every switch placed by the velocity.
    pub fn mean_input(&self, record: &Record) -> MeanInput {
        let (u, v) = (&record.input, &record.velocity);
        let mut mean = u.clone();
        let mut spread = vec![0.0; u.len()];
        let steady = |a: usize, b: usize| (u[b] - u[a]).abs() <= self.least;
        let alone: Vec<usize> = self
            .at
            .iter()
            .copied()
            .filter(|&i| i >= 1 && i + 2 < u.len() && steady(i - 1, i) && steady(i + 1, i + 2))
            .collect();
        for &i in &self.at {
            spread[i] = (u[i + 1] - u[i]).abs() * UNIFORM;
        }
        // Slopes a sample after and before: their difference, and what it usually is for a change of the torque by 1.
        let bend = |i: usize| (v[i + 2] - v[i + 1]) - (v[i] - v[i - 1]);
        let change = |i: usize| u[i + 1] - u[i];
        let mut bends: Vec<f64> = alone.iter().map(|&i| bend(i) / change(i)).collect();
        let usual = median(&mut bends);
        for i in alone {
            spread[i] = 0.0;
            let within = v[i + 1] - v[i];
            let [before, after] = [v[i] - v[i - 1], v[i + 2] - v[i + 1]];
            let expected = usual * change(i);
            let old = if (bend(i) / expected - 1.0).abs() <= AS_USUAL {
                (after - within) / bend(i)
            } else if (before - usual * u[i]).abs() < (after - usual * u[i + 1]).abs() {
                1.0 - (within - before) / expected
            } else {
                (after - within) / expected
            };
            let old = if (-OUTSIDE..=1.0 + OUTSIDE).contains(&old) {
                old.clamp(0.0, 1.0)
            } else {
                UNKNOWN
            };
            mean[i] = old * u[i] + (1.0 - old) * u[i + 1];
        }
        MeanInput { mean, spread }
    }
}
