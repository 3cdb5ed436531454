//! The command line as a user types it.

mod batch;
mod commands;
mod scenarios;
mod tune;
