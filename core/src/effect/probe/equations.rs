//! Normal equations of the regressions.

use nalgebra::{DMatrix, DVector};

/// Solution of normal equations, of which the lower triangle is given, and what it explains; `None` where an unknown
/// leaves no trace.
pub(super) fn solved(
    mut normal: DMatrix<f64>,
    mut right: DVector<f64>,
) -> Option<(DVector<f64>, f64)> {
    let p = right.len();
    let sizes: Vec<f64> = (0..p).map(|j| f64::sqrt(normal[(j, j)])).collect();
    if sizes.iter().any(|s| !(*s > 0.0 && s.is_finite())) {
        return None;
    }
    for a in 0..p {
        for b in 0..a {
            normal[(a, b)] /= sizes[a] * sizes[b];
            normal[(b, a)] = normal[(a, b)];
        }
        normal[(a, a)] = 1.0 + 1e-9;
        right[a] /= sizes[a];
    }
    let scaled = normal.cholesky()?.solve(&right);
    let explained = scaled.dot(&right);
    let solution = DVector::from_fn(p, |j, _| scaled[j] / sizes[j]);
    let finite = solution.iter().all(|v| v.is_finite());
    finite.then_some((solution, explained))
}

/// One window in how many makes at most `samples`.
pub(super) fn spans_stride(spans: &[(usize, usize)], samples: usize) -> usize {
    let total: usize = spans.iter().map(|(from, to)| to - from).sum();
    total.div_ceil(samples).clamp(1, spans.len().max(1))
}
