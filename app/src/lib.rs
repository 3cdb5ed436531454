//! The Hysteron app: state, jobs and views, apart from each other.

mod address;
mod app;
mod bar;
mod colors;
mod document;
#[cfg(any(test, target_arch = "wasm32"))]
mod edges;
pub mod export;
mod files;
mod hook;
mod jobs;
pub mod language;
mod layout;
pub mod lessons;
pub mod link;
mod motion;
mod notice;
mod pages;
#[cfg(not(target_arch = "wasm32"))]
mod program;
mod purpose;
mod recent;
mod save;
mod shortcuts;
mod start;
mod theme;
mod zoom;

pub use app::{GivenFile, HysteronApp};
#[cfg(not(target_arch = "wasm32"))]
pub use program::run;
#[cfg(target_arch = "wasm32")]
pub use start::run_web;
