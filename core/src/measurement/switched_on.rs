//! A step from rest of which the row before the step is not in the file: the input is the same in all rows.

use super::{Channel, Quantity};
use crate::message::Message;

/// Share of the largest velocity, and of the average one by the position, that a body still at rest has at most.
const SLOW: f64 = 0.2;
const BARELY: f64 = 0.5;

/// A position is looked at over this share of the record for it.
const BEGIN: usize = 100;

/// Steps of noise by which the output of a process moves at least.
const MOVES: f64 = 5.0;

/// Puts a row at rest without input before the first where the input is constant and all that was measured begins at
/// rest, and says so.
pub(super) fn from_rest(
    time: &mut Vec<f64>,
    input: &mut Channel,
    outputs: &mut [Channel],
    reference: &mut [Channel],
) -> Option<Message> {
    let u = *input.values.first()?;
    let constant = u != 0.0 && input.values.iter().all(|value| *value == u);
    if !constant || !outputs.iter().all(|output| begins_at_rest(time, output)) {
        return None;
    }
    let mut steps: Vec<f64> = time.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let middle = steps.len() / 2;
    let usual = *steps.select_nth_unstable_by(middle, f64::total_cmp).1;
    time.insert(0, time[0] - usual);
    input.values.insert(0, 0.0);
    for channel in outputs.iter_mut().chain(reference) {
        let rest = match channel.quantity {
            Quantity::Velocity | Quantity::LoadVelocity => 0.0,
            _ => channel.values.first().copied().unwrap_or_default(),
        };
        channel.values.insert(0, rest);
    }
    let said = "The input is constant: taken as switched on with the first row, with everything at rest before; \
                a row without input is put before it.";
    Some(said.into())
}

/// Whether what was measured is at rest at first, as far as it can be seen, and moves later.
fn begins_at_rest(time: &[f64], output: &Channel) -> bool {
    let values = output.values.as_slice();
    let (Some(first), Some(last)) = (values.first(), values.last()) else {
        return false;
    };
    match output.quantity {
        Quantity::Velocity => {
            let fastest = values.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
            fastest > 0.0 && first.abs() <= SLOW * fastest
        }
        Quantity::Position => {
            let speed =
                |from: usize, to: usize| (values[to] - values[from]) / (time[to] - time[from]);
            let end = values.len() - 1;
            let average = speed(0, end);
            average != 0.0 && (speed(0, (end / BEGIN).max(1)) / average).abs() <= BARELY
        }
        _ => {
            let squares = values.windows(2).map(|pair| (pair[1] - pair[0]).powi(2));
            let noise = (squares.sum::<f64>() / values.len() as f64).sqrt();
            (last - first).abs() > MOVES * noise
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn channel(quantity: Quantity, values: Vec<f64>) -> Channel {
        Channel {
            quantity,
            name: String::new(),
            unit: String::new(),
            values,
        }
    }

    /// What becomes of a record with this input and output, of an eighth of a second a sample.
    fn read(
        quantity: Quantity,
        input: f64,
        value: impl Fn(f64) -> f64,
    ) -> (usize, Option<[f64; 3]>) {
        let mut time: Vec<f64> = (0..200).map(|k| 0.125 * f64::from(k)).collect();
        let mut outputs = [channel(quantity, time.iter().map(|t| value(*t)).collect())];
        let mut input = channel(Quantity::Input, vec![input; 200]);
        let said = from_rest(&mut time, &mut input, &mut outputs, &mut []);
        let first = [time[0], input.values[0], outputs[0].values[0]];
        (time.len(), said.map(|_| first))
    }

    fn grown(t: f64) -> f64 {
        1.0 - libm::exp(-t / 2.0)
    }

    #[test]
    fn a_step_from_rest_gets_the_row_before_it() {
        let rest = |y: f64| (201, Some([-0.125, 0.0, y]));
        assert_eq!(read(Quantity::Velocity, 3.0, grown), rest(0.0));
        assert_eq!(read(Quantity::Velocity, -3.0, |t| -grown(t)), rest(0.0));
        let way = |t: f64| 7.0 + t - 2.0 * grown(t);
        assert_eq!(read(Quantity::Position, 3.0, way), rest(7.0));
        assert_eq!(read(Quantity::Output, 3.0, |t| 21.0 + grown(t)), rest(21.0));
    }

    #[test]
    fn what_moves_from_the_first_or_not_at_all_or_without_input_is_left() {
        let left = (200, None);
        assert_eq!(
            read(Quantity::Velocity, 3.0, |t| 1.0 - 0.5 * grown(t)),
            left
        );
        assert_eq!(read(Quantity::Position, 3.0, |t| 3.0 * t - grown(t)), left);
        assert_eq!(read(Quantity::Output, 3.0, |t| libm::sin(1e4 * t)), left);
        assert_eq!(read(Quantity::Output, 0.0, grown), left);
        assert_eq!(read(Quantity::Velocity, 3.0, |_| 0.0), left);
    }
}
