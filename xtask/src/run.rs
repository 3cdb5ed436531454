//! Running other programs.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// File name of the native program.
#[cfg(windows)]
pub const PROGRAM: &str = "hysteron.exe";
#[cfg(not(windows))]
pub const PROGRAM: &str = "hysteron";

/// Top folder of the project.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .map_or_else(|| PathBuf::from("."), Path::to_path_buf)
}

/// Runs a program in the project's folder; an error says which one failed.
pub fn run(program: &str, arguments: &[&str]) -> Result<(), String> {
    check(
        Command::new(program).args(arguments).current_dir(root()),
        program,
        arguments,
    )
}

/// Runs cargo in the project's folder, with a variable of the environment. Without what would make building again
/// after a change faster: that takes gigabytes, and all that the tests need is built once.
pub fn cargo(arguments: &[&str], variable: Option<(&str, &str)>) -> Result<(), String> {
    let mut command = Command::new("cargo");
    command
        .args(arguments)
        .env("CARGO_INCREMENTAL", "0")
        .envs(variable)
        .current_dir(root());
    check(&mut command, "cargo", arguments)
}

/// Runs a prepared command.
pub fn check(command: &mut Command, program: &str, arguments: &[&str]) -> Result<(), String> {
    let shown = format!("{program} {}", arguments.join(" "));
    let status = command.status().map_err(|e| format!("{shown}: {e}"))?;
    if status.success() {
        Ok(())
    } else {
        Err(format!("{shown}: {status}"))
    }
}

/// What a program prints; `None` if it fails or is not there.
pub fn output(program: &str, arguments: &[&str]) -> Option<String> {
    let out = Command::new(program)
        .args(arguments)
        .current_dir(root())
        .stdin(Stdio::null())
        .stderr(Stdio::null())
        .output()
        .ok()?;
    out.status
        .success()
        .then(|| String::from_utf8_lossy(&out.stdout).trim().to_owned())
}

/// Whether a program is on the path.
pub fn exists(program: &str) -> bool {
    std::env::var_os("PATH")
        .is_some_and(|path| std::env::split_paths(&path).any(|dir| dir.join(program).is_file()))
}
