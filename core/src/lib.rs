//! Everything that Hysteron computes.
//!
//! No interface, no files, no clock, no threads: the same values in give the same
//! values out, natively and in the browser. Modules are named after the question
//! that a user asks, and each imports only from those above it:
//!
//! | module | question |
//! |---|---|
//! | [`crew`] | who does the parts of a computation? |
//! | [`progress`] | how far has a computation come? |
//! | [`message`] | what is said, before it is in a language? |
//! | [`count`] | how many are there, in words? |
//! | [`uncertain`] | how sure is a value, in words? |
//! | [`equation`] | what does an equation in a file look like in a book? |
//! | [`curve`] | which points of a curve does a picture need? |
//! | [`measurement`] | what was measured? |
//! | [`relay`] | what does the relay do? |
//! | [`plant`] | what does it act on? |
//! | [`simulate`] | what happens? |
//! | [`limit_cycle`] | does it oscillate, how, and is it stable? |
//! | [`on_off`] | the same for controllers as they are built: dead zone, minimum times, sampling |
//! | [`tuning`] | how do I tune a controller from it, or from a measured test? |
//! | [`explore`] | everything about one loop at once |
//! | [`figures`] | do the paper's Figs. 3 to 5 hold? |
//! | [`maps`] | how does the oscillation change with two parameters? |
//! | [`model`] | what does a model say to a measured input? |
//! | [`drive`] | what does a drive with a hidden gap do? |
//! | [`hunting`] | does a position controller hunt around dry friction, cogging or play? |
//! | [`backlash`] | how wide is the hidden gap? |
//! | [`rig`] | what would a bench measure, by other physics? |
//! | [`effect`] | which physics can be added? |
//! | [`diagnosis`] | what does a finished diagnosis say? |
//! | [`user_model`] | what does the user know of the model? |
//! | [`by_hand`] | what does the model say with values that someone sets? |
//! | [`criticism`] | where does the model fail, what is missing, how sure? |
//! | [`report`] | what was found, on one page |
//! | [`mystery`] | which effect is hidden? |
//! | [`scenario`] | a loop or a drive in a file |
#![warn(missing_docs, clippy::disallowed_methods)]

pub mod backlash;
pub mod by_hand;
mod controller;
pub mod count;
pub mod crew;
pub mod criticism;
pub mod curve;
pub mod diagnosis;
pub mod drive;
pub mod effect;
pub mod equation;
pub mod explore;
mod exponential;
pub mod figures;
mod fourier;
pub mod hunting;
mod least_squares;
pub mod limit_cycle;
pub mod maps;
pub mod measurement;
pub mod message;
pub mod model;
pub mod mystery;
pub mod on_off;
pub mod opening;
mod order;
mod packed;
pub mod plant;
pub mod progress;
mod random;
pub mod relay;
pub mod report;
pub mod rig;
mod root;
pub mod scenario;
mod simplex;
pub mod simulate;
mod sums;
pub mod tuning;
pub mod uncertain;
pub mod user_model;
