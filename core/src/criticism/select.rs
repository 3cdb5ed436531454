//! Is what a model leaves noise, or a trifle, and does a step explain more than it leaves?

use super::score::Score;

/// Error, in noise units, and autocorrelation up to which a residual is noise: the noise level
/// itself is known to some per cent only.
const NOISE_ERROR: f64 = 1.15;
const NOISE_CORRELATION: f64 = 2.0;

/// Error on the fitted part up to which what is left there is noise too: an effect that acts now and then may miss the
/// held-back part.
const FITTED_NOISE_ERROR: f64 = 1.3;

/// Standard deviations by which the size of a residual of few values may differ from that of the noise.
pub(super) const CHANCE: f64 = 3.0;

/// Error up to which what is left is noise even if it is correlated.
const SURE_NOISE_ERROR: f64 = 1.05;

/// A model that explains all but this share of the error that there was, down to this many times the
/// noise, is complete: no clock, no rig and no equation is right to more digits.
pub(super) const SMALL_SHARE: f64 = 2e-3;
const SMALL_ERROR: f64 = 3.0;

/// The same share where the input is known at its samples only, and what it did between them was found from the rest: a
/// straight line between two samples is off by a quarter of their distance in radians, of what the shift does; this is
/// that of an input with twelve samples to a radian.
pub(super) const SAMPLED_SHARE: f64 = 2e-2;

/// Share of the held-back blocks that may be more than noise, and share of the error there that may be
/// left, where a model explains all the rest.
const ODD_STRETCHES: f64 = 0.35;
pub(super) const STRETCH_SHARE: f64 = 0.02;

/// Whether the step from the error `before` to that `after` it explains more than it leaves beyond the noise.
pub(super) fn outweighs(before: f64, after: f64) -> bool {
    let explained = before.powi(2) - after.powi(2);
    explained > after.powi(2) - 1.0
}

/// Error up to which a residual of so many values may be noise, where it may be up to `usual` in a long record: its
/// size and that of the noise, of as many values, are each known to so much only.
fn noise_error(usual: f64, count: f64) -> f64 {
    usual.max(1.0 + CHANCE * (1.0 / count).sqrt())
}

/// Whether what is left looks like noise in itself.
pub(super) fn is_plain_noise(score: &Score) -> bool {
    let most = noise_error(NOISE_ERROR, score.held_count);
    let uncorrelated = score.error < most && score.correlation < NOISE_CORRELATION;
    score.error_fit < noise_error(FITTED_NOISE_ERROR, score.fit_count)
        && (score.error < SURE_NOISE_ERROR || score.within_counts || uncorrelated)
}

/// Whether a model says all that counters show: what is left lies within their steps, which repeat with the motion, so
/// that any effect may lower it a little.
pub(super) fn is_all_that_counters_show(score: &Score) -> bool {
    score.within_counts && score.error < 1.0 && score.error_fit < 1.0
}

/// Whether what is left is noise, or a `small` share of what the baseline left at first.
pub(super) fn is_noise(score: &Score, first: &Score, small: f64) -> bool {
    is_plain_noise(score)
        || (!is_unseen_by_the_judge(score, first)
            && ((score.error < SMALL_ERROR && is_trifle(score.error, first, small))
                || is_noise_but_for_stretches(score, first, small)))
}

/// Whether the fitted part is left with more than noise, and more than odd stretches of what was there at `first`: what
/// acts once may miss the held-back part altogether.
fn is_unseen_by_the_judge(score: &Score, first: &Score) -> bool {
    let beyond = (score.error_fit.powi(2) - 1.0).max(0.0).sqrt();
    score.error_fit >= FITTED_NOISE_ERROR && beyond > STRETCH_SHARE * first.error_fit
}

/// Whether what is left beyond the noise is a `small` share of what there was at `first`, though it may be many times
/// the noise: the effects found are the right ones.
pub(super) fn is_trifle(error: f64, first: &Score, small: f64) -> bool {
    (error.powi(2) - 1.0).max(0.0).sqrt() < small * first.error
}

/// Whether the held-back blocks are noise, or a trifle more, but for a few, and these are explained to two hundredths
/// of what was there: where dry friction lets go depends on less than an encoder sees.
fn is_noise_but_for_stretches(score: &Score, first: &Score, small: f64) -> bool {
    if score.held_blocks.len() != first.held_blocks.len() {
        return false;
    }
    let pairs = || score.held_blocks.iter().zip(&first.held_blocks);
    let noisy = |m: &f64| {
        *m < NOISE_ERROR * NOISE_ERROR
            || (*m < SMALL_ERROR * SMALL_ERROR && is_trifle(m.sqrt(), first, small))
    };
    let odd = pairs().filter(|(m, _)| !noisy(m)).count();
    let explained = |(m, f): (&f64, &f64)| noisy(m) || *m < STRETCH_SHARE * STRETCH_SHARE * f;
    odd as f64 <= ODD_STRETCHES * score.held_blocks.len() as f64 && pairs().all(explained)
}

/// Change of the Bayesian information criterion on the fitted part; negative is better.
pub(super) fn delta_bic(before: &Score, before_len: usize, after: &Score, after_len: usize) -> f64 {
    before.fit_count * libm::log(after.fit_cost / before.fit_cost)
        + (after_len as f64 - before_len as f64) * libm::log(before.fit_count)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// White noise within the steps of a counter, with these errors.
    fn noise(error: f64, error_fit: f64) -> Score {
        Score {
            error,
            error_fit,
            held_blocks: vec![error * error; 10],
            held_count: 1e4,
            fit_count: 1e4,
            fit_cost: 1e4 * error_fit * error_fit,
            correlation: 1.0,
            within_counts: true,
        }
    }

    #[test]
    fn what_the_held_back_part_happens_to_miss_is_no_noise() {
        assert!(is_plain_noise(&noise(1.09, 1.1)));
        for error in [1.0, 1.09] {
            assert!(!is_plain_noise(&noise(error, 1.5)));
            assert!(!is_noise(
                &noise(error, 50.0),
                &noise(error, 52.0),
                SMALL_SHARE
            ));
        }
    }
}
