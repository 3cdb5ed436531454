//! Records of processes that were sampled far faster than anything in them moves: means stand for them.

use super::{Channel, Kind};
use crate::message::Message;
use crate::msg;

/// Samples from which a record is long, and fewest that are left of one.
const LONG: usize = 20_000;
const LEAST: usize = 5_000;

/// Share of the power of the input that means may lose.
const LOST: f64 = 0.005;

/// Stretches in each of which means are compared with what they stand for, how many times the square of the noise they
/// may leave, and the share of stretches, one in so many, in which something stands out for other reasons.
const STRETCHES: usize = 2000;
const LEFT: f64 = 3.0;
const ODD: usize = 500;

/// Share of its whole way that an output may go in so many means: a time constant has some hundred and forty of them.
const WAY: f64 = 0.3;
const MEANS: usize = 50;

/// Share of the samples from which the output of a process stands still: a sensor holds it.
const HELD: f64 = 0.8;

/// Times of the usual step in time above which rows are missing.
const GAP: f64 = 8.0;

/// Puts means of so many samples in the place of a long record of a process where nothing but noise is lost by it, and
/// says so. The input is the mean of what was held from one time to the next, and an output the mean around its time.
pub(super) fn thin(
    kind: Kind,
    time: &mut Vec<f64>,
    input: &mut Channel,
    outputs: &mut [Channel],
) -> Option<Message> {
    let n = time.len();
    if kind != Kind::Process || n <= LONG || has_gap(time) || outputs.iter().any(is_held) {
        return None;
    }
    let sums = Sums::of(&input.values);
    let sums_of_outputs: Vec<Sums> = outputs.iter().map(|o| Sums::of(&o.values)).collect();
    let each = || {
        outputs
            .iter()
            .map(|o| o.values.as_slice())
            .zip(&sums_of_outputs)
    };
    let noise: Vec<Vec<f64>> = each().map(|(values, _)| roughness(values)).collect();
    let mut every = 1;
    while n / (2 * every) >= LEAST && lost(&input.values, &sums, 2 * every) <= LOST {
        let slow = sums_of_outputs.iter().all(|sums| is_slow(sums, 2 * every));
        let mut pairs = each().zip(&noise);
        let noisy = |((y, sums), noise): ((&[f64], &Sums), &Vec<f64>)| {
            is_noise(noise, &left_by(y, sums, 2 * every))
        };
        if !slow || !pairs.all(noisy) {
            break;
        }
        every *= 2;
    }
    if every == 1 {
        return None;
    }
    let places = || (0..n).step_by(every);
    for (output, sums) in outputs.iter_mut().zip(&sums_of_outputs) {
        output.values = places().map(|at| sums.around(at, every)).collect();
    }
    input.values = places()
        .map(|at| sums.mean(at, (at + every).min(n)))
        .collect();
    *time = places().map(|at| time[at]).collect();
    Some(msg!(
        "The record has {} samples, many more than its motion needs: each {} of them are averaged into one.",
        n,
        every
    ))
}

/// Sums of values up to each place, less the first of them, which keeps digits.
struct Sums {
    first: f64,
    sums: Vec<f64>,
}

impl Sums {
    fn of(values: &[f64]) -> Self {
        let first = values.first().copied().unwrap_or_default();
        let mut sum = 0.0;
        let rest = values.iter().map(|value| {
            sum += value - first;
            sum
        });
        Self {
            first,
            sums: std::iter::once(0.0).chain(rest).collect(),
        }
    }

    fn mean(&self, from: usize, to: usize) -> f64 {
        self.first + (self.sums[to] - self.sums[from]) / (to - from) as f64
    }

    /// The mean around a place of about so many; of fewer at the ends.
    fn around(&self, at: usize, every: usize) -> f64 {
        let n = self.sums.len() - 1;
        let half = every / 2;
        self.mean(at.saturating_sub(half), (at + half + 1).min(n))
    }
}

/// Share of the power of values that their means lose.
fn lost(values: &[f64], sums: &Sums, every: usize) -> f64 {
    let n = values.len();
    let about = |mean: f64, values: &[f64]| values.iter().map(|v| (v - mean).powi(2)).sum::<f64>();
    let whole = about(sums.mean(0, n), values);
    let parts = values.chunks(every).enumerate();
    let inside = parts.map(|(k, part)| about(sums.mean(k * every, k * every + part.len()), part));
    inside.sum::<f64>() / whole.max(f64::MIN_POSITIVE)
}

/// Whether means go a small share of the whole way in many of them.
fn is_slow(sums: &Sums, every: usize) -> bool {
    let places = (0..sums.sums.len() - 1).step_by(every);
    let means: Vec<f64> = places.map(|at| sums.around(at, every)).collect();
    let [low, high] = means
        .iter()
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], m| {
            [low.min(*m), high.max(*m)]
        });
    let mut ways = means.iter().zip(means.iter().skip(MEANS));
    ways.all(|(one, later)| (later - one).abs() <= WAY * (high - low))
}

