//! Is one model better than another? By blocks that neither fit has seen.
//!
//! Two-fold blocked cross-validation: every block is judged by the fit to the other half. Two models are compared by
//! the paired difference of the logarithm of what they leave of a block, beside its noise and what no model is right
//! to, over the standard error of its mean (Student's t): by the ranks of the differences, or by themselves where few
//! blocks tell them.

use super::Trial;
use super::tuning::{
    ALIKE_IN_BLOCKS, DISCREPANCY, FEW_BLOCKS, GREAT_FALL, LEAST_FALL, QUANTILE, RANKED, SAME,
    STEADY_FALL, UNCHANGED,
};
use crate::criticism::select::outweighs;
use crate::criticism::session::Session;

/// How a model differs from another one.
#[derive(Clone, Copy, Debug)]
pub(in crate::criticism) struct Difference {
    /// Student's t of the paired differences, or of their ranks; positive where the second is better.
    pub t: f64,
    /// Blocks in which they differ.
    pub blocks: usize,
    /// Relative fall of the error from the first to the second.
    pub fall: f64,
    /// The same of the half where it is less.
    pub least_fall: f64,
    /// The same without the block of each half that tells most of it, where blocks do not hang together.
    steady_fall: f64,
}

/// Whether a step explains more than it leaves of either half: of one half alone it may by chance.
pub(in crate::criticism) fn outweighs_in_either_half(from: &Trial, to: &Trial) -> bool {
    let mut halves = from.halves().zip(to.halves());
    halves.all(|(a, b)| outweighs(a.score.error, b.score.error))
}

/// The difference from one trial to another.
pub(in crate::criticism) fn difference(session: &Session, from: &Trial, to: &Trial) -> Difference {
    let mean = |held: &[f64]| held.iter().sum::<f64>() / held.len().max(1) as f64;
    let usual = mean(&from.held).min(mean(&to.held));
    let floor = usual.max(1.0) + DISCREPANCY * DISCREPANCY * session.motion_square;
    let pairs = from.held.iter().zip(&to.held);
    let changes: Vec<f64> = pairs
        .filter(|(a, b)| (*a - *b).abs() > UNCHANGED * a.max(**b))
        .map(|(a, b)| libm::log((a + floor) / (b + floor)))
        .collect();
    let t = if effective_number(&changes) < RANKED {
        students_t(&changes)
    } else {
        students_t(&signed_ranks(&changes))
    };
    let fall = |a: f64, b: f64| {
        if b.is_finite() {
            1.0 - b / a
        } else {
            f64::NEG_INFINITY
        }
    };
    let halves = || from.halves().zip(to.halves());
    let least = halves().map(|(a, b)| fall(a.score.error, b.score.error));
    let steady = halves().map(|(a, b)| {
        let [a, b] = without_most(&a.score.held_blocks, &b.score.held_blocks);
        fall(a.sqrt(), b.sqrt())
    });
    Difference {
        t: if t.is_finite() { t } else { 0.0 },
        blocks: changes.len(),
        fall: fall(from.error(), to.error()),
        least_fall: least.fold(f64::INFINITY, f64::min),
        steady_fall: if session.data.has_blocks_apart() {
            steady.fold(f64::INFINITY, f64::min)
        } else {
            f64::NEG_INFINITY
        },
    }
}

/// Mean of some numbers over its standard error; 0 of fewer than two.
fn students_t(changes: &[f64]) -> f64 {
    if changes.len() < 2 {
        return 0.0;
    }
    let count = changes.len() as f64;
    let mean = changes.iter().sum::<f64>() / count;
    let squares: f64 = changes.iter().map(|c| (c - mean).powi(2)).sum();
    // Of a slow process neighbouring blocks hang together, and tell less than as many others (Newey and West 1987, one
    // lag).
    let neighbours = changes.windows(2).map(|c| (c[0] - mean) * (c[1] - mean));
    let together = 2.0 * neighbours.sum::<f64>().max(0.0);
    let error = ((squares + together) / (count - 1.0) / count).sqrt();
    mean / error.max(f64::MIN_POSITIVE)
}

/// How many numbers of one size are as evenly spread as these are by theirs: the exponential of the entropy of their
/// shares (Hill 1973, order 1). What two blocks show bends a model that has not got it, so that all others are better
/// with it by a little: by their ranks they would be as many witnesses.
fn effective_number(changes: &[f64]) -> f64 {
    let sum: f64 = changes.iter().map(|c| c.abs()).sum();
    let shares = changes.iter().map(|c| c.abs() / sum).filter(|p| *p > 0.0);
    libm::exp(shares.map(|p| -p * libm::log(p)).sum())
}

