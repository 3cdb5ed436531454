//! Set-up, web build, serve, tests: `cargo xtask help`.
fn main() {}
