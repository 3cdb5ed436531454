//! Hints of a round of guessing: how many were bought, and what they have cost.

/// What a hint costs, of 100 points.
pub(super) const PRICE: u32 = 10;

/// Effects that are left to choose from after each hint of a step.
pub(super) const LEFT: [usize; 3] = [4, 2, 1];

/// What is known of a round of guessing.
#[derive(Clone, Debug, Default)]
pub(super) struct Guess {
    /// Hints that were bought: for the models with so many effects.
    pub bought: Vec<usize>,
}

impl Guess {
    /// What hints have cost.
    pub fn cost(&self) -> u32 {
        PRICE * self.bought.len() as u32
    }

    /// Buys a hint for the models with so many effects; after the last one, nothing.
    pub fn buy(&mut self, effects: usize) {
        if self.hints(effects) < LEFT.len() {
            self.bought.push(effects);
        }
    }

    /// Hints that were bought for the models with so many effects.
    pub fn hints(&self, effects: usize) -> usize {
        self.bought.iter().filter(|n| **n == effects).count()
    }
}
