//! Hysteron: the app, and on a native machine its command line.

fn main() {}
