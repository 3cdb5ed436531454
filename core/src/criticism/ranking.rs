//! Candidates in the order in which they are shown, and what a perfect model would leave.

use super::score::Score;
use super::session::Rest;
use crate::diagnosis::{Candidate, NOISE_FLOOR};
use crate::effect::EffectId;

/// Puts the best first, the simpler one of two as good; the suggested one leads.
pub(super) fn rank(candidates: &mut [Candidate], suggestion: Option<EffectId>) {
    candidates.sort_by(|a, b| {
        let first = |c: &Candidate| suggestion.is_none_or(|s| c.effects[0] != s);
        let simpler = a.parameters.len().cmp(&b.parameters.len());
        let better = rounded(a.error).total_cmp(&rounded(b.error)).then(simpler);
        first(a).cmp(&first(b)).then(better)
    });
}

/// To the three digits that are shown.
fn rounded(error: f64) -> f64 {
    let digit = libm::exp10(libm::floor(libm::log10(error)) - 2.0);
    libm::round(error / digit) * digit
}

/// What a perfect model would leave: where noise remembers, more than neighbouring samples show.
pub(super) fn noise_floor(rest: Rest, score: &Score) -> f64 {
    match rest {
        Rest::NoiseWithMemory | Rest::RandomForces => score.error_fit.max(NOISE_FLOOR),
        Rest::Noise | Rest::More => NOISE_FLOOR,
    }
}
