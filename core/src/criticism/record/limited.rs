//! A sensor at its limit: it shows the same largest or smallest value while what it measures goes on.

use super::held::fresh;
use super::lattice::resolution;
use super::tuning::{AT_ONCE, LEAST_SAMPLES, LEAST_STAY, REPEATED};
use crate::measurement::{Channel, Quantity};

/// Which samples of a channel are at a limit of its sensor; empty where none is. A position at its end may rest there.
pub(in crate::criticism) fn limited(channel: &Channel) -> Vec<bool> {
    let values = &channel.values;
    if channel.quantity == Quantity::Position || fresh(values).is_some() {
        return Vec::new();
    }
    let ends = [
        values.iter().copied().fold(f64::INFINITY, f64::min),
        values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
    ];
    let mut at = vec![false; values.len()];
    // Nothing moves at 0.
    for end in ends.into_iter().filter(|end| *end != 0.0) {
        let rows = rows_at(values, end);
        if rows.iter().map(|(from, to)| to - from).sum::<usize>() >= LEAST_SAMPLES {
            for (from, to) in rows {
                at[from..to].fill(true);
            }
        }
    }
    let others = at.windows(2).filter(|pair| *pair == [false; 2]).count();
    let pairs = values.windows(2).zip(at.windows(2));
    let same = pairs.filter(|(v, at)| v[0] == v[1] && **at == [false; 2]);
    if !at.contains(&true) || same.count() as f64 > REPEATED * others as f64 {
        return Vec::new();
    }
    at
}

/// Begin and end of each row of samples that have come to this value.
fn rows_at(values: &[f64], end: f64) -> Vec<(usize, usize)> {
    let least = AT_ONCE * resolution(values);
    let mut rows = Vec::new();
    let mut from = 0;
    for row in values.chunk_by(|a, b| a == b) {
        let to = from + row.len();
        let came = from > 0 && (end - values[from - 1]).abs() > least;
        if row[0] == end && came && row.len() >= LEAST_STAY {
            rows.push((from, to));
        }
        from = to;
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rig::Random;

    fn channel(quantity: Quantity, values: Vec<f64>) -> Channel {
        Channel {
            name: "v1".to_owned(),
            unit: "rad/s".to_owned(),
            quantity,
            values,
        }
    }

    /// A swing of 1 with noise, limited to this.
    fn swing(limit: f64) -> Vec<f64> {
        let mut random = Random::new(5);
        let mut shown = |i: u32| libm::sin(0.05 * f64::from(i)) + 0.01 * random.normal();
        (0..2000).map(|i| shown(i).clamp(-limit, limit)).collect()
    }

    #[test]
    fn what_stays_at_the_largest_values_is_limited() {
        let values = swing(0.8);
        let at = limited(&channel(Quantity::Velocity, values.clone()));
        let share = at.iter().filter(|a| **a).count() as f64 / 2000.0;
        assert!((share - 0.41).abs() < 0.03, "{share}");
        let shown = values.iter().zip(&at);
        assert!(shown.into_iter().all(|(v, at)| !at || v.abs() == 0.8));
        assert!(limited(&channel(Quantity::Position, values)).is_empty());
    }

    #[test]
    fn noise_and_counts_are_not() {
        assert!(limited(&channel(Quantity::Velocity, swing(2.0))).is_empty());
        let counts = swing(0.8).iter().map(|v| (10.0 * v).round()).collect();
        assert!(limited(&channel(Quantity::Velocity, counts)).is_empty());
    }
}
