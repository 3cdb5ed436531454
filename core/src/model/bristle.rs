//! A friction contact that follows a body which moves as measured.

use super::DryFriction;
use super::contact::Contact;

/// Noise of the position, in standard deviations, that does not count as motion: a little more than half
/// a step of an encoder.
const TREMBLING: f64 = 2.0;

/// Displacements of a friction contact after which the state before is forgotten to the last digit.
const FORGOTTEN: f64 = 37.0;

/// Displacements after which the state before hardly counts, and samples at most that they are looked for.
const TOLD: f64 = 5.0;
const MOST_TOLD: usize = 2_000;

/// Displacement over which friction builds up, in standard deviations of the noise, from which on trembling hardly
/// bends the contact, and less than the way would that is lost where it is taken out.
const LONG: f64 = 500.0;

/// The way of a body.
#[derive(Clone, Debug, PartialEq)]
struct Way {
    position: Vec<f64>,
    /// Way travelled up to each sample.
    travelled: Vec<f64>,
}

/// What a body did as measured.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Steady {
    /// With its trembling.
    all: Way,
    /// Without.
    quiet: Way,
    noise: f64,
}

impl Steady {
    pub fn new(measured: &[f64], noise: f64) -> Self {
        Self {
            all: Way::new(measured, 0.0),
            quiet: Way::new(measured, TREMBLING * noise),
            noise,
        }
    }

    /// The first `n` samples.
    pub fn head(&self, n: usize) -> Self {
        Self {
            all: self.all.head(n),
            quiet: self.quiet.head(n),
            noise: self.noise,
        }
    }
}

impl Way {
    /// The way of what follows at this distance.
    fn new(measured: &[f64], width: f64) -> Self {
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

    fn head(&self, n: usize) -> Self {
        Self {
            position: self.position.iter().take(n).copied().collect(),
            travelled: self.travelled.iter().take(n).copied().collect(),
        }
    }
}

/// A friction contact that follows a body which moves as measured.
pub(super) struct Bristle<'e> {
    contact: &'e Contact,
    way: &'e Way,
    friction: &'e DryFriction,
    deflection: f64,
    /// Sample up to which it has followed.
    sample: usize,
}

impl<'e> Bristle<'e> {
    pub fn new(contact: &'e Contact, steady: &'e Steady, friction: &'e DryFriction) -> Self {
        let long = friction.presliding > LONG * steady.noise;
        Self {
            contact,
            way: if long { &steady.all } else { &steady.quiet },
            friction,
            deflection: 0.0,
            sample: 0,
        }
    }

    /// Sample from which on the motion tells the deflection at this one, whatever it was before, or so much of the
    /// record before.
    pub fn told_from(&self, sample: usize) -> usize {
        let travelled = &self.way.travelled;
        let since = travelled[sample] - TOLD * self.friction.presliding;
        let told = travelled[..sample].partition_point(|way| *way < since);
        told.max(sample.saturating_sub(MOST_TOLD))
    }

    /// Deflection at a sample, not before the last one asked for.
    pub fn at(&mut self, sample: usize, time: &[f64]) -> f64 {
        let Way {
            position,
            travelled,
        } = self.way;
        // The contact forgets over its displacement, which is longest at the highest level; a fast body may move
        // farther in the last interval alone.
        let since = travelled[sample] - FORGOTTEN * self.friction.presliding;
        let forgotten = travelled[..sample].partition_point(|way| *way < since);
        let from = self.sample.max(forgotten.saturating_sub(1));
        for i in from + 1..=sample {
            let moved = position[i] - position[i - 1];
            if moved != 0.0 {
                let velocity = moved / (time[i] - time[i - 1]);
                let level = self.friction.level_at(position[i], velocity).max(0.0);
                self.deflection = self.contact.followed(self.deflection, moved, level);
            }
        }
        self.sample = sample;
        self.deflection
    }
}
