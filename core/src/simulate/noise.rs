//! Band-limited measurement noise, as in Fig. 4 of the paper.

use rand::SeedableRng as _;
use rand_distr::{Distribution as _, StandardNormal};
use rand_pcg::Pcg64;
use serde::{Deserialize, Serialize};

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
    /// The noise on the output of a single loop at these times (s, increasing), as the relay of [`run`](super::run) sees
    /// it there.
    pub fn at(self, times: &[f64]) -> Vec<f64> {
        let mut source = Source::new(self, 0);
        let (mut piece, mut end) = source.piece();
        let value = |t: &f64| {
            while end <= *t {
                (piece, end) = source.piece();
            }
            piece.value + piece.slope * (t - piece.start)
        };
        times.iter().map(value).collect()
    }
}

/// One straight piece of noise.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Piece {
    /// Where it begins, s.
    pub start: f64,
    /// Value there.
    pub value: f64,
    /// Slope, 1/s.
    pub slope: f64,
}

/// Noise as it unrolls.
#[derive(Clone, Debug)]
pub(crate) struct Source {
    noise: Noise,
    random: Pcg64,
    pieces: u64,
    next: f64,
}

impl Source {
    /// The noise of channel `channel`; each has its own.
    pub fn new(noise: Noise, channel: u64) -> Self {
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
    pub fn piece(&mut self) -> (Piece, f64) {
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
