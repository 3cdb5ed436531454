//! Independent pieces of a computation on all cores. (In a browser the worker has one and asks for none.)

use hysteron_core::criticism::Piece;
use rayon::prelude::*;

/// Pieces per core that are handed out at a time: enough that a long one does not keep the other cores waiting.
const PER_CORE: usize = 4;

/// Most pieces that [`run`] should get at a time.
pub fn width() -> usize {
    PER_CORE * rayon::current_num_threads()
}

/// Does the pieces.
pub fn run(pieces: &mut [Piece<'_>]) {
    pieces.par_iter_mut().for_each(Piece::run);
}
