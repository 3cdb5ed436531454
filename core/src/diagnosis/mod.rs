//! Plain data of a finished diagnosis: serialisable, no computation.

mod screening;

pub use screening::{InputCheck, InputVerdict, Screening, Subset};
