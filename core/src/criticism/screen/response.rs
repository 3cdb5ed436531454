//! Does the motion follow from the input, whatever the machine is? Asked before an input is doubted.
//!
//! The equation of motion is tested on the acceleration, which a coarse sensor hides, and which is not what a force
//! balances where a body sticks or a spring holds it. So an input is not doubted by that alone: here it is asked with
//! fewer assumptions.

use super::gram::Reduced;
use super::signals::Signals;
use super::tuning::{BLOCKS, LAGS, PAST, PATIENCE};
use super::window::Width;
use crate::measurement::Kind;

/// Work that the input did on a drive: the most in one go, and the most that came back in one go. A machine gives back
/// no more than it has stored, so that the first is larger the longer it runs, whatever it is made of; the other way
/// round where the sign of the input is turned. Of an input that did not act, both are as chance has it.
pub(super) fn work(signals: &Signals) -> [f64; 2] {
    let (mut sum, mut least, mut most) = (0.0, 0.0_f64, 0.0_f64);
    let mut largest = [0.0_f64; 2];
    for k in 1..signals.len() {
        if !signals.is_one_run(k - 1, k) {
            continue;
        }
        let moved = match (&signals.position, &signals.velocity) {
            (Some(x), _) => x.values[k] - x.values[k - 1],
            (None, Some(v)) => signals.step * f64::midpoint(v.values[k], v.values[k - 1]),
            (None, None) => 0.0,
        };
        sum += signals.input[k - 1] * moved;
        (least, most) = (least.min(sum), most.max(sum));
        largest = [largest[0].max(sum - least), largest[1].max(most - sum)];
    }
    largest
}

/// Share of the velocity of a drive, or of the output of a process about its mean, that one lag or two of the input
/// leave, on blocks that were held back: the least of all widths of windows, since noise hides in short ones what wide
/// ones show.
pub(super) fn left_by_lags(signals: &Signals, widths: &[Width]) -> f64 {
    let longest = signals.len() as f64 * signals.step / PATIENCE;
    let constants = (0..LAGS).map(|k| {
        let share = k as f64 / (LAGS - 1) as f64;
        signals.step * libm::pow(longest / signals.step, share)
    });
    let lags: Vec<Vec<f64>> = constants.map(|t| lagged(signals, t)).collect();
    let ones = vec![1.0; signals.len()];
    let left = widths.iter().map(|width| {
        let mut columns: Vec<Vec<f64>> = lags
            .iter()
            .map(|l| width.integrals(l, 0).collect())
            .collect();
        columns.push(width.integrals(&ones, 0).collect());
        columns.push(match (signals.kind, &signals.velocity) {
            (Kind::Process, Some(output)) => width.integrals(&output.values, 0).collect(),
            _ => width.motion(signals, 1),
        });
        let middles = width.starts.iter().map(|start| start + width.length / 2);
        let halves = halves(&columns, middles.map(|k| k * BLOCKS / signals.len()));
        let chosen = (0..LAGS).map(|a| vec![a, LAGS]);
        let pairs = (0..LAGS).flat_map(|a| (a + 1..LAGS).map(move |b| vec![a, b, LAGS]));
        held_out(&halves, columns.len(), &[chosen.collect(), pairs.collect()])
            / held_out(&halves, columns.len(), &[vec![vec![LAGS]]])
    });
    left.filter(|left| left.is_finite())
        .fold(1.0, f64::min)
        .sqrt()
}

/// By what share the error of a forecast of the next output from those before falls where the inputs are known too, on
/// blocks that were held back (Granger 1969): an input that acts through resonances is seen so, which lags do not
/// imitate.
pub(super) fn left_of_forecast(signals: &Signals) -> f64 {
    let Some(output) = signals.velocity.as_ref().map(|o| o.values.as_slice()) else {
        return 1.0;
    };
    let told: Vec<usize> = (PAST..signals.len())
        .filter(|k| signals.is_one_run(k - PAST, *k))
        .collect();
    let before =
        |values: &[f64], by: usize| told.iter().map(|k| values[k - by]).collect::<Vec<f64>>();
    let mut columns: Vec<Vec<f64>> = vec![vec![1.0; told.len()]];
    columns.extend((1..=PAST).map(|by| before(output, by)));
    columns.extend((0..=PAST).map(|by| before(&signals.input, by)));
    columns.push(before(output, 0));
    let halves = halves(&columns, told.iter().map(|k| k * BLOCKS / signals.len()));
    let by = |count: usize| held_out(&halves, columns.len(), &[vec![(0..count).collect()]]);
    let share = (by(columns.len() - 1) / by(1 + PAST)).sqrt();
    if share.is_finite() { share } else { 1.0 }
}

/// The input through a lag with this time constant, which begins where it stands at the beginning of each run.
fn lagged(signals: &Signals, constant: f64) -> Vec<f64> {
    let keeps = libm::exp(-signals.step / constant);
    let one_run = |(from, to): (usize, usize)| {
        let input = &signals.input[from..to];
        let mut state = input.first().copied().unwrap_or(0.0);
        let next = move |u: &f64| {
            let now = state;
            state = keeps * state + (1.0 - keeps) * u;
            now
        };
        input.iter().map(next).collect::<Vec<f64>>()
    };
    signals.runs().flat_map(one_run).collect()
}

/// Sums of products of columns in even and in odd blocks.
fn halves(columns: &[Vec<f64>], blocks: impl Iterator<Item = usize>) -> [Vec<f64>; 2] {
    let n = columns.len();
    let mut halves = [vec![0.0; n * n], vec![0.0; n * n]];
    for (row, block) in blocks.enumerate() {
        let half = &mut halves[block % 2];
        for (i, a) in columns.iter().enumerate() {
            for (j, b) in columns.iter().enumerate() {
                half[i * n + j] += a[row] * b[row];
            }
        }
    }
    halves
}

/// What a regression of the last of so many columns leaves of the half that it did not see: of each family of choices
/// of columns the one that leaves least of the half that it did, and of the families the best.
fn held_out(halves: &[Vec<f64>; 2], size: usize, families: &[Vec<Vec<usize>>]) -> f64 {
    let of = |sums: &[f64], chosen: &[usize]| {
        let target = [size - 1];
        let elements = chosen.iter().chain(&target).map(|c| vec![*c]);
        Reduced::new(sums, size, &elements.collect::<Vec<_>>())
    };
    let left = |family: &Vec<Vec<usize>>| -> f64 {
        let of_half = |fitted: usize| {
            let fits = family.iter().filter_map(|chosen| {
                let seen = of(&halves[fitted], chosen);
                let w = seen.coefficients(&seen.solve(false)?);
                Some((seen.loss(&w), of(&halves[1 - fitted], chosen).loss(&w)))
            });
            let best = fits.min_by(|a, b| a.0.total_cmp(&b.0));
            best.map_or(f64::INFINITY, |(_, left)| left)
        };
        of_half(0) + of_half(1)
    };
    families.iter().map(left).fold(f64::INFINITY, f64::min)
}
