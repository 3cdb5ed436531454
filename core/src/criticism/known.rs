//! What is known of the values of a structure, in their order.

use super::knowledge::HALF_GAP;
use super::structure::Structure;
use crate::user_model::{Known, Status};

impl Structure {
    /// What is known of each value, in order; `None` where nothing is.
    pub fn known(&self) -> Vec<Option<&Known>> {
        let symbols = self.symbols().into_iter();
        symbols
            .map(|(owner, symbol)| self.knowledge.find(owner, symbol))
            .collect()
    }

    /// Values that the fit changes.
    pub fn free_count(&self) -> usize {
        self.fixed().iter().filter(|f| !**f).count()
    }

    /// Known value and standard deviation of each prior, by index.
    pub fn priors(&self) -> Vec<(usize, f64, f64)> {
        let known = self.known();
        let mut priors: Vec<(usize, f64, f64)> = known
            .iter()
            .enumerate()
            .filter_map(|(j, k)| match k.as_ref()?.status {
                Status::Prior(tolerance) => Some((j, k.as_ref()?.value, tolerance)),
                _ => None,
            })
            .collect();
        if let Some((half_gap, tolerance)) = self.knowledge.felt_gap() {
            let at = self.symbols().iter().position(|s| *s == HALF_GAP);
            let unsaid = at.filter(|j| known[*j].is_none());
            priors.extend(unsaid.map(|j| (j, half_gap, tolerance)));
        }
        priors
    }

    /// Squared deviations from the priors, in units of their tolerance.
    pub fn prior_cost(&self, values: &[f64]) -> f64 {
        self.priors()
            .iter()
            .map(|(j, value, tolerance)| ((values[*j] - value) / tolerance).powi(2))
            .sum()
    }

    /// Puts known values in the place of guessed ones among the values from `from` on.
    pub fn begin(&self, values: &mut [f64], from: usize) {
        for (value, known) in values.iter_mut().zip(self.known()).skip(from) {
            if let Some(known) = known {
                *value = known.value;
            }
        }
        self.hold(values);
    }
}
