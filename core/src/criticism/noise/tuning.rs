//! Constants of the noise model.

/// Orders of difference that are tried.
pub(super) const ORDERS: [usize; 4] = [2, 3, 4, 5];

/// Groups by samples since the last change of the input; later samples share the last group.
pub(super) const GROUPS: usize = 24;

/// Fewest differences from which a group may speak.
pub(super) const MIN_GROUP: usize = 60;

/// Quantile of the absolute differences that is read off: low, so that kinks do not count.
pub(super) const QUANTILE: f64 = 0.3;

/// The same quantile of the absolute value of a standard normal variable.
pub(super) const NORMAL_QUANTILE: f64 = 0.385_320_466_407_567_6;

/// Share of the differences that lies in quieter groups than the one that decides.
pub(super) const QUIET: f64 = 0.4;

/// Three standard errors of a level that is read off one difference, relative to it; of many, this over the root of
/// their number.
pub(super) const CHANCE: f64 = 4.8;

/// Excess of the variance over that of quantisation up to which it is quantisation alone.
pub(super) const QUANTISED: f64 = 1.25;

/// Share of the fresh readings of a channel that may be as the one before, by a rest; more are steps that are counted.
pub(super) const REPEATED: f64 = 0.3;

/// Parts of a signal, by its size, whose noise is compared; order of the differences that tell it; and ratio of the
/// loudest to the quietest from which on noise depends on the state.
pub(super) const STATES: usize = 5;
pub(super) const STATE_ORDER: usize = 3;
pub(super) const UNLIKE: f64 = 2.0;

/// Share by which the level of surroundings that wander moves towards each sample, so that it remembers ten: what an
/// output does in answer to the input within fewer is news, and what takes far longer may be the surroundings. (Half as
/// much names the same of an incubator and of heaters in a room on a random walk.)
pub(in crate::criticism) const WANDER: f64 = 0.1;
