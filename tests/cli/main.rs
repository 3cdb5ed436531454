//! The command line as a user types it.

mod batch;
mod commands;
mod german;
mod scenarios;
#[path = "../support/shared.rs"]
mod shared;
mod tune;
