//! Linear least squares by scaled normal equations, and residuals that hang together.

use nalgebra::{DMatrix, DVector};

use crate::sums::dot;

/// Share of the diagonal that is added, so that columns that say the same do no harm.
const RIDGE: f64 = 1e-12;

/// Scaled normal equations: the columns' lengths, and their Gram matrix with unit diagonal.
fn gram(columns: &[Vec<f64>]) -> (Vec<f64>, DMatrix<f64>) {
    let lengths: Vec<f64> = columns
        .iter()
        .map(|c| dot(c, c).sqrt().max(f64::MIN_POSITIVE))
        .collect();
    let m = columns.len();
    let mut gram = DMatrix::zeros(m, m);
    for i in 0..m {
        for j in 0..=i {
            let g = dot(&columns[i], &columns[j]) / (lengths[i] * lengths[j]);
            gram[(i, j)] = g;
            gram[(j, i)] = g;
        }
        gram[(i, i)] += RIDGE;
    }
    (lengths, gram)
}

/// Coefficients of the columns whose sum comes nearest to `right`; none where they cannot be told apart.
pub fn least_squares(columns: &[Vec<f64>], right: &[f64]) -> Option<Vec<f64>> {
    let (lengths, gram) = gram(columns);
    let cholesky = gram.cholesky()?;
    let solved = |right: &[f64]| {
        let rhs = DVector::from_iterator(
            columns.len(),
            columns.iter().zip(&lengths).map(|(c, l)| dot(c, right) / l),
        );
        let x = cholesky.solve(&rhs);
        x.iter()
            .zip(&lengths)
            .map(|(x, l)| x / l)
            .collect::<Vec<f64>>()
    };
    let mut x = solved(right);
    // Once more on what is left, which takes off most of the round-off of the normal equations.
    let mut rest = right.to_vec();
    take_off(&mut rest, columns, &x);
    x.iter_mut().zip(solved(&rest)).for_each(|(a, b)| *a += b);
    x.iter().all(|v| v.is_finite()).then_some(x)
}

/// Takes columns with these coefficients off values.
pub fn take_off(values: &mut [f64], columns: &[Vec<f64>], coefficients: &[f64]) {
    for (c, column) in coefficients.iter().zip(columns) {
        values.iter_mut().zip(column).for_each(|(r, v)| *r -= c * v);
    }
}

/// Inverse of the matrix of the columns' products: the covariance of the coefficients by unit variance.
pub fn inverse_gram(columns: &[Vec<f64>]) -> Option<DMatrix<f64>> {
    let (lengths, gram) = gram(columns);
    let inverse = gram.cholesky()?.inverse();
    let m = columns.len();
    Some(DMatrix::from_fn(m, m, |i, j| {
        inverse[(i, j)] / (lengths[i] * lengths[j])
    }))
}

/// A step of Levenberg and Marquardt.
pub fn damped(jacobian: &[Vec<f64>], residuals: &[f64], damping: f64) -> Option<Vec<f64>> {
    let (lengths, mut gram) = gram(jacobian);
    for i in 0..jacobian.len() {
        gram[(i, i)] += damping;
    }
    let rhs = DVector::from_iterator(
        jacobian.len(),
        jacobian
            .iter()
            .zip(&lengths)
            .map(|(c, l)| dot(c, residuals) / l),
    );
    let x = gram.cholesky()?.solve(&rhs);
    Some(x.iter().zip(&lengths).map(|(x, l)| x / l).collect())
}

/// By how much residuals that hang together count less: `1 + 2 sum of autocorrelations`, summed until the first that is
/// not above 0; at least 1.
pub fn coherence(residuals: &[f64]) -> f64 {
    let n = residuals.len();
    let own = dot(residuals, residuals);
    if own <= 0.0 {
        return 1.0;
    }
    let mut sum = 1.0;
    for lag in 1..n / 4 {
        let r = dot(&residuals[lag..], &residuals[..n - lag]) / own;
        if r <= 0.0 {
            break;
        }
        sum += 2.0 * r;
    }
    sum
}
