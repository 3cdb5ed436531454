//! Parts of a record on which models are compared and starting points are tried: windows spread over it, or its
//! beginning.

use super::cut::{Block, GOLDEN};
use super::data::Data;
use crate::measurement::Kind;

/// Starting points are tried on one part in this many of the record ...
const SCOUT_PART: usize = 5;

/// ... and on at least this many samples.
const SCOUT_SAMPLES: usize = 1250;

/// Share of what is left that a scout must see, in times of its share of the record.
const SEEN: f64 = 0.5;

impl Data {
    /// Pairs of windows (fitted and held back) spread over the record, about `samples` in all.
    pub fn thinned(&self, samples: usize) -> Self {
        if samples >= self.used() || self.kind == Kind::Process {
            return self.clone();
        }
        let chosen = self.spread(samples);
        self.only(|window| chosen[window])
    }

    /// Whether each window is one of these.
    fn spread(&self, samples: usize) -> Vec<bool> {
        let share = samples as f64 / self.used() as f64;
        let felt = self.felt_pairs(samples / 2);
        // At no fixed distance, which could meet the same phase of a periodic motion each time.
        let chosen = |pair: usize| (pair as f64 * GOLDEN).fract() < share || felt.contains(&pair);
        (0..self.windows.len()).map(|w| chosen(w / 2)).collect()
    }

    /// The windows that are `chosen` by their number.
    pub fn only(&self, chosen: impl Fn(usize) -> bool) -> Self {
        let mut part = self.clone();
        part.windows = (0..self.windows.len())
            .filter(|w| chosen(*w))
            .map(|w| self.windows[w])
            .collect();
        part.blocks = self
            .blocks
            .iter()
            .filter(|b| chosen(b.window))
            .map(|b| Block {
                window: part
                    .windows
                    .binary_search(&self.windows[b.window])
                    .unwrap_or(0),
                ..*b
            })
            .collect();
        part.excitation = self.excitation.within(part.spans());
        part
    }

    /// The first `share` of every window.
    pub fn beginning(&self, share: f64) -> Self {
        let mut part = self.clone();
        let ends = self.spans().into_iter().map(|(from, to)| {
            let samples = (share * (to - from) as f64).ceil();
            (from + samples as usize).min(to)
        });
        let ends: Vec<usize> = ends.collect();
        part.blocks.retain(|b| b.from < ends[b.window]);
        for block in &mut part.blocks {
            block.to = block.to.min(ends[block.window]);
        }
        part.excitation = self.excitation.within(part.spans());
        part
    }

    /// Pairs of windows in which the motor felt a load, spread over the record, about `samples` in all: where it
    /// is felt now and then only, the other windows tell nothing of it.
    fn felt_pairs(&self, samples: usize) -> Vec<usize> {
        let window = |sample: usize| self.windows.partition_point(|w| *w <= sample) - 1;
        let mut pairs: Vec<usize> = self.felt.iter().map(|s| window(*s) / 2).collect();
        pairs.dedup();
        let stride = (pairs.len() * self.pair_length())
            .div_ceil(samples.max(1))
            .max(1);
        pairs.into_iter().step_by(stride).collect()
    }

    /// Samples of a usual pair of windows.
    fn pair_length(&self) -> usize {
        2 * self.used() / self.windows.len().max(1)
    }

    /// Samples of a scout.
    fn scouted(&self) -> usize {
        (self.used() / SCOUT_PART).max(SCOUT_SAMPLES)
    }

    /// The scout of a model that leaves this in each window: where the usual one sees far less of it than its share,
    /// half of it are the windows that are worst. An input may reach its limit seldom.
    pub fn scout_seeing(&self, left: &[f64]) -> Self {
        let samples = self.scouted();
        if samples >= self.used() || self.kind == Kind::Process {
            return self.scout();
        }
        let usual = self.spread(samples);
        let of_usual = self.blocks.iter().filter(|b| usual[b.window]);
        let share = of_usual.map(|b| b.to - b.from).sum::<usize>() as f64 / self.used() as f64;
        let seen: f64 = left
            .iter()
            .zip(&usual)
            .filter(|(_, in_it)| **in_it)
            .map(|(l, _)| l)
            .sum();
        if seen >= SEEN * share * left.iter().sum::<f64>() {
            return self.only(|window| usual[window]);
        }
        let mut chosen = self.spread(samples / 2);
        let mut pairs: Vec<(f64, &mut [bool])> = left
            .chunks(2)
            .map(|pair| pair.iter().sum())
            .zip(chosen.chunks_mut(2))
            .collect();
        pairs.sort_by(|a, b| b.0.total_cmp(&a.0));
        let count = (samples / 2).div_ceil(self.pair_length().max(1));
        for (_, worst) in pairs.into_iter().take(count) {
            worst.fill(true);
        }
        self.only(|window| chosen[window])
    }

    /// A small part of the record, for trying starting points quickly; all of it if it is short.
    pub fn scout(&self) -> Self {
        let wanted = self.scouted();
        if self.kind == Kind::Drive {
            return self.thinned(wanted);
        }
        let blocks: Vec<Block> = self
            .blocks
            .iter()
            .copied()
            .filter(|b| b.to <= wanted)
            .collect();
        let Some(end) = blocks.last().map(|b| b.to).filter(|end| *end < self.len()) else {
            return self.clone();
        };
        let mut part = self.clone();
        part.time.truncate(end);
        part.input.truncate(end);
        part.excitation = self.excitation.head(end);
        part.felt.retain(|s| *s < end);
        for output in &mut part.outputs {
            output.values.truncate(end);
            output.silent.truncate(end);
        }
        part.windows.retain(|w| *w < end);
        part.blocks = blocks;
        part
    }
}
