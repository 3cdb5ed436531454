//! Sums of products of series that are not simulated all along.

/// Sum over the runs (first sample and end) of `a` with `b` a number of samples later.
pub(super) fn product(a: &[f64], b: &[f64], runs: &[(usize, usize)], lag: usize) -> f64 {
    runs.iter()
        .filter(|(from, to)| to - from > lag)
        .flat_map(|(from, to)| a[*from..to - lag].iter().zip(&b[from + lag..*to]))
        .map(|(a, b)| a * b)
        .sum()
}
