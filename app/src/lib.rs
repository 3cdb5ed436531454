//! The Hysteron app: state, jobs and views, apart from each other.

mod app;
mod start;

pub use app::HysteronApp;
#[cfg(not(target_arch = "wasm32"))]
pub use start::run_native;
#[cfg(target_arch = "wasm32")]
pub use start::run_web;
