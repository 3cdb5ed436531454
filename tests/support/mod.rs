//! Rigs that are not the project's model, and what is hidden in them.

pub mod case;
pub mod drive_cases;
pub mod drive_rig;
pub mod process_cases;
pub mod process_rig;
pub mod random;
pub mod score;
