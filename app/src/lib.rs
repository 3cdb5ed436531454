//! The Hysteron app: state, jobs and views, apart from each other.

mod address;
mod app;
mod bar;
#[cfg(not(target_arch = "wasm32"))]
pub mod cli;
mod colors;
mod content;
#[cfg(not(target_arch = "wasm32"))]
mod cores;
mod document;
#[cfg(any(test, target_arch = "wasm32"))]
mod edges;
mod enclosed;
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
mod packed;
mod pages;
mod purpose;
mod reading;
mod recent;
mod save;
mod shortcuts;
mod start;
mod tasks;
mod theme;
#[cfg(any(test, target_arch = "wasm32"))]
mod wire;
#[cfg(not(target_arch = "wasm32"))]
mod work;
mod zoom;

pub use app::{GivenFile, HysteronApp};
#[cfg(not(target_arch = "wasm32"))]
pub use start::run_native;
#[cfg(target_arch = "wasm32")]
pub use start::run_web;
