//! Equation (3) as the paper writes it: by the pulse transfer function at `z = -1`.
//!
//! Sampled with the half period `h` and a hold, a plant with the delay `L = m h + L'`, `0 <= L' < h`, has
//!
//! ```text
//! H_h(z) = z^-(m+1) C (z I - e^{Ah})^-1 [z G(h-L') + e^{A(h-L')} G(L')],   G(t) = int_0^t e^{As} ds B
//! ```
//!
//! (Åström and Wittenmark 1997). A symmetric limit cycle is the input `k, -k, k, ...`, which is `z = -1`: its half
//! period solves `H_h(-1) = -eps/k`, the same as `(I + e^{Ah}) x0 = ...`, `C x0 = eps` (Tsypkin 1984; Åström 1995).

use nalgebra::{DMatrix, DVector};

use crate::plant::{MAX_ORDER, StateSpace};
use crate::simulate::Flow;

/// Points of a [`z_form`] curve.
const POINTS: usize = 160;

/// `-H_h(-1)` over the half period `h` in s, from a fifth to three times `guess`; its crossings of `eps/k` are the half
/// periods that balance. Empty for a guess or a lag (s) that is no time.
pub fn z_form(plant: &StateSpace, lag: f64, guess: f64) -> Vec<[f64; 2]> {
    let time = |v: f64| v.is_finite() && v > 0.0;
    if plant.validate().is_err() || !time(guess) || !(lag == 0.0 || time(lag)) {
        return Vec::new();
    }
    let flow = Flow::single(plant, 2.0 * guess);
    let (low, high) = (0.2 * guess, 3.0 * guess);
    (0..=POINTS)
        .map(|i| low + (high - low) * i as f64 / POINTS as f64)
        .filter_map(|h| Some([h, -at_minus_one(&flow, lag, h)?]))
        .collect()
}

/// `H_h(-1)` of a plant with the delay `lag` in s for the half period `h` in s; `None` where the cycle is a mode of the
/// plant, so that it has no value.
pub fn pulse_transfer_at_minus_one(plant: &StateSpace, lag: f64, h: f64) -> Option<f64> {
    let time = |v: f64| v.is_finite() && v > 0.0;
    if plant.validate().is_err() || !time(h) || !(lag == 0.0 || time(lag)) {
        return None;
    }
    at_minus_one(&Flow::single(plant, 2.0 * h), lag, h)
}

fn at_minus_one(flow: &Flow, lag: f64, h: f64) -> Option<f64> {
    let whole = libm::floor(lag / h);
    let rest = (lag - whole * h).clamp(0.0, h);
    let rest_state = [0.0; MAX_ORDER];
    let first = flow.after(&rest_state, &[1.0], h - rest);
    let late = flow.after(&flow.after(&rest_state, &[1.0], rest), &[0.0], h - rest);
    let columns = flow.transition(h);
    let n = flow.n;
    let map = DMatrix::from_fn(n, n, |i, j| columns[j][i] + if i == j { 1.0 } else { 0.0 });
    let right = DVector::from_fn(n, |i, _| late[i] - first[i]);
    let solved = map.lu().solve(&right)?;
    let mut state = rest_state;
    for (s, x) in state.iter_mut().zip(solved.iter()) {
        *s = *x;
    }
    let sign = if whole % 2.0 == 0.0 { 1.0 } else { -1.0 };
    Some(sign * flow.output(&state, 0)).filter(|v| v.is_finite())
}
