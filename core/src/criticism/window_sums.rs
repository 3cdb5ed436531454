//! Sums of one window in the normal equations, and how its state is eliminated from them.

use nalgebra::{DMatrix, DVector, Matrix4, Vector4};

use super::cost::informed_windows;
use super::data::Data;
use crate::model::Start;

/// What a window's state consists of: position and velocity of the body, and of a load that may be off where it is
/// taken to be.
pub(super) const BODY_STATES: usize = 2;
pub(super) const STATES: usize = 4;

/// Sums of one window; those of a load that is not there are 0.
pub(super) struct WindowSums {
    pub state: Matrix4<f64>,
    pub gradient: Vector4<f64>,
    /// One column of mixed second derivatives per value.
    pub mixed: Vec<Vector4<f64>>,
}

impl WindowSums {
    pub fn new(p: usize) -> Self {
        Self {
            state: Matrix4::zeros(),
            gradient: Vector4::zeros(),
            mixed: vec![Vector4::zeros(); p],
        }
    }

    /// Adds a sample with residual `r` and derivatives `s` to the first states and `row` to the values.
    pub fn add<const N: usize>(&mut self, s: [f64; N], row: &[f64], r: f64) {
        for a in 0..N {
            self.gradient[a] += s[a] * r;
            for b in 0..N {
                self.state[(a, b)] += s[a] * s[b];
            }
        }
        for (mixed, value) in self.mixed.iter_mut().zip(row) {
            for a in 0..N {
                mixed[a] += s[a] * value;
            }
        }
    }
}

/// A start as a vector.
pub(super) fn state(start: &Start) -> Vector4<f64> {
    Vector4::new(start.position, start.velocity, start.load[0], start.load[1])
}

/// A start moved by this much.
pub(super) fn changed(start: &Start, change: &Vector4<f64>) -> Start {
    Start {
        sample: start.sample,
        position: start.position + change[0],
        velocity: start.velocity + change[1],
        load: [start.load[0] + change[2], start.load[1] + change[3]],
    }
}

/// The same with a load that is at most `farthest` standard deviations off.
pub(super) fn kept_within(start: Start, farthest: f64) -> Start {
    Start {
        load: start.load.map(|d| d.clamp(-farthest, farthest)),
        ..start
    }
}

/// Inverse of a window's matrix, with a little damping where the state leaves no trace.
pub(super) fn inverse(m: &Matrix4<f64>) -> Matrix4<f64> {
    let mut damped = *m;
    for j in 0..STATES {
        damped[(j, j)] += 1e-10 * m[(j, j)];
        if damped[(j, j)] <= 0.0 {
            damped[(j, j)] = 1.0;
        }
    }
    let body = damped.fixed_view::<BODY_STATES, BODY_STATES>(0, 0);
    if m[(BODY_STATES, BODY_STATES)] > 0.0 {
        return damped
            .cholesky()
            .map_or_else(Matrix4::zeros, |c| c.inverse());
    }
    let mut inverse = Matrix4::zeros();
    let body = body.into_owned().try_inverse().unwrap_or_default();
    inverse
        .fixed_view_mut::<BODY_STATES, BODY_STATES>(0, 0)
        .copy_from(&body);
    inverse
}

/// Normal equations of the values alone, the states eliminated.
pub(super) fn reduced(
    matrix: &DMatrix<f64>,
    gradient: &DVector<f64>,
    windows: &[WindowSums],
    data: &Data,
    p: usize,
) -> (DMatrix<f64>, DVector<f64>) {
    let (mut schur, mut g) = (matrix.clone(), gradient.clone());
    let informed = informed_windows(data);
    for (sums, _) in windows
        .iter()
        .zip(&informed)
        .filter(|(_, informed)| **informed)
    {
        let inv = inverse(&sums.state);
        for a in 0..p {
            let left = inv * sums.mixed[a];
            g[a] -= left.dot(&sums.gradient);
            for b in 0..p {
                schur[(a, b)] -= left.dot(&sums.mixed[b]);
            }
        }
    }
    (schur, g)
}
