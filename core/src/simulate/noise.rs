//! Band-limited measurement noise, as in Fig. 4 of the paper.

use rand::SeedableRng as _;
use rand_distr::{Distribution as _, StandardNormal};
use rand_pcg::Pcg64;
use serde::{Deserialize, Serialize};

use super::series::TERMS;

/// Gaussian noise on the output that the relay sees: independent values every `interval` seconds,
/// joined by straight lines, so that its power falls off above `1/(2 interval)` Hz.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Noise {
    /// Standard deviation of the values, in the unit of the output; at least 0.
    pub std_dev: f64,
    /// Time between them, s; above 0.
    pub interval: f64,
    /// The same seed gives the same noise.
    #[serde(default)]
    pub seed: u64,
}

impl Noise {
    /// The noise on the output of a single loop at these times (s, increasing), as the relay of [`run`](super::run)
    /// sees it there.
    pub fn at(self, times: &[f64]) -> Vec<f64> {
        let mut along = NoiseAlong::new(self, 0);
        let value = |t: &f64| {
            along.go_to(*t);
            along.at(*t)
        };
        times.iter().map(value).collect()
    }
}

/// Noise along a run: the straight piece of the present.
#[derive(Clone, Debug)]
pub(crate) struct NoiseAlong {
    source: Source,
    piece: Piece,
    end: f64,
}

impl NoiseAlong {
    /// The noise of channel `channel` from 0 s on; each has its own.
    pub fn new(noise: Noise, channel: u64) -> Self {
        let mut source = Source::new(noise, channel);
        let (piece, end) = source.piece();
        Self { source, piece, end }
    }

    /// Where the piece ends, s.
    pub fn end(&self) -> f64 {
        self.end
    }

    /// Goes on to the piece of a later time, s.
    pub fn go_to(&mut self, time: f64) {
        while self.end <= time {
            (self.piece, self.end) = self.source.piece();
        }
    }

    /// Value at a time of the piece, s.
    pub fn at(&self, time: f64) -> f64 {
        self.piece.value + self.piece.slope * (time - self.piece.start)
    }

    /// Slope of the piece, 1/s.
    pub fn slope(&self) -> f64 {
        self.piece.slope
    }

    /// Adds the piece to the series of an output over a step of `h` s from `now`.
    pub fn add_to(&self, series: &mut [f64; TERMS], now: f64, h: f64) {
        let half = 0.5 * h * self.piece.slope;
        series[0] += self.at(now) + half;
        series[1] += half;
    }
}

/// One straight piece of noise.
#[derive(Clone, Copy, Debug)]
struct Piece {
    /// Where it begins, s.
    start: f64,
    /// Value there.
    value: f64,
    /// Slope, 1/s.
    slope: f64,
}

/// Noise as it unrolls.
#[derive(Clone, Debug)]
struct Source {
    noise: Noise,
    random: Pcg64,
    pieces: u64,
    next: f64,
}

impl Source {
    fn new(noise: Noise, channel: u64) -> Self {
        let mut random =
            Pcg64::seed_from_u64(noise.seed ^ channel.wrapping_mul(0x9e37_79b9_7f4a_7c15));
        let next = noise.std_dev * gauss(&mut random);
        Self {
            noise,
            random,
            pieces: 0,
            next,
        }
    }

    /// The next straight piece, and where it ends.
    fn piece(&mut self) -> (Piece, f64) {
        let (start, value) = (self.pieces as f64 * self.noise.interval, self.next);
        self.pieces += 1;
        let end = self.pieces as f64 * self.noise.interval;
        self.next = self.noise.std_dev * gauss(&mut self.random);
        let slope = (self.next - value) / (end - start);
        (
            Piece {
                start,
                value,
                slope,
            },
            end,
        )
    }
}

fn gauss(random: &mut Pcg64) -> f64 {
    StandardNormal.sample(random)
}
