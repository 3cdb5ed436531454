//! The Hysteron app: state, jobs and views, apart from each other.

mod app;
#[cfg(not(target_arch = "wasm32"))]
pub mod cli;
mod hook;
mod jobs;
mod pages;
mod start;
mod theme;
#[cfg(target_arch = "wasm32")]
mod worker_protocol;

pub use app::{HysteronApp, Page};
#[cfg(not(target_arch = "wasm32"))]
pub use start::run_native;
#[cfg(target_arch = "wasm32")]
pub use start::run_web;
