//! Do small disturbances of a cycle die out?
//!
//! Disturbances of the state and of the instants of switches are followed through a period. A crossing comes later by
//! `-C dx/(C v)`, `v` the velocity just before; what a clock decides comes at its time, and the end of a hold as late
//! as the switch at its begin. A change of the input that arrives later by `dt` leaves `B (u_before - u_after) dt`. Of
//! a loop without a clock one eigenvalue is 1, that of a shift in time, which is no disturbance.

use std::collections::VecDeque;

use nalgebra::{DMatrix, RowDVector};

use super::pattern::Pattern;
use super::run::Cause;
use crate::simulate::State;

/// Largest modulus of the eigenvalues of the map over one period; `at` are the states at the ends of the positions.
pub(super) fn multiplier(pattern: &Pattern<'_>, durations: &[f64], at: &[State]) -> Option<f64> {
    let (n, motion) = (pattern.loop_.plant.order(), pattern.motion);
    let period: f64 = durations.iter().sum();
    if pattern.loop_.clock().is_some() {
        return largest(motion.transition(n, period), false);
    }
    let (mut u, arrivals) = pattern.arrivals(durations);
    let lag = pattern.loop_.lag();
    // Switches before the begin of the period whose changes arrive in it or later.
    let waiting = waiting(durations, lag);
    let size = n + waiting + 1;
    let unit = |i: usize| RowDVector::from_fn(size, |_, j| if i == j { 1.0 } else { 0.0 });
    let mut state = DMatrix::from_fn(n, size, |i, j| if i == j { 1.0 } else { 0.0 });
    let mut queue: VecDeque<RowDVector<f64>> = (0..waiting).map(|k| unit(n + k)).collect();
    let mut last = unit(n + waiting);
    let (push, row) = (motion.push(n), motion.row(n).transpose());
    let mut arrivals = arrivals.into_iter().peekable();
    let (mut now, mut end) = (0.0, 0.0);
    for (i, duration) in durations.iter().enumerate() {
        end += duration;
        while let Some(arrival) = arrivals.next_if(|a| a.time < end) {
            state = motion.transition(n, arrival.time - now) * state;
            let late = queue.pop_front()?;
            state += &push * (late * (u - arrival.value));
            (now, u) = (arrival.time, arrival.value);
        }
        state = motion.transition(n, end - now) * state;
        now = end;
        if matches!(pattern.causes[i], Cause::Rising | Cause::Falling) {
            let slope = motion.slope(&at[i], u);
            if slope == 0.0 || !slope.is_finite() {
                return None;
            }
            last = (&row * &state) * (-1.0 / slope);
        }
        if lag > 0.0 {
            queue.push_back(last.clone());
        } else {
            let next = pattern.positions[(i + 1) % pattern.positions.len()];
            let value = pattern.loop_.relay.output(next);
            state += &push * (&last * (u - value));
            u = value;
        }
        // Without delay the arrival at this instant is the switch itself.
        while lag == 0.0 && arrivals.next_if(|a| a.time <= end).is_some() {}
    }
    if queue.len() != waiting {
        return None;
    }
    let mut map = DMatrix::zeros(size, size);
    map.rows_mut(0, n).copy_from(&state);
    for (k, late) in queue.iter().enumerate() {
        map.row_mut(n + k).copy_from(late);
    }
    map.row_mut(n + waiting).copy_from(&last);
    largest(map, true)
}

/// Changes on their way at the begin of a period, that of the switch there among them.
fn waiting(durations: &[f64], lag: f64) -> usize {
    let period: f64 = durations.iter().sum();
    let mut begin = 0.0;
    let mut count = 0;
    for duration in durations {
        let mut past = begin;
        while past > -lag {
            count += usize::from(past <= 0.0);
            past -= period;
        }
        begin += duration;
    }
    count
}

/// Largest modulus of the eigenvalues, without the one nearest to 1 where that is of a `shift` in time.
fn largest(map: DMatrix<f64>, shift: bool) -> Option<f64> {
    if map.iter().any(|v| !v.is_finite()) {
        return None;
    }
    let values = nalgebra::Schur::try_new(map, 1e-14, 10_000)?.complex_eigenvalues();
    let mut values: Vec<_> = values.iter().copied().collect();
    if shift {
        let nearest = (0..values.len()).min_by(|a, b| {
            (values[*a] - 1.0)
                .norm()
                .total_cmp(&(values[*b] - 1.0).norm())
        })?;
        values.swap_remove(nearest);
    }
    Some(values.iter().fold(0.0, |m, v| v.norm().max(m)))
}
