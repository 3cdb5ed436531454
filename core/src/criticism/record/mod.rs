//! What was measured, and how well: which samples of a channel tell something, and on which lattice its values lie.

mod glitches;
mod held;
mod lattice;
mod levels;
mod limited;
mod tuning;

pub(super) use glitches::mend;
pub(super) use held::{bridged, fresh};
pub(super) use lattice::{lattice, resolution};
pub(super) use levels::{Levelled, levelled};
pub(super) use limited::limited;
pub(super) use tuning::ARITHMETIC;
