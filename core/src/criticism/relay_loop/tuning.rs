//! Every constant of the loop as a judge: what it is, its unit, and why it has that value.

/// Share of the half cycles that the thresholds of a relay must explain: in a sampled loop they explain all; a glitch
/// and the begin of the record may cost some.
pub(super) const EXPLAINED: f64 = 0.9;

/// Half cycles that thresholds explain and a clock does not, from which the loop was closed: a square wave of a
/// generator drives a periodic motion, which passes the same values at every switch, and at most the first of either
/// level is shorter.
pub(super) const BEYOND_A_CLOCK: usize = 3;

/// Samples by which half cycles of a clock may differ.
pub(super) const CLOCK_SAMPLES: usize = 1;

/// Fewest half cycles from which a rule is read.
pub(super) const FEWEST_HALVES: usize = 12;

/// Longest delay between crossing and switch that is tried, as a share of the usual half cycle: a later switch meets
/// the crossing before.
pub(super) const LONGEST_DELAY: f64 = 0.5;

/// Fewest cycles in the second half of a run of which period and amplitude are told.
pub(super) const FEWEST_CYCLES: usize = 3;

/// Samples that are run at most: a cycle is known long before.
pub(super) const MOST_SAMPLES: usize = 10_000;

/// Share of period and amplitude up to which a model makes the cycle that was measured. Where dry friction holds the
/// energy that hysteresis and sampling bring in, 7 % of its level change the amplitude by 24 % (3.0 and 3.2 N on a cart
/// of 6.3 kg).
pub(super) const MAKES: f64 = 0.25;

/// Seed of the noise that the relay of a model sees.
pub(super) const SEED: u64 = 1;
