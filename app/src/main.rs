//! Hysteron: the app, and on a native machine its command line.

#[cfg(not(target_arch = "wasm32"))]
fn main() -> std::process::ExitCode {
    hysteron::run(std::env::args_os())
}

#[cfg(target_arch = "wasm32")]
fn main() {
    hysteron::run_web();
}
