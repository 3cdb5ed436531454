//! What the app and the worker of the web page share: long computations by name, what they need and what they say, and
//! the files that they read; and what the app and the command line share: languages. Nothing here draws.

pub mod content;
#[cfg(not(target_arch = "wasm32"))]
pub mod cores;
pub mod enclosed;
pub mod language;
pub mod link;
mod loops;
mod measured;
pub mod packed;
pub mod reading;
pub mod tasks;
#[cfg(any(test, target_arch = "wasm32"))]
pub mod wire;
pub mod work;
#[cfg(target_arch = "wasm32")]
pub mod worker;
