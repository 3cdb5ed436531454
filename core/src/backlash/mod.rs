//! How wide is the hidden gap? Found from the motor side alone.
//!
//! Under a velocity relay with an asymmetry that changes its sign now and then (a *drifting test*)
//! the motor's limit cycle wanders to and fro inside the gap of its backlash. At either end it meets
//! the load, and what the motor alone cannot explain is the momentum that it hands over there.
//!
//! 1. [`estimate_gap`] fits the motor alone (inertia, friction, late input) by robust regression and
//!    keeps the velocity that this leaves unexplained: constant while the motor is free, stepping down
//!    where the load is met at the positive end of the gap and up at the negative one, since the
//!    contact pushes and cannot pull (Nordin and Gutman 2002, "Controlling mechanical systems with
//!    backlash - a survey", Automatica 38).
//! 2. Where the pattern of drift changes is found cycle by cycle with PELT (Killick, Fearnhead and
//!    Eckley 2012, "Optimal detection of changepoints with a linear computational cost", JASA 107).
//! 3. In those cycles each contact is found with two cumulative sums (Page 1954, "Continuous inspection
//!    schemes", Biometrika 41) and placed between the samples by least squares.
//! 4. Between contacts the load flies on its own: pushed by a known momentum, slowed by its own viscous
//!    and dry friction. A Kalman filter with that motion says how far the motor is from the load; the
//!    gap and the load's three numbers maximise the likelihood of its innovations (Schweppe 1965,
//!    "Evaluation of likelihood functions for Gaussian signals", IEEE Trans. Inf. Theory 11).
//!
//! Where the load is measured too, [`backlash_map`] gives the gap as a reference.

mod change_points;
mod contacts;
mod cycles;
mod drift;
mod estimate;
mod free_motor;
mod gap;
mod likelihood;
mod map;
mod record;
mod switches;
mod verdict;

pub use change_points::{Segment, pelt};
pub use estimate::estimate_gap;
pub(crate) use estimate::sighted;
pub use gap::{Contact, CycleDrift, GapError, GapEstimate, LoadMotion, Quality, Side, Traverse};
pub use map::{BacklashMap, Branch, MapError, MapSilence, backlash_map};
