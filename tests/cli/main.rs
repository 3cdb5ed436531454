//! The command line as a user types it.

mod batch;
mod commands;
mod scenarios;
#[path = "../support/shared.rs"]
mod shared;
mod tune;
