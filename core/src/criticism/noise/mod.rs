//! What chance does in a record: how much noise each channel has, and whether what a model leaves is noise.

mod input;
mod level;
mod memory;
mod pushes;
mod tuning;
mod wander;

pub(super) use input::left_by_input;
pub use level::noise_level;
pub(super) use level::{Noise, noise_beside};
pub(super) use memory::is_noise_with_memory;
pub(super) use pushes::is_left_by_random_forces;
pub(super) use tuning::WANDER;
pub(super) use wander::{news, news_left};
