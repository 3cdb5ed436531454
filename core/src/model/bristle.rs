//! A friction contact that follows a body which moves as measured.

use super::DryFriction;
use super::contact::Contact;

/// Noise of the position, in standard deviations, that does not count as motion: a little more than half
/// a step of an encoder.
const TREMBLING: f64 = 2.0;

/// Displacements of a friction contact after which the state before is forgotten to the last digit.
const FORGOTTEN: f64 = 37.0;

/// The measured position without its trembling.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Steady {
    position: Vec<f64>,
    /// Way travelled up to each sample.
    travelled: Vec<f64>,
}

impl Steady {
    pub fn new(measured: &[f64], noise: f64) -> Self {
        let width = TREMBLING * noise;
        let mut now = measured.first().copied().unwrap_or(0.0);
        let mut way = 0.0;
        let (position, travelled) = measured
            .iter()
            .map(|x| {
                let before = now;
                now = now.max(x - width).min(x + width);
                way += (now - before).abs();
                (now, way)
            })
            .unzip();
        Self {
            position,
            travelled,
        }
    }

    /// The first `n` samples.
    pub fn head(&self, n: usize) -> Self {
        Self {
            position: self.position.iter().take(n).copied().collect(),
            travelled: self.travelled.iter().take(n).copied().collect(),
        }
    }
}

/// A friction contact that follows a body which moves as measured.
pub(super) struct Bristle<'e> {
    contact: &'e Contact,
    steady: &'e Steady,
    friction: &'e DryFriction,
    deflection: f64,
    /// Sample up to which it has followed.
    sample: usize,
}

impl<'e> Bristle<'e> {
    pub fn new(contact: &'e Contact, steady: &'e Steady, friction: &'e DryFriction) -> Self {
        Self {
            contact,
            steady,
            friction,
            deflection: 0.0,
            sample: 0,
        }
    }

    /// Deflection at a sample, not before the last one asked for.
    pub fn at(&mut self, sample: usize, time: &[f64]) -> f64 {
        let Steady {
            position,
            travelled,
        } = self.steady;
        // The contact forgets over its displacement, which is longest at the highest level; a fast body may move
        // farther in the last interval alone.
        let since = travelled[sample] - FORGOTTEN * self.friction.presliding;
        let forgotten = travelled[..sample].partition_point(|way| *way < since);
        let from = self.sample.max(forgotten.saturating_sub(1));
        for i in from + 1..=sample {
            let moved = position[i] - position[i - 1];
            if moved != 0.0 {
                let level = self.friction.level_at(moved / (time[i] - time[i - 1]));
                self.deflection = self.contact.followed(self.deflection, moved, level);
            }
        }
        self.sample = sample;
        self.deflection
    }
}
