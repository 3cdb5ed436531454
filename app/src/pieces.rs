//! Independent pieces of a computation: on all cores natively, one after the other on the web, where a worker
//! has one.

use hysteron_core::criticism::Piece;

/// Pieces per core that are handed out at a time: enough that a long one does not keep the other cores waiting.
#[cfg(not(target_arch = "wasm32"))]
const PER_CORE: usize = 4;

/// Most pieces that [`run`] should get at a time.
#[cfg(not(target_arch = "wasm32"))]
pub fn width() -> usize {
    PER_CORE * rayon::current_num_threads()
}

/// Does the pieces.
#[cfg(not(target_arch = "wasm32"))]
pub fn run(pieces: &mut [Piece<'_>]) {
    use rayon::prelude::*;
    pieces.par_iter_mut().for_each(Piece::run);
}

/// Most pieces that [`run`] should get at a time.
#[cfg(target_arch = "wasm32")]
pub fn width() -> usize {
    1
}

/// Does the pieces.
#[cfg(target_arch = "wasm32")]
pub fn run(pieces: &mut [Piece<'_>]) {
    pieces.iter_mut().for_each(Piece::run);
}
