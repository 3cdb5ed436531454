//! Exact steps of a linear system.

use nalgebra::{DMatrix, DVector};

use crate::exponential::exponential;
use crate::plant::StateSpace;

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
