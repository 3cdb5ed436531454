//! Sums of products of series that are not simulated all along.

use crate::sums::dot;

/// Sum over the runs (first sample and end) of `a` with `b` a number of samples later.
pub(super) fn product(a: &[f64], b: &[f64], runs: &[(usize, usize)], lag: usize) -> f64 {
    runs.iter()
        .filter(|(from, to)| to - from > lag)
        .map(|(from, to)| dot(&a[*from..to - lag], &b[from + lag..*to]))
        .sum()
}
