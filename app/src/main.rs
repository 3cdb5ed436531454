//! Hysteron: the app, and on a native machine its command line.

#[cfg(not(target_arch = "wasm32"))]
fn main() -> std::process::ExitCode {
    hysteron::run(std::env::args_os())
}

#[cfg(target_arch = "wasm32")]
fn main() {
    // One module for the page and for its workers: they have no window.
    if web_sys::window().is_some() {
        hysteron::run_web();
    } else {
        hysteron_work::worker::listen();
    }
}
