//! The Hysteron app: state, jobs and views, apart from each other.

mod app;
#[cfg(not(target_arch = "wasm32"))]
pub mod cli;
mod colors;
mod hook;
mod jobs;
mod pages;
mod save;
mod start;
mod tasks;
mod theme;
#[cfg(not(target_arch = "wasm32"))]
mod work;

pub use app::HysteronApp;
#[cfg(not(target_arch = "wasm32"))]
pub use start::run_native;
#[cfg(target_arch = "wasm32")]
pub use start::run_web;
