//! A measured signal made ready for fitting: its noise, and which of its samples tell something.

use std::borrow::Cow;

use super::noise::Noise;
use super::record::{bridged, fresh, limited, mend};
use crate::measurement::{Channel, Quantity};

/// An output with its noise.
#[derive(Clone, Debug)]
pub(super) struct Output {
    pub is_velocity: bool,
    pub values: Vec<f64>,
    pub noise: f64,
    /// The noise is that of counting alone.
    pub counted: bool,
    /// Step of the lattice on which its values lie; 0 where none is seen.
    pub step: f64,
    /// Samples at which nothing was measured, readings that a channel held and glitches of several values: the values
    /// there lie between those around and are compared with no model. Empty where every sample tells.
    pub silent: Vec<bool>,
    /// Samples at which the sensor was at its limit: they are silent too.
    pub limited: usize,
}

impl Output {
    /// An output, and how many of its values were glitches.
    pub fn new(channel: &Channel, time: &[f64], noise: &Noise) -> (Self, usize) {
        let mut values = channel.values.clone();
        let mut silent = Vec::new();
        let fresh = fresh(&values);
        let mut readings = match &fresh {
            Some(fresh) => fresh.iter().map(|i| values[*i]).collect(),
            None => values,
        };
        let glitches = mend(&mut readings, noise.level);
        if fresh.is_some() || !glitches.lost.is_empty() {
            silent = vec![fresh.is_some(); time.len()];
        }
        values = match &fresh {
            Some(fresh) => {
                for i in fresh {
                    silent[*i] = false;
                }
                bridged(&readings, fresh, time)
            }
            None => readings,
        };
        for i in &glitches.lost {
            silent[fresh.as_ref().map_or(*i, |fresh| fresh[*i])] = true;
        }
        let limited = limited(channel);
        silent.resize(silent.len().max(limited.len()), false);
        for (silent, limited) in silent.iter_mut().zip(&limited) {
            *silent |= limited;
        }
        let output = Self {
            limited: limited.iter().filter(|l| **l).count(),
            is_velocity: channel.quantity != Quantity::Position,
            noise: noise.level,
            counted: noise.counted,
            step: noise.step,
            values,
            silent,
        };
        (output, glitches.mended.len() + glitches.lost.len())
    }

    /// Whether the channel holds its readings over several samples.
    pub fn is_held(&self) -> bool {
        let length = self.silent.len();
        3 * self.telling(0, length) < 2 * (length - self.limited)
    }

    /// Whether something was measured at this sample.
    pub fn tells(&self, sample: usize) -> bool {
        self.silent.get(sample).is_none_or(|silent| !silent)
    }

    /// Number of samples in a run that tell.
    pub fn telling(&self, from: usize, to: usize) -> usize {
        if self.silent.is_empty() {
            return to - from;
        }
        (from..to).filter(|i| self.tells(*i)).count()
    }

    /// Of a series the samples that tell, and the runs in it.
    pub fn told<'a>(
        &self,
        series: &'a [f64],
        runs: &[(usize, usize)],
    ) -> (Cow<'a, [f64]>, Vec<(usize, usize)>) {
        if self.silent.is_empty() {
            return (series.into(), runs.to_vec());
        }
        let told = (0..series.len()).filter(|i| self.tells(*i));
        let mut end = 0;
        let mut before = 0;
        let mut runs_in_it = Vec::with_capacity(runs.len());
        for (from, to) in runs {
            let first = before + self.telling(end, *from);
            before = first + self.telling(*from, *to);
            end = *to;
            runs_in_it.push((first, before));
        }
        (told.map(|i| series[i]).collect(), runs_in_it)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_a_series_what_tells_stays_and_the_runs_with_it() {
        let output = Output {
            is_velocity: true,
            values: vec![0.0; 8],
            noise: 1.0,
            counted: false,
            step: 0.0,
            silent: [0, 1, 0, 1, 1, 0, 0, 1].map(|s| s == 1).to_vec(),
            limited: 0,
        };
        let series: Vec<f64> = (0..8).map(f64::from).collect();
        let (told, runs) = output.told(&series, &[(0, 2), (3, 7)]);
        assert_eq!(told[..], [0.0, 2.0, 5.0, 6.0]);
        assert_eq!(runs, [(0, 1), (2, 4)]);
        assert_eq!(output.telling(1, 6), 2);
    }
}
