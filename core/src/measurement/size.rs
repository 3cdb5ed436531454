//! Values that nothing can have measured: too large or too small to calculate with.

use super::column::Role;

/// Largest value that is read: of larger ones the fourth powers, of which some sums consist, or products with the like
/// are beyond the largest number that an `f64` can hold (1e308).
const LARGEST: f64 = 1e75;

/// A column whose values are all smaller, and not 0, is none either: their fourth powers are 0 to an `f64`.
const SMALLEST: f64 = 1e-75;

/// Times the usual size from which nothing is left of the usual one in a difference: an `f64` has 16 digits.
const MOST_TIMES_USUAL: f64 = 1e16;

/// The first value of a column in this role, by its place from 0, that cannot be calculated with: by itself, or beside
/// the others. Of times it is their distances that are compared.
pub(super) fn wrong_size(role: Role, values: &[f64]) -> Option<usize> {
    let too_large = values.iter().position(|v| v.abs() > LARGEST);
    let tiny = values.iter().all(|v| v.abs() < SMALLEST);
    let too_small = || values.iter().position(|v| tiny && *v != 0.0);
    too_large.or_else(too_small).or_else(|| match role {
        Role::Time => {
            let pairs = values.iter().zip(values.iter().skip(1));
            let steps: Vec<f64> = pairs.map(|(a, b)| b - a).collect();
            Some(beside_others(&steps, 0.0)? + 1)
        }
        // What is at rest most of the time is usually next to nothing.
        Role::Measured(_) => beside_others(values, 1.0),
    })
}

/// The first value far beyond the usual size, which is taken to be at least so much.
fn beside_others(values: &[f64], least: f64) -> Option<usize> {
    let sizes = || values.iter().map(|v| v.abs());
    let [smallest, largest] = sizes().fold([f64::INFINITY, 0.0_f64], |[low, high], size| {
        [low.min(size), high.max(size)]
    });
    if largest <= MOST_TIMES_USUAL * smallest.max(least) {
        return None;
    }
    let mut sorted: Vec<f64> = sizes().collect();
    let middle = sorted.len() / 2;
    let (_, usual, _) = sorted.select_nth_unstable_by(middle, f64::total_cmp);
    let most = MOST_TIMES_USUAL * usual.max(least);
    sizes().position(|size| size > most)
}
