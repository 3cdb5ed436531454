//! One file (or folder) per page.

mod compare;
mod explore;

pub use compare::Compare;
pub use explore::Explore;
