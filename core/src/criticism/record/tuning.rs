//! Constants of what a record tells of its own channels.

/// Values, spread over the record, that are looked at to find the step of a quantised channel.
pub(super) const QUANTUM_SAMPLES: usize = 20_000;

/// Most counts that the least step between two values may be.
pub(super) const MOST_COUNTS: u32 = 16;

/// Distance from a whole number of counts up to which many counts are whole, and the share of the steps that must be.
pub(super) const WHOLE: f64 = 0.1;
pub(super) const WHOLE_SHARE: f64 = 0.95;

/// Digits after the point up to which values are looked at as printed ones, the most units of the last digit that they
/// may be, and how far they may be from whole ones: that of binary numbers.
pub(super) const MOST_DIGITS: usize = 12;
pub(super) const MOST_UNITS: f64 = 1e9;
pub(super) const PRINTED: f64 = 1e-6;

/// A count is that of a sensor behind the print where it is this many units of the last digit, seen in so many steps;
/// where it is fewer units, but as many as this, rounding leaves more to chance, and more steps must show it.
pub(super) const BEHIND_PRINT: f64 = 8.0;
pub(super) const FEW_STEPS: usize = 5;
pub(super) const NEAR_PRINT: f64 = 3.0;
pub(super) const MANY_STEPS: usize = 20;

/// Ratio of two gaps between sorted values from which on the smaller is jitter about one point of a lattice, and share
/// of the larger, one over this, that all jitter about a point stays below; least share of the gaps that are jitter.
pub(super) const FAR_APART: f64 = 6.0;
pub(super) const NEAR_SHARE: f64 = 0.02;
pub(super) const JITTERS: f64 = 4.0;

/// Fewest readings from which it is told.
pub(super) const LEAST_READINGS: usize = 20;

/// Share of the readings that must stay for the usual number of samples, but for one more or less where a log and a
/// sensor have clocks of their own.
pub(super) const USUAL: f64 = 0.8;

/// Share of the readings that must stay for a multiple of the same number of samples, of a channel that holds each for
/// so many: a slow counter's stay for odd numbers as often as for even ones.
pub(super) const IN_STEP: f64 = 0.97;

/// How many times longer than chance has it a reading may stay that a logger repeats where it missed the next.
pub(super) const LONGER: f64 = 3.0;

/// A counter that creeps goes on by one count or two, each printed in two ways at most: share of the moves that so many
/// sizes must not reach.
pub(super) const SIZES_OF_COUNTS: usize = 4;
pub(super) const COUNTED: f64 = 0.6;

/// How far, as a share of the values, sizes of moves that are the same may differ in binary numbers.
pub(super) const BINARY: f64 = 1e-12;

/// Samples in a row at the limit, and samples in all such rows, from which it is told.
pub(super) const LEAST_STAY: usize = 3;
pub(super) const LEAST_SAMPLES: usize = 10;

/// It comes to its limit by a step of more than so many units of the last digit: what settles there comes by one.
pub(super) const AT_ONCE: f64 = 4.0;

/// Share of the other samples that may be as the one before: of noise hardly any is, of counts many are.
pub(super) const REPEATED: f64 = 0.02;

/// Deviation from the neighbours, in standard deviations of the noise, of a glitch: none of ten million normal values
/// is as far off.
pub(super) const FAR_OFF: f64 = 8.0;

/// Deviation of the neighbours from each other, likewise, and as a share of that of the value between them.
pub(super) const AGREE: f64 = 4.0;
pub(super) const SHARE: f64 = 0.15;

/// Share of the values that may be glitches; more are the way that the sensor is.
pub(super) const FEW: f64 = 0.01;

/// Standard deviation of a value less the cubic through four neighbours, in that of the noise.
pub(super) const CUBIC: f64 = 1.394;

/// Weights of the cubic at a value through those two and one before and one and two after it, and at a neighbour of one
/// that is left out, through the two beyond that neighbour and the two beyond the gap, from the far side.
pub(super) const AT_VALUE: [f64; 4] = [-1.0 / 6.0, 4.0 / 6.0, 4.0 / 6.0, -1.0 / 6.0];
pub(super) const AT_NEIGHBOUR: [f64; 4] = [-0.3, 1.0, 0.5, -0.2];

/// Most values in a row that may be a glitch, and most such rows on one side of all other values.
pub(super) const LONGEST: usize = 3;
pub(super) const MOST_ROWS: usize = 2;

/// How far beyond all other values they are, as a share of the range of these.
pub(super) const BEYOND: f64 = 0.3;

/// Standard deviation of a second difference in that of the noise.
pub(super) const SECOND_DIFFERENCE: f64 = 2.45;

/// Share of the largest value of a channel that arithmetic and print leave open: nine digits.
pub(in crate::criticism) const ARITHMETIC: f64 = 1e-9;

/// Standard deviations of its noise by which an input jumps: by chance one reading in two million is so far off.
pub(super) const JUMP_SIGMAS: f64 = 5.0;

/// Readings of a level on the average from which on an input goes in steps.
pub(super) const LONG_LEVELS: usize = 10;

/// Times the noise that differences show up to which what is left about the levels is noise too.
pub(super) const SCATTERS: f64 = 1.5;