/// Mean squares of what straight lines between the means leave, by stretches.
fn left_by(values: &[f64], sums: &Sums, every: usize) -> Vec<f64> {
    let n = values.len();
    let left = |at: usize| {
        let from = at / every * every;
        let to = (from + every).min(n - 1);
        let [one, other] = [from, to].map(|place| sums.around(place, every));
        let share = (at - from) as f64 / (to - from).max(1) as f64;
        (values[at] - one - share * (other - one)).powi(2)
    };
    by_stretches(n, left)
}

/// The noise that a sample has by its difference from the next, by stretches.
fn roughness(values: &[f64]) -> Vec<f64> {
    by_stretches(values.len() - 1, |at| {
        0.5 * (values[at + 1] - values[at]).powi(2)
    })
}

fn by_stretches(n: usize, square: impl Fn(usize) -> f64) -> Vec<f64> {
    let length = n.div_ceil(STRETCHES);
    let stretches = (0..n)
        .step_by(length)
        .map(|from| from..(from + length).min(n));
    let mean = |stretch: std::ops::Range<usize>| {
        let samples = stretch.len() as f64;
        stretch.map(&square).sum::<f64>() / samples
    };
    stretches.map(mean).collect()
}

/// Whether what is left is no more than noise, but for a few stretches.
fn is_noise(noise: &[f64], left: &[f64]) -> bool {
    let usual = noise.iter().sum::<f64>() / noise.len() as f64;
    let pairs = noise.iter().zip(left);
    let odd = pairs.filter(|(noise, left)| **left > LEFT * noise.max(usual));
    odd.count() * ODD <= noise.len()
}

fn has_gap(time: &[f64]) -> bool {
    let mut steps: Vec<f64> = time.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let longest = steps.iter().fold(0.0_f64, |most, step| most.max(*step));
    let middle = steps.len() / 2;
    longest > GAP * *steps.select_nth_unstable_by(middle, f64::total_cmp).1
}

fn is_held(output: &Channel) -> bool {
    let same = output.values.windows(2).filter(|pair| pair[0] == pair[1]);
    same.count() as f64 > HELD * output.values.len() as f64
}

#[cfg(test)]
mod tests {
    use super::super::Quantity;
    use super::*;
    use crate::random::Random;

    const SAMPLES: usize = 48_000;
    const NOISE: f64 = 0.02;

    /// Samples that are left of a process with a time constant of so many, whose input goes up and down every `half`,
    /// and how far its output is off there, at most.
    fn left(constant: f64, half: usize) -> (usize, f64) {
        let mut random = Random::new(3);
        let mut time: Vec<f64> = (0..SAMPLES).map(|k| 0.05 * k as f64).collect();
        let u: Vec<f64> = (0..SAMPLES).map(|k| (k / half % 2) as f64).collect();
        let mut y = 0.0;
        let clean: Vec<f64> = u
            .iter()
            .map(|u| {
                let now = y;
                y += (u - y) * (1.0 - libm::exp(-1.0 / constant));
                now
            })
            .collect();
        let noisy = clean.iter().map(|y| y + NOISE * random.normal()).collect();
        let channel = |quantity, values| Channel {
            quantity,
            name: String::new(),
            unit: String::new(),
            values,
        };
        let mut input = channel(Quantity::Input, u);
        let mut outputs = [channel(Quantity::Output, noisy)];
        let said = thin(Kind::Process, &mut time, &mut input, &mut outputs);
        let n = time.len();
        assert_eq!(said.is_some(), n < SAMPLES);
        assert_eq!([n; 2], [input.values.len(), outputs[0].values.len()]);
        let every = SAMPLES / n;
        let off = outputs[0].values.iter().zip(clean.iter().step_by(every));
        let off = off.map(|(mean, y)| (mean - y).abs()).fold(0.0, f64::max);
        (n, off)
    }

    #[test]
    fn means_stand_for_a_record_in_which_everything_is_slow() {
        let (n, off) = left(3000.0, 9000);
        assert_eq!(n, SAMPLES / 8);
        // Of eight, and five times their deviation.
        assert!(off < 5.0 * NOISE / 8.0_f64.sqrt(), "{off}");
    }

    #[test]
    fn a_process_that_moves_or_is_moved_fast_is_left() {
        assert_eq!(left(100.0, 9000).0, SAMPLES);
        assert_eq!(left(3000.0, 75).0, SAMPLES);
    }

    #[test]
    fn a_process_in_between_keeps_what_moves() {
        let (n, off) = left(600.0, 9000);
        assert_eq!(n, SAMPLES / 4);
        assert!(off < 5.0 * NOISE / 2.0, "{off}");
    }
}
