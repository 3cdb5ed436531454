//! Exact steps of a linear system.

use nalgebra::{DMatrix, DVector};

use crate::plant::StateSpace;

/// Norm up to which the series is summed.
const SHORT: f64 = 0.5;

/// The next term is round-off: `0.5^15/15!`.
const TERMS: i32 = 14;

/// Transition matrix and response to a unit input over `span` seconds, the input held.
pub(super) fn held(space: &StateSpace, span: f64) -> (DMatrix<f64>, DVector<f64>) {
    let (phi, mut gammas) = polynomial(&space.a, &space.b, span, 1);
    (phi, gammas.swap_remove(0))
}

/// Transition matrix of `x' = A x + B u` over `span` seconds and the responses to the inputs
/// `u = s^k/k!`, `k < degrees`, `s` the share of the span that has passed.
///
/// By one matrix exponential: a chain of `degrees` integrators makes the input (Van Loan 1978).
pub(super) fn polynomial(
    a: &DMatrix<f64>,
    b: &DVector<f64>,
    span: f64,
    degrees: usize,
) -> (DMatrix<f64>, Vec<DVector<f64>>) {
    let n = b.len();
    let mut m = DMatrix::zeros(n + degrees, n + degrees);
    m.view_mut((0, 0), (n, n)).copy_from(&(a * span));
    m.view_mut((0, n), (n, 1)).copy_from(&(b * span));
    for k in 1..degrees {
        m[(n + k - 1, n + k)] = 1.0;
    }
    let e = exponential(m);
    (
        e.view((0, 0), (n, n)).into_owned(),
        (0..degrees)
            .map(|k| e.view((0, n + k), (n, 1)).column(0).into_owned())
            .collect(),
    )
}

/// Matrix exponential: a Taylor series of `m / 2^k`, squared `k` times (Moler and Van Loan 2003,
/// methods 1 and 3). Not a number where `m` is not finite.
fn exponential(m: DMatrix<f64>) -> DMatrix<f64> {
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
