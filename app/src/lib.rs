//! The Hysteron app: state, jobs and views, apart from each other.

mod address;
mod app;
mod bar;
mod colors;
mod command;
mod desk;
mod document;
#[cfg(any(test, target_arch = "wasm32"))]
mod edges;
pub mod export;
mod files;
mod fonts;
mod hook;
mod jobs;
mod layout;
pub mod lessons;
pub use hysteron_work::link;
mod live;
mod motion;
mod notice;
mod page;
mod pages;
mod purpose;
mod purpose_line;
mod recent;
mod save;
mod shortcuts;
mod theme;
mod widgets;
mod zoom;

pub use app::HysteronApp;
#[cfg(not(target_arch = "wasm32"))]
pub use app::program::run;
#[cfg(target_arch = "wasm32")]
pub use app::start::run_web;
pub use hysteron_work::language;
pub use save::GivenFile;
