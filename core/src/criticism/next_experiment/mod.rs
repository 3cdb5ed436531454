//! Which experiment tells apart what this one could not?
//!
//! The models that explain a record equally well are simulated with their fitted parameters under relays, stairs and
//! sums of sines, within the limits of the user. What one of them does is then explained with the other, *its
//! parameters fitted anew*: a difference that a parameter could swallow does not count (discrimination between
//! rival models, Hunter and Reiner 1965; with all parameters projected out, Buzzi-Ferraris and Forzatti 1983). What
//! is left, in units of the noise, is the separation.

mod bench;
mod candidates;
mod design;
mod job;
mod limits;
mod program;
mod words;

pub(super) use bench::Hypothesis;
pub(super) use design::{Design, Rival, designs};
pub use job::ExperimentJob;
pub use program::Controller;

/// What is being done, in words.
pub(super) const TRYING: &str = "Looking for the next experiment";
