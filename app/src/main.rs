//! Hysteron: the app, and on a native machine its command line.

#[cfg(not(target_arch = "wasm32"))]
fn main() -> std::process::ExitCode {
    if let Some(code) = hysteron::cli::run(std::env::args_os()) {
        return code;
    }
    match hysteron::run_native() {
        Ok(()) => std::process::ExitCode::SUCCESS,
        Err(line) => hysteron::cli::without_display(&line),
    }
}

#[cfg(target_arch = "wasm32")]
fn main() {
    hysteron::run_web();
}
