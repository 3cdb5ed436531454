//! Which of the sums that the regression found are simulated.

use super::search::Search;
use super::sum::score;
use super::tuning::{NEAR, SAME_FORCE, SIMULATED};
use super::weak::Weak;
use super::written::Written;
use crate::effect::baseline::Baseline;
use crate::measurement::Kind;

/// The best of one, two and three terms, shorter ones first; of those that say the same the shortest.
pub(super) fn chosen(search: &Search, weak: &Weak, baseline: Baseline, kind: Kind) -> Vec<Written> {
    let written = search.found.iter().filter_map(|sum| {
        let written = Written::of(sum, weak, baseline, kind)?;
        Some((sum.terms.len(), written))
    });
    let mut written: Vec<(usize, Written)> = written.collect();
    let price = |w: &Written| score(w.loss, w.length);
    written.sort_by(|a, b| price(&a.1).total_cmp(&price(&b.1)));
    let size = weak.first_loss().sqrt();
    let mut kept: Vec<(usize, Written)> = Vec::new();
    for (terms, own) in written {
        let alike = || kept.iter().filter(|(of, _)| *of == terms);
        let most = SIMULATED[terms.clamp(1, 3) - 1];
        let far = alike()
            .next()
            .is_some_and(|(_, best)| own.loss > NEAR * NEAR * best.loss);
        let same = |(_, other): &(usize, Written)| {
            let squares: f64 = other
                .said
                .iter()
                .zip(&own.said)
                .map(|(a, b)| (a - b).powi(2))
                .sum();
            other.length <= own.length && squares.sqrt() < SAME_FORCE * size
        };
        if alike().count() < most && !far && !kept.iter().any(same) {
            kept.push((terms, own));
        }
    }
    let mut kept: Vec<Written> = kept.into_iter().map(|(_, w)| w).collect();
    kept.sort_by_key(|w| w.length);
    kept
}
