//! What a model makes of a record: its motion, sample by sample.

use super::output::Output;
use crate::model::FollowedLoad;

/// Position and velocity of the body at every sample.
#[derive(Clone, Debug, Default)]
pub(super) struct Motion {
    pub position: Vec<f64>,
    pub velocity: Vec<f64>,
    /// Of a process whose surroundings wander, the news in what it says beyond what was measured; empty for others.
    pub news: Vec<f64>,
    /// For each window, what its state costs by itself: how far a load is off where it is taken to be.
    pub priors: Vec<f64>,
    /// Where a load begins in the windows.
    pub loads: FollowedLoad,
    /// With these values.
    pub values: Vec<f64>,
}

impl Motion {
    /// No motion over `n` samples.
    pub fn still(n: usize) -> Self {
        Self {
            position: vec![0.0; n],
            velocity: vec![0.0; n],
            ..Self::default()
        }
    }

    /// Takes the motion of another one in a window.
    pub fn take_window(&mut self, other: &Self, window: usize, (from, to): (usize, usize)) {
        self.position[from..to].copy_from_slice(&other.position[from..to]);
        self.velocity[from..to].copy_from_slice(&other.velocity[from..to]);
        if !self.news.is_empty() {
            self.news[from..to].copy_from_slice(&other.news[from..to]);
        }
        self.priors[window] = other.priors[window];
    }

    /// What it leaves of an output at a sample, by which models are fitted and compared.
    pub fn left(&self, output: &Output, i: usize) -> f64 {
        if output.is_velocity && !self.news.is_empty() {
            -self.news[i]
        } else {
            output.values[i] - self.of(output.is_velocity)[i]
        }
    }

    /// Of a derivative of a motion, the part that goes with what is left of an output.
    pub fn compared(&self, is_velocity: bool) -> &[f64] {
        if is_velocity && !self.news.is_empty() {
            &self.news
        } else {
            self.of(is_velocity)
        }
    }

    /// The part that an output shows.
    pub fn of(&self, is_velocity: bool) -> &[f64] {
        if is_velocity {
            &self.velocity
        } else {
            &self.position
        }
    }
}
