//! Every constant of the screen: what it is, its unit, and why it has that value.

/// Blocks that a record is cut into for validation and for errors: even ones judge fits to odd ones and the other way
/// round. Two dozen tell a standard error to 15 %, and a block still holds many windows.
pub(super) const BLOCKS: usize = 24;

/// Exponent of the bump `(1 - s^2)^p`: its first three derivatives vanish at the ends of a window, as third derivatives
/// of a motion need (Messenger and Bortz 2021).
pub(super) const BUMP_POWER: i32 = 4;

/// Windows start at this share of their length from each other: closer ones say the same again.
pub(super) const STRIDE: f64 = 0.25;

/// Fewest samples in a window: sums then are integrals to a part in a thousand.
pub(super) const SHORTEST: usize = 12;

/// Widths of windows, and the factor between two: fast and slow physics both count.
pub(super) const WIDTHS: usize = 5;
pub(super) const WIDTH_RATIO: f64 = 2.0;

/// Widest window as a share of the record: two fit into a block.
pub(super) const WIDEST: f64 = 0.5 / BLOCKS as f64;

/// The same for a process, whose records hold few of its time constants.
pub(super) const WIDEST_OF_PROCESS: f64 = 1.0 / 12.0;

/// Share of the acceleration in the shortest window that may be noise, root mean square: it bends the inertia by its
/// square.
pub(super) const NOISY: f64 = 0.05;

/// Most windows of one width: more cost time and tell nothing new.
pub(super) const MOST_WINDOWS: usize = 2400;

/// Share of its root mean square that the noise of a velocity may have after smoothing.
pub(super) const SMOOTH: f64 = 0.02;

/// Widest smoothing, samples to either side.
pub(super) const WIDEST_SMOOTHING: usize = 64;

/// Standard deviations of the velocity within which its sign is not known.
pub(super) const SIGN_SIGMAS: f64 = 2.0;

/// Samples for which a velocity within its noise is no reversal but rest, in times of those a reversal takes.
pub(super) const REST: f64 = 4.0;

/// Residuals beyond so many robust standard deviations count linearly (Huber 1981).
pub(super) const HUBER: f64 = 2.5;

/// Rounds of weights: by the model with everything, then twice by the best subset.
pub(super) const ROUNDS: usize = 3;

/// Smallest share of a target that a residual is taken to be: a regression is exact to no more digits than windows are
/// integrals.
pub(super) const EXACT: f64 = 1e-3;

/// Shapes of an atom that go into the subsets, for each half of the record and beside each set of others.
pub(super) const KEPT_SHAPES: usize = 2;

/// Most atoms in a subset.
pub(super) const MOST_ATOMS: usize = 4;

/// Share of a column that must not be explained by the others for its coefficient to be told: squared.
pub(super) const COLLINEAR: f64 = 1e-7;

/// Standard errors by which inertia must be told.
pub(super) const TOLD: f64 = 5.0;

/// Standard errors within which two subsets are the same: 5 % at both ends over a few thousand subsets, by Bonferroni,
/// are 4.3; neighbouring blocks that agree are worth a third less.
pub(super) const SAME: f64 = 3.0;

/// Share of the motion, root mean square, below which a difference is none: equations and clocks are not right to more.
pub(super) const PRACTICAL: f64 = 0.02;

/// Subsets of a class that are listed.
pub(super) const LISTED: usize = 6;

/// Share of the motion that a model with everything may leave for the input to be said to explain it.
pub(super) const UNEXPLAINED: f64 = 0.7;

/// Standard errors within which a coefficient may be by chance.
pub(super) const CHANCE: f64 = 2.0;

/// Step of a numerical derivative, in standard errors.
pub(super) const DIFFERENCE: f64 = 1e-3;

/// Lags that the input is put through to see whether the motion follows, from one sample to the record over this: a
/// machine is seen to settle some times.
pub(super) const LAGS: usize = 10;
pub(super) const PATIENCE: f64 = 8.0;

/// Samples of the past from which the next output is foretold: three resonances.
pub(super) const PAST: usize = 6;

/// Work that went in, in times of what came back, from which the input acted: of a random walk, which the work of an
/// input of another record is, one in forty has as much.
pub(super) const DRIVEN: f64 = 4.0;

/// Delays that are tried where the input does not explain the motion, and the longest as a share of the record.
pub(super) const LATE: usize = 30;
pub(super) const LATEST: f64 = 0.25;

/// Factor of the error left beyond which a subset is no longer the same, however few blocks show it.
pub(super) const WORSE: f64 = 1.12;

/// Widths that leave more than this many times the share of the best width, and of a drive less than this share of its
/// inertia, tell noise: an inertia that is bent by a fifth misleads every atom beside it.
pub(super) const DULL: f64 = 1.6;
pub(super) const ATTENUATED: f64 = 0.8;

/// Subsets whose shapes are refined in each round, and the first and last step of it as shares of a number.
pub(super) const REFINED: usize = 3;
pub(super) const COARSE: f64 = 0.1;
pub(super) const FINE: f64 = 0.004;

/// Growth of a process over the widest window, as a logarithm, up to which it is no runaway: an integrating one has 0.
pub(super) const GROWTH: f64 = 0.1;

/// Numbers of a shape that a grid finds well enough: in more, it is coarse in each, and a simplex goes on from the
/// best.
pub(super) const GRID_NUMBERS: usize = 2;

/// How many simplexes at most, beside the body alone and beside all that is linear; evaluations of each, and samples
/// through which as many may go: some seconds of computing, whatever the record.
pub(super) const SIMPLEXES: usize = 3;
pub(super) const EVALUATIONS: usize = 200;
pub(super) const SIMPLEX_SAMPLES: usize = 8_000_000;

/// Side of a simplex, in logarithms, and the share of what is left without the atom that is not worth more of it.
pub(super) const SIDE: f64 = 0.4;
pub(super) const ENOUGH: f64 = 1e-5;

/// Share of the squares that the best shape of the grid may leave for an atom to be worth a simplex.
pub(super) const SHOWN: f64 = 0.9;

/// Widths that a simplex looks at, the widest ones; and factors by which it may leave a grid, and one value.
pub(super) const WIDE: usize = 2;
pub(super) const BEYOND: f64 = 3.0;
pub(super) const FAR_BEYOND: f64 = 100.0;
