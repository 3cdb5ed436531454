//! Rigs that are not the project's model, and what is hidden in them.

#![allow(
    clippy::disallowed_methods,
    clippy::disallowed_macros,
    reason = "the core neither prints nor starts threads nor reads the clock; its bench does"
)]
#![allow(
    clippy::large_types_passed_by_value,
    reason = "definitions of rigs are plain values"
)]
#![allow(dead_code, reason = "each test uses a part of the rigs")]

pub mod case;
pub mod controlled;
pub mod diagnosis;
pub mod drive_cases;
pub mod file;
pub mod hidden_force;
pub mod mat;
pub mod parameter;
pub mod process_cases;
pub mod proposed;
pub mod pulses;
pub mod record;
pub mod relay_rig;
pub mod rig;
pub mod score;
pub mod servo;
pub mod shared;
pub mod sparse;
pub mod threads;
pub mod value;
