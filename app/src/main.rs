//! Hysteron: the app, and on a native machine its command line.

#[cfg(not(target_arch = "wasm32"))]
fn main() -> std::process::ExitCode {
    let file = match hysteron::cli::run(std::env::args_os()) {
        hysteron::cli::Outcome::Ended(code) => return code,
        hysteron::cli::Outcome::Window(file) => file,
    };
    match hysteron::run_native(file.clone()) {
        Ok(()) => std::process::ExitCode::SUCCESS,
        Err(line) => hysteron::cli::without_display(&line, file.as_deref()),
    }
}

#[cfg(target_arch = "wasm32")]
fn main() {
    hysteron::run_web();
}
