//! Every constant of fit and judge: what it is, its unit, and why it has that value.

/// Subsets of the screen of one size that are scanned: as many as there are effects of a drive. What holds a body at
/// rest hardly shows in the weak form, where its velocity has no sign: beside the best of the others each has its turn.
pub(super) const STARTS: usize = 24;

/// A round on the scout.
#[derive(Clone, Copy, Debug)]
pub(super) struct Round {
    pub iterations: usize,
    /// Sets of effects that go on to the next by their cost, for each place of the model that is open, half as many
    /// more by what they may come to, and starting points of each.
    pub sets: usize,
    pub starts: usize,
}

/// Rounds on the scout: each leaves about half of the sets and doubles the iterations (Jamieson and Talwalkar 2016).
pub(super) const ROUNDS: [Round; 4] = [
    Round {
        iterations: 1,
        sets: 20,
        starts: 4,
    },
    Round {
        iterations: 2,
        sets: 12,
        starts: 3,
    },
    Round {
        iterations: 4,
        sets: 8,
        starts: 2,
    },
    Round {
        iterations: 8,
        sets: 6,
        starts: 2,
    },
];

/// Times the least cost beyond which a model does not go on, after each round.
pub(super) const FAR: [f64; 4] = [100.0, 20.0, 5.0, 3.0];

/// Times its last fall by which the cost of a model may fall yet.
pub(super) const HOPE: f64 = 3.0;

/// Rounds like the last one for which a fit to the record goes on.
pub(super) const ROUNDS_LEFT: i32 = 3;

/// Models that are fitted to the whole record after that; and of those with a hidden body, whose fits take ten times as
/// long.
pub(super) const FITTED: usize = 6;
pub(super) const FITTED_HIDDEN: usize = 3;

/// Samples of the usual motion over which a dry contact builds up its force: hard, and seen.
pub(super) const CROSSINGS: [f64; 3] = [0.003, 0.35, 0.8];

/// Share of its typical size with which a value begins of which the record tells nothing.
pub(super) const USUAL: f64 = 0.1;

/// Times the cost on the scout of what there is up to which a model is fitted to the record: so much a race of a few
/// iterations on a part of it is off.
pub(super) const ALIKE: f64 = 2.0;

/// Times that a fit begins anew with the states of its windows improved, and the share of its cost above which it has
/// settled.
pub(super) const SETTLING: usize = 3;
pub(super) const SETTLED: f64 = 0.98;

/// Most effects that are added.
pub(super) const MOST_SIZE: usize = 4;

/// Sizes in a row that may bring nothing: two effects, or three, may show only together. (A robot servo's gravity and
/// its friction under load explain nothing one by one.)
pub(super) const MOST_MISSES: usize = 2;

/// The same of hidden bodies, which are tried alone and beside the best effect.
pub(super) const MOST_HIDDEN_MISSES: usize = 1;

/// Subsets of one size that are looked at, the best first.
pub(super) const MOST_LEADS: usize = 5;

/// Iterations of the fit to the other half of the blocks, from the values of the first.
pub(super) const OTHER_HALF: usize = 8;

/// Share of the motion, root mean square, that no equation, clock or rig is right to: a block that is left with less
/// says no more than by how much.
pub(super) const DISCREPANCY: f64 = 0.01;

/// Blocks of which no spread can be told.
pub(super) const FEW_BLOCKS: usize = 2;

/// Relative change of a block below which a step has changed nothing there.
pub(super) const UNCHANGED: f64 = 0.02;

/// Normal quantile of one comparison: 1 in 120, so that of the six subsets of a level none is better by chance in 95 of
/// 100 (Bonferroni).
pub(super) const QUANTILE: f64 = 2.39;

/// Effective number of blocks from which on signs alone can be as rare as that: all alike by chance in 1 of 128.
pub(super) const RANKED: f64 = 7.0;

/// Relative fall of the error below which a difference is none, whatever its sign is known to be.
pub(in crate::criticism) const LEAST_FALL: f64 = 0.03;

/// Relative difference of the error up to which two models are the same; and up to which they are where the blocks do
/// not tell them apart.
pub(super) const SAME: f64 = 0.01;
pub(super) const ALIKE_IN_BLOCKS: f64 = 0.1;

/// Fall of the error of both halves that needs no count of blocks.
pub(super) const GREAT_FALL: f64 = 0.7;

/// The same where the block of either half that tells most of it is left out: the step explains as much as it leaves.
pub(super) const STEADY_FALL: f64 = 1.0 - std::f64::consts::FRAC_1_SQRT_2;

/// Relative difference of inertia (of a process: gain and time constant) up to which two models speak of the same body.
pub(super) const SAME_BODY: f64 = 0.2;

/// Share of the noise below which what a model leaves shows that the noise is less.
pub(super) const QUIET: f64 = 0.8;

/// Times that another effect takes the place of one in the best model.
pub(super) const MOST_SWAPS: usize = 3;
