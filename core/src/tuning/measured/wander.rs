//! Residuals that wander: a level that moves at random under the noise of the sensor.
//!
//! Simple exponential smoothing is the best forecast of a random walk seen through noise (Muth 1960); what it leaves is
//! white. Least squares on series so filtered gives a second estimate of the same parameters, which weighs what is fast
//! higher and what is slow lower. A model that is right gives the same either way.

use crate::sums::dot;

/// Shares of each surprise by which the level is moved, as tried.
const TRIED: [f64; 6] = [0.01, 0.03, 0.1, 0.3, 0.6, 1.0];

/// Takes off what exponential smoothing expects; nothing where `share` is 0.
pub(super) fn follow(values: &mut [f64], share: f64) {
    if share <= 0.0 {
        return;
    }
    let mut level = 0.0;
    for value in values {
        *value -= level;
        level += share * *value;
    }
}

/// By which share the level of the residuals is best followed; none where it does not wander.
pub(super) fn share(residuals: &[f64]) -> Option<f64> {
    let cost = |share: f64| {
        let mut left = residuals.to_vec();
        follow(&mut left, share);
        dot(&left, &left)
    };
    let still = cost(0.0);
    let best =
        (TRIED.into_iter().map(|share| (share, cost(share)))).min_by(|a, b| a.1.total_cmp(&b.1))?;
    // Schwarz's criterion for one more parameter.
    let count = residuals.len() as f64;
    (still > 0.0 && best.1 * libm::pow(count, 1.0 / count) < still).then_some(best.0)
}
