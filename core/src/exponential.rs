//! Exponential of a matrix.

use nalgebra::DMatrix;

/// Norm up to which the series is summed.
const SHORT: f64 = 0.5;

/// The next term is round-off: `0.5^15/15!`.
const TERMS: i32 = 14;

/// Matrix exponential: a Taylor series of `m / 2^k`, squared `k` times (Moler and Van Loan 2003,
/// methods 1 and 3). Not a number where `m` is not finite.
pub(crate) fn exponential(m: DMatrix<f64>) -> DMatrix<f64> {
    let norm: f64 = m.iter().map(|v| v.abs()).sum();
    if !norm.is_finite() {
        return m.map(|_| f64::NAN);
    }
    let doublings = libm::log2(norm / SHORT).ceil().max(0.0) as i32;
    let short = m * 0.5_f64.powi(doublings);
    let n = short.nrows();
    let (mut sum, mut term) = (DMatrix::identity(n, n), DMatrix::identity(n, n));
    for k in 1..=TERMS {
        term = &term * &short / f64::from(k);
        sum += &term;
    }
    for _ in 0..doublings {
        sum = &sum * &sum;
    }
    sum
}
