//! What a motion costs: squared residuals, over all or window by window, plain or robust.

use super::data::Data;
use super::motion::Motion;
use crate::order::quantile;

/// Whether a window has a block that is used for fitting.
pub(super) fn informed_windows(data: &Data) -> Vec<bool> {
    let mut informed = vec![false; data.windows.len()];
    for block in data.blocks.iter().filter(|b| !b.held_back) {
        informed[block.window] = true;
    }
    informed
}

/// Squared residuals in noise units over a run of samples.
pub(super) fn cost_between(data: &Data, motion: &Motion, from: usize, to: usize) -> f64 {
    data.outputs
        .iter()
        .map(|o| {
            (from..to)
                .filter(|i| o.tells(*i))
                .map(|i| (motion.left(o, i) / o.noise).powi(2))
                .sum::<f64>()
        })
        .sum()
}

/// Squared residuals on the fitted part.
pub(super) fn fit_cost(data: &Data, motion: &Motion) -> f64 {
    fitted_costs(data, motion).iter().sum()
}

/// The same of each window.
pub(super) fn fitted_costs(data: &Data, motion: &Motion) -> Vec<f64> {
    let windows = fitted_windows(data, motion);
    windows.into_iter().map(|(cost, _)| cost).collect()
}

/// Mean square of a window, in noise units, from which on it counts by the logarithm.
pub(super) const ODD_MEAN_SQUARE: f64 = 30.0;

/// Cost and number of residuals of each window on the fitted part.
fn fitted_windows(data: &Data, motion: &Motion) -> Vec<(f64, f64)> {
    let mut windows = vec![(0.0, 0.0); data.windows.len()];
    for b in data.blocks.iter().filter(|b| !b.held_back) {
        windows[b.window].0 += cost_between(data, motion, b.from, b.to);
        windows[b.window].1 += data.measured(b.from, b.to) as f64;
    }
    for ((cost, n), prior) in windows.iter_mut().zip(&motion.priors) {
        if *n > 0.0 {
            *cost += prior;
        }
    }
    windows
}

/// Mean square from which a window is odd, in times of that which so many windows stay below: a model that is wrong in
/// more windows than the rest is wrong there too, and is fitted to them, though the input may rest in all others.
const ODD_TIMES: f64 = 3.0;
const USUAL: f64 = 0.6;

/// Mean square from which a window is odd, given how far off all are.
pub(super) fn oddness(data: &Data, motion: &Motion) -> f64 {
    let mut squares: Vec<f64> = fitted_windows(data, motion)
        .into_iter()
        .filter(|(_, n)| *n > 0.0)
        .map(|(cost, n)| cost / n)
        .collect();
    ODD_MEAN_SQUARE.max(ODD_TIMES * quantile(&mut squares, USUAL))
}

/// Squared residuals as if every window were as far off as usual: the mean over windows of
/// `ln(1 + m / K)`, taken back, with `m` the mean square of a window and `K` the `scale` (Cauchy's loss;
/// Huber 1981). For `m` below `K` it is the sum of squares. Where a body sticks, some windows may go wrong
/// by a thousand times the noise whatever the parameters: they must not decide alone.
pub(super) fn robust_cost(data: &Data, motion: &Motion, scale: f64) -> f64 {
    let (mean, count) = mean_logarithm(data, motion, scale);
    count * scale * libm::expm1(mean)
}

/// Change of [`robust_cost`] for a change of the squared residuals as [`window_weights`] weigh them.
pub(super) fn robust_share(data: &Data, motion: &Motion, scale: f64) -> f64 {
    libm::exp(mean_logarithm(data, motion, scale).0)
}

/// Mean over the fitted residuals of `ln(1 + m / scale)` with `m` the mean square of their window, and
/// their number.
fn mean_logarithm(data: &Data, motion: &Motion, scale: f64) -> (f64, f64) {
    let (mut logs, mut count) = (0.0, 0.0);
    for (cost, n) in fitted_windows(data, motion) {
        if n > 0.0 {
            logs += n * libm::log1p(cost / (n * scale));
            count += n;
        }
    }
    (if count > 0.0 { logs / count } else { 0.0 }, count)
}

/// Weight of each window in the normal equations, from the derivative of [`robust_cost`].
pub(super) fn window_weights(data: &Data, motion: &Motion, scale: f64) -> Vec<f64> {
    fitted_windows(data, motion)
        .into_iter()
        .map(|(cost, n)| 1.0 / (1.0 + cost / (n.max(1.0) * scale)))
        .collect()
}

/// Squared residuals of each window on what informs it: the fitted part, or all of a held-back window.
pub(super) fn window_costs(data: &Data, motion: &Motion) -> Vec<f64> {
    let informed = informed_windows(data);
    let mut costs = motion.priors.clone();
    for block in data
        .blocks
        .iter()
        .filter(|b| !(b.held_back && informed[b.window]))
    {
        costs[block.window] += cost_between(data, motion, block.from, block.to);
    }
    costs
}
