//! Which formula would explain what no effect does?
//!
//! Terms are built from the bottom up ([`grammar`]) and tried in the equation of motion by regression, with the body
//! and one or two at a time ([`search`], [`weak`]); the best few of each length are simulated exactly, as a user's own
//! formulas, and judged as any effect is. The answer is the shortest that the record cannot tell from the best one.

mod curve;
mod grammar;
mod job;
mod judge;
mod numbers;
mod pool;
mod search;
mod sum;
mod tuning;
mod weak;
mod written;

pub use job::DiscoveryJob;
