//! The independent parts of a computation on all cores.

use hysteron_core::crew::{Crew, Hands};
use rayon::prelude::*;

/// Parts per core that are handed out at a time: enough that a long one does not keep the other cores waiting.
const PER_CORE: usize = 4;

struct Cores;

impl Hands for Cores {
    fn width(&self) -> usize {
        PER_CORE * rayon::current_num_threads()
    }

    fn each(&self, count: usize, part: &(dyn Fn(usize) + Sync)) {
        // One by one: parts differ in length.
        let parts = (0..count).into_par_iter().with_max_len(1);
        parts.for_each(part);
    }
}

/// All cores.
pub fn all() -> Crew {
    Crew::new(Cores)
}
