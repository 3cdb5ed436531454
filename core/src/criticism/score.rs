//! How well a fit explains the record, on the part that it saw and on the part that it did not.

use super::correlation::product;
use super::cost::{cost_between, fit_cost, informed_windows};
use super::cut::Block;
use super::data::Data;
use super::fit::{Fit, residuals};
use super::motion::Motion;
use super::noise::{news, news_left};
use super::output::Output;
use super::window::bend_within;

/// How well a motion fits: on the fitted and on the held-back part.
#[derive(Clone, Debug)]
pub(super) struct Score {
    pub error: f64,
    pub error_fit: f64,
    /// Mean squared residuals of each held-back block.
    pub held_blocks: Vec<f64>,
    /// Number of residuals on each part.
    pub held_count: f64,
    pub fit_count: f64,
    /// Squared residuals on the fitted part.
    pub fit_cost: f64,
    /// By how much autocorrelation widens variances: at least 1.
    pub correlation: f64,
    /// All that is measured is counted, and what is left there lies within half a step of the counter: no
    /// more can be seen.
    pub within_counts: bool,
}

/// Scores a fit; each window's states count as fitted on its own data.
pub(super) fn score(data: &Data, fit: &Fit) -> Score {
    let states = if data.has_position { 2.0 } else { 1.0 };
    let informed = informed_windows(data);
    let count = |held: bool| -> f64 {
        data.blocks
            .iter()
            .filter(|b| b.held_back == held)
            .map(|b| data.measured(b.from, b.to) as f64)
            .sum()
    };
    // A held-back block that is a window of its own has its states fitted.
    let own_states = if informed.iter().all(|i| *i) {
        0.0
    } else {
        states
    };
    let own = |flag: bool| states * informed.iter().filter(|i| **i == flag).count() as f64;
    let held_blocks: Vec<f64> = data
        .blocks
        .iter()
        .filter(|b| b.held_back)
        .map(|b| {
            // What a window's own states cost belongs to it.
            let own = !informed[b.window];
            let prior = if own {
                fit.motion.priors[b.window]
            } else {
                0.0
            };
            cost_between(data, &fit.motion, b.from, b.to) + prior
        })
        .collect();
    let sizes = data
        .blocks
        .iter()
        .filter(|b| b.held_back)
        .map(|b| (data.measured(b.from, b.to) as f64 - own_states).max(1.0));
    let fit_cost = fit_cost(data, &fit.motion);
    let held_count = (count(true) - own(false)).max(1.0);
    let fit_count = (count(false) - own(true) - fit.structure.free_count() as f64).max(1.0);
    Score {
        error: (held_blocks.iter().sum::<f64>() / held_count).sqrt(),
        error_fit: (fit_cost / fit_count).sqrt(),
        held_blocks: held_blocks.iter().zip(sizes).map(|(c, n)| c / n).collect(),
        held_count,
        fit_count,
        fit_cost,
        correlation: correlation_inflation(data, &fit.motion),
        within_counts: within_counts(data, &fit.motion),
    }
}

/// Share of the motion that a model with this score misses on held-back data: root mean square of the residuals over
/// that of the motion, each channel in units of its noise.
pub(super) fn share_left(data: &Data, score: &Score, motion: &Motion) -> f64 {
    let held = |b: &Block| b.held_back;
    let error = if data.wander > 0.0 {
        news_left(data, motion, 0.0, held)
    } else {
        score.error
    };
    let moves = motion_square(data, 0.0, held);
    if moves > 0.0 {
        error / moves.sqrt()
    } else {
        0.0
    }
}

/// Mean square of the motion in these blocks, each channel in units of its noise. That of a velocity or of an output is
/// about the mean, the news of it beyond a level that moves by a share of `gain` towards each sample; that of a
/// position about a straight line in each block, since a drive may go anywhere.
pub(super) fn motion_square(data: &Data, gain: f64, is_one: impl Fn(&Block) -> bool) -> f64 {
    let blocks = || data.blocks.iter().filter(|b| is_one(b));
    let motion = |o: &Output| -> f64 {
        if !o.is_velocity {
            let windows = blocks().map(|b| &o.values[b.from..b.to]);
            return windows.map(|window| bend_within(o, window)).sum();
        }
        let told = || blocks().flat_map(|b| (b.from..b.to).filter(|i| o.tells(*i)));
        let count = told().count().max(1) as f64;
        let mean = told().map(|i| o.values[i]).sum::<f64>() / count;
        let about: Vec<f64> = o.values.iter().map(|y| y - mean).collect();
        let about = news(data, o, &about, gain);
        told().map(|i| (about[i] / o.noise).powi(2)).sum()
    };
    let count: usize = blocks().map(|b| data.measured(b.from, b.to)).sum();
    data.outputs.iter().map(motion).sum::<f64>() / count.max(1) as f64
}

/// Half a step of a counter in its standard deviations, with a tenth of a step more: where a body rests, all that is
/// known of its state is the step in which it is.
const HALF_STEP: f64 = 1.2 * 1.732_050_8;

/// Share of the residuals that must lie within half a step.
const WITHIN: f64 = 0.95;

/// Whether the held-back residuals stay within half a step of their counters.
fn within_counts(data: &Data, motion: &Motion) -> bool {
    let (mut within, mut all) = (0_usize, 0_usize);
    for o in &data.outputs {
        if !o.counted {
            return false;
        }
        let modelled = motion.of(o.is_velocity);
        for b in data.blocks.iter().filter(|b| b.held_back) {
            let told = (b.from..b.to).filter(|i| o.tells(*i));
            let left = told.map(|i| (o.values[i] - modelled[i]).abs() / o.noise);
            within += left.filter(|r| *r < HALF_STEP).count();
            all += o.telling(b.from, b.to);
        }
    }
    within as f64 > WITHIN * all as f64
}

/// Longest lag, in samples, over which autocorrelation is summed.
const MAX_LAG: usize = 200;

/// `1 + 2 sum rho_k` of the residuals, summed up to the first lag without correlation; the mean of
/// the outputs weighted by their squared error.
fn correlation_inflation(data: &Data, motion: &Motion) -> f64 {
    let (mut weighted, mut weights) = (0.0, 0.0);
    let runs = data.runs();
    for (o, r) in data.outputs.iter().zip(residuals(data, motion)) {
        let (r, runs) = o.told(&r, &runs);
        let power = product(&r, &r, &runs, 0);
        if power == 0.0 {
            continue;
        }
        let count: usize = runs.iter().map(|(from, to)| to - from).sum();
        let white = 2.0 / (count as f64).sqrt();
        let mut sum = 1.0;
        for lag in 1..MAX_LAG.min(count / 4) {
            let rho = product(&r, &r, &runs, lag) / power;
            if rho < white {
                break;
            }
            sum += 2.0 * rho;
        }
        weighted += sum * power;
        weights += power;
    }
    if weights > 0.0 {
        weighted / weights
    } else {
        1.0
    }
}
