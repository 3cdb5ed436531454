//! Every constant of the search for formulas: what it is, its unit, and why it has that value.

/// Rows of the regression at most: more cost time and rank formulas no better.
pub(super) const MOST_ROWS: usize = 1200;

/// Widest window as a share of the record.
pub(super) const WIDEST_SHARE: f64 = 1.0 / 40.0;

/// Smallest share of the motion that a residual is taken to be: sums are integrals to a part in a thousand.
pub(super) const EXACT: f64 = 1e-3;

/// Share of a term that the body must not explain: one that is nearly viscous friction, or nearly a gain, tells a body
/// of nonsense and itself together.
pub(super) const LEAST_TOLD: f64 = 0.03;

/// Scales of a bend that are tried, at equal ratios from and to this share of the size of its variable: beyond them it
/// is a power, or a jump.
pub(super) const SCALES: usize = 14;
pub(super) const FIRST_SCALE: f64 = 0.03;
pub(super) const LAST_SCALE: f64 = 3.0;

/// Centres that are tried over the range of a variable, and widths of bumps as shares of it.
pub(super) const CENTRES: usize = 12;
pub(super) const WIDTHS: [f64; 5] = [0.03, 0.06, 0.12, 0.24, 0.48];

/// Waves over the range of a variable: up to so many, in steps of so many half waves, from one to the next of which a
/// wave stays in step with itself over most of the range.
pub(super) const MOST_WAVES: f64 = 25.0;
pub(super) const WAVE_STEP: f64 = 0.6;

/// Values of the numbers of each form that go into pairs as the first term, and first terms in all: of a pair at least
/// one term shows alone.
pub(super) const SHAPES_KEPT: usize = 2;
pub(super) const FIRST_TERMS: usize = 300;

/// Forms, or first terms, that are tried at a time.
pub(super) const AT_A_TIME: usize = 24;

/// Formulas of one, two and three terms whose numbers are refined, and how many at a time.
pub(super) const REFINED: [usize; 3] = [30, 70, 16];
pub(super) const PER_PART: usize = 6;

/// Rounds of refinement of the numbers, what a step must leave at most to be one, and the smallest step as a share of
/// the first.
pub(super) const MOST_STEPS: usize = 30;
pub(super) const WORTH: f64 = 1.0 - 1e-5;
pub(super) const LAST_STEP: f64 = 0.02;

/// Standard errors by which what drives the body must be told.
pub(super) const TOLD: f64 = 5.0;

/// Price of a part of a formula, as a logarithm of what is left: of two parts about what a number costs by the Bayesian
/// information criterion, with two hundred windows that tell something of their own.
pub(super) const PRICE: f64 = 0.01;

/// Pairs beside which a third term is looked for; and what the windows are left with, in times of their noise, below
/// which none is.
pub(super) const THIRDS: usize = 6;
pub(super) const NOISE_LEFT: f64 = 1.15;

/// Formulas that are simulated exactly, of one, two and three terms.
pub(super) const SIMULATED: [usize; 3] = [6, 10, 5];

/// Times the root of the least loss of the regression up to which a formula is simulated.
pub(super) const NEAR: f64 = 1.6;

/// Share of the force by which two formulas differ that say the same.
pub(super) const SAME_FORCE: f64 = 3e-3;

/// Ends of the straight pieces of a smooth curve along one variable: as many values as a short table has.
pub(super) const PIECES: usize = 10;

/// Standard errors by which a smooth curve must foretell more than a formula for that to be none.
pub(super) const CURVE_BETTER: f64 = 3.0;

/// Formulas of a class for which an experiment is looked for.
pub(super) const APART: usize = 3;