/// The place of each number in the order of their sizes, with its sign (Wilcoxon 1945; Student's t of them: Conover and
/// Iman 1981). One block may hold a great change, and many small ones: a mean of them scatters as the great ones do.
fn signed_ranks(changes: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..changes.len()).collect();
    order.sort_by(|a, b| changes[*a].abs().total_cmp(&changes[*b].abs()));
    let mut ranks = vec![0.0; changes.len()];
    for (rank, place) in order.into_iter().enumerate() {
        ranks[place] = (rank as f64 + 1.0).copysign(changes[place]);
    }
    ranks
}

/// Sums of two series without the place where the second is less by the most.
fn without_most(a: &[f64], b: &[f64]) -> [f64; 2] {
    let pairs = || a.iter().zip(b);
    let sums = pairs().fold([0.0, 0.0], |[x, y], (a, b)| [x + a, y + b]);
    let most = pairs().max_by(|x, y| (x.0 - x.1).total_cmp(&(y.0 - y.1)));
    most.map_or(sums, |(a, b)| [sums[0] - a, sums[1] - b])
}

/// Student's quantile for so many degrees of freedom, from that of the normal distribution (Cornish and Fisher 1960).
fn student(normal: f64, freedom: f64) -> f64 {
    let (z, z3) = (normal, normal.powi(3));
    let (z5, z7) = (normal.powi(5), normal.powi(7));
    z + (z3 + z) / (4.0 * freedom)
        + (5.0 * z5 + 16.0 * z3 + 3.0 * z) / (96.0 * freedom.powi(2))
        + (3.0 * z7 + 19.0 * z5 + 17.0 * z3 - 15.0 * z) / (384.0 * freedom.powi(3))
}

impl Difference {
    fn is_certain(&self, t: f64) -> bool {
        self.blocks > FEW_BLOCKS && t > student(QUANTILE, self.blocks as f64 - 1.0)
    }

    /// Whether the second model is better. A real machine does more than any model says: where a step explains more
    /// than it leaves, in either half and not by one block, what is left beside may hide that from a test of the mean.
    pub fn is_better(&self) -> bool {
        let steady = self.least_fall.min(self.steady_fall) > STEADY_FALL;
        self.least_fall > GREAT_FALL || steady || self.fall > LEAST_FALL && self.is_certain(self.t)
    }

    /// Whether they differ in too few blocks to count: what a limit does may be met once.
    pub fn is_met_once(&self) -> bool {
        self.blocks <= FEW_BLOCKS
    }

    /// Whether the second does not do better than the first.
    pub fn is_no_better(&self) -> bool {
        self.fall < 0.0 || self.is_same()
    }

    /// Whether neither is better.
    pub fn is_same(&self) -> bool {
        self.fall.abs() < SAME
            || (self.fall.abs() < ALIKE_IN_BLOCKS && !self.is_certain(self.t.abs()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_block_that_tells_most_is_left_out() {
        let before = [9.0, 100.0, 9.0, 9.0];
        let after = [8.0, 1.0, 10.0, 8.0];
        assert_eq!(without_most(&before, &after), [27.0, 26.0]);
        assert_eq!(without_most(&[], &[]), [0.0, 0.0]);
    }

    #[test]
    fn gains_in_nearly_all_blocks_count_however_their_sizes_scatter() {
        assert_eq!(signed_ranks(&[0.1, -0.5, 0.3]), [1.0, -3.0, 2.0]);
        let gains = [
            0.01, 0.47, 1.16, 1.33, 0.71, 0.19, 0.37, 0.2, -0.07, 0.28, 0.23, 0.09, 0.87,
        ];
        let certain = student(QUANTILE, gains.len() as f64 - 1.0);
        assert!(students_t(&gains) < 1.1 * certain);
        assert!(students_t(&signed_ranks(&gains)) > 1.3 * certain);
        // Of as many losses as gains nothing is certain.
        let mixed: Vec<f64> = (1..=12)
            .map(|k| f64::from(k) * [1.0, -1.0][k as usize % 2])
            .collect();
        assert!(students_t(&signed_ranks(&mixed)).abs() < 0.5);
    }

    #[test]
    fn two_blocks_that_tell_all_are_no_more_than_two_witnesses() {
        assert!((effective_number(&[0.3; 9]) - 9.0).abs() < 1e-9);
        let mut bent = vec![0.03; 18];
        bent.extend([3.0, 3.0]);
        assert!(effective_number(&bent) < 0.5 * RANKED);
        assert_eq!(effective_number(&[]), 1.0);
    }

    #[test]
    fn what_explains_as_much_as_it_leaves_needs_no_count_of_blocks_but_by_more_than_one() {
        let step = |steady_fall: f64| Difference {
            t: 1.9,
            blocks: 20,
            fall: 0.45,
            least_fall: 0.4,
            steady_fall,
        };
        assert!(step(0.3).is_better());
        assert!(!step(0.1).is_better());
    }
}
