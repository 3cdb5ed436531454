//! What can be measured on the bench.

use hysteron_core::measurement::Kind;

/// Name of what can be measured, and its name for tests.
pub const MACHINES: [(Kind, &str, &str); 2] = [
    (Kind::Drive, "drive", "A drive"),
    (Kind::Process, "process", "A process"),
];
