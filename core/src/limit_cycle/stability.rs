//! Do small disturbances of a limit cycle die out?
//!
//! From switch to switch a disturbance obeys `dx' = (I - w C/(C w)) e^{Ah} dx`, `w` the velocity just before
//! the switch (Åström 1995). Where the delay is longer than the time between switches, the instants of
//! the changes that are still on their way belong to the state of the loop and are carried along.

use nalgebra::DMatrix;

use super::history::History;
use crate::relay::Relay;
use crate::simulate::{Flow, State};

/// Largest modulus of the eigenvalues of the Poincare map over one period, from rise to rise; `at` are
/// the states at the fall and at the next rise. `None` where the output only touches the threshold.
pub(super) fn multiplier(
    flow: &Flow,
    relay: &Relay,
    lag: f64,
    durations: [f64; 2],
    history: &History,
    at: [&State; 2],
) -> Option<f64> {
    let n = flow.n;
    let mut input = history.input;
    let mut pending: Vec<(f64, f64)> = Vec::with_capacity(history.pending.len() + 1);
    for change in &history.pending {
        pending.push((change.time, change.value));
    }
    let size = n + pending.len();
    let mut map = DMatrix::identity(size, size);
    for (k, (h, x)) in durations.into_iter().zip(at).enumerate() {
        let next = phase(flow, h, x, &mut input, &mut pending)?;
        map = next * map;
        let value = relay.output(k == 1);
        if lag > 0.0 {
            pending.push((lag, value));
            let rows = map.nrows();
            map = map.insert_row(rows, 0.0);
        } else {
            input = value;
        }
    }
    if !map.is_square() || map.iter().any(|v| !v.is_finite()) {
        return None;
    }
    let schur = nalgebra::Schur::try_new(map, 1e-14, 10_000)?;
    let values = schur.complex_eigenvalues();
    Some(values.iter().fold(0.0, |m, v| v.norm().max(m)))
}

/// From just after one switch to the next, `h` s later in state `x`: from disturbances of the state and of
/// the changes on their way to those of the state at the switch and of the changes that are left.
fn phase(
    flow: &Flow,
    h: f64,
    x: &State,
    input: &mut f64,
    pending: &mut Vec<(f64, f64)>,
) -> Option<DMatrix<f64>> {
    let n = flow.n;
    let before = n + pending.len();
    let arriving = pending
        .iter()
        .take_while(|p| p.0 < h * (1.0 - 1e-13))
        .count();
    let mut columns = flow.transition(h);
    columns.truncate(n);
    for (time, value) in pending.drain(..arriving) {
        // Later by dt: the input before acts longer.
        let jump = flow.force(&[*input - value]);
        columns.push(flow.after(&jump, &[0.0], h - time));
        *input = value;
    }
    let velocity = flow.velocity(x, &[*input]);
    let rate = flow.output(&velocity, 0);
    if rate == 0.0 || !rate.is_finite() {
        return None;
    }
    let after = n + pending.len();
    let mut map = DMatrix::zeros(after, before);
    for (j, column) in columns.iter().enumerate() {
        let late = -flow.output(column, 0) / rate;
        for i in 0..n {
            map[(i, j)] = column[i] + velocity[i] * late;
        }
        for k in 0..pending.len() {
            map[(n + k, j)] = -late;
        }
    }
    for (k, p) in pending.iter_mut().enumerate() {
        map[(n + k, n + arriving + k)] += 1.0;
        p.0 -= h;
    }
    Some(map)
}
