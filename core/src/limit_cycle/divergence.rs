//! Can the relay still hold an unstable plant?
//!
//! Along a left eigenvector `w` of a mode with `Re p > 0` the state `z = w x` obeys `z' = p z + w B u`, so that
//! `|z|` grows for ever once `Re p |z| > |w B| max |u|`: no input within the relay's outputs brings it back.

use nalgebra::{DMatrix, DVector};
use num_complex::Complex;

use crate::plant::StateSpace;
use crate::relay::Relay;

/// Distance from the pole at which the inverse iteration solves, as share of the pole's size: far enough from a
/// singular matrix, and so near that three rounds reach round-off.
const SHIFT: f64 = 1e-9;

/// Rounds of the inverse iteration.
const ROUNDS: usize = 3;

/// Modes of a plant with a real part above 0, each with the size beyond which it cannot be held.
pub(super) struct UnstableModes {
    modes: Vec<Mode>,
}

struct Mode {
    left: DVector<Complex<f64>>,
    /// `|w B| max |u| / Re p`.
    holds: f64,
}

impl UnstableModes {
    /// Those of `space` among its `poles`.
    pub fn new(space: &StateSpace, poles: &[Complex<f64>], relay: &Relay) -> Self {
        let push = relay.output(true).abs().max(relay.output(false).abs());
        let unstable = poles.iter().filter(|p| p.re > 0.0 && p.im >= 0.0);
        let modes = unstable
            .filter_map(|pole| {
                let left = left_eigenvector(&space.a, *pole)?;
                let input: Complex<f64> = left.iter().zip(&space.b).map(|(w, b)| w * b).sum();
                let holds = input.norm() * push / pole.re;
                Some(Mode { left, holds })
            })
            .collect();
        Self { modes }
    }

    /// Whether the plant in state `x` runs away whatever the relay does from now on.
    pub fn is_lost(&self, x: &DVector<f64>) -> bool {
        self.modes.iter().any(|mode| {
            let size: Complex<f64> = mode.left.iter().zip(x).map(|(w, x)| w * x).sum();
            size.norm() > mode.holds
        })
    }
}

/// `w` with `w A = p w`, by inverse iteration (Wilkinson 1965).
fn left_eigenvector(a: &DMatrix<f64>, pole: Complex<f64>) -> Option<DVector<Complex<f64>>> {
    let n = a.nrows();
    let shifted = pole + SHIFT * pole.norm();
    let matrix = DMatrix::from_fn(n, n, |i, j| {
        let diagonal = if i == j { shifted } else { Complex::from(0.0) };
        Complex::from(a[(j, i)]) - diagonal
    });
    let lu = matrix.lu();
    let mut w = DVector::from_element(n, Complex::from(1.0));
    for _ in 0..ROUNDS {
        w = lu.solve(&w)?;
        let size = w.norm();
        if !(size.is_finite() && size > 0.0) {
            return None;
        }
        w /= Complex::from(size);
    }
    Some(w)
}
