//! The program on a native machine: a window without a subcommand, else the command line.

use hysteron_core::message::Message;
use hysteron_core::msg;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use hysteron_work::enclosed::DRIVE_02;

use super::start::run_native;

/// A laboratory for relay feedback systems. Without a command, the app opens, with a measurement if one is given.
#[derive(Debug, clap::Parser)]
#[command(name = "hysteron", version, args_conflicts_with_subcommands = true)]
struct Arguments {
    /// A measurement to open in the app, as CSV or MATLAB file; of many the first
    #[arg(value_name = "FILE.csv")]
    files: Vec<PathBuf>,
    #[command(flatten)]
    speech: hysteron_cli::Speech,
    #[command(subcommand)]
    command: Option<hysteron_cli::Command>,
}

/// Does what `arguments` say, the first of which is the program.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
    match hysteron_cli::parse::<Arguments>(arguments) {
        Ok(arguments) => {
            arguments.speech.begin();
            match arguments.command {
                Some(command) => command.run(),
                None => window(arguments.files.into_iter().next()),
            }
        }
        Err(code) => code,
    }
}

/// Opens the window, with this file if there is one.
fn window(file: Option<PathBuf>) -> ExitCode {
    match file {
        // A command that is misspelled is no file either.
        Some(file) if !file.exists() => {
            let name = Message::name(file.display().to_string());
            let line = msg!(
                "{}: there is no such file or command; see hysteron --help",
                name
            );
            hysteron_cli::fail(line, 2)
        }
        file => match run_native(file.clone()) {
            Ok(()) => ExitCode::SUCCESS,
            Err(line) => without_display(&line, file.as_deref()),
        },
    }
}

/// Says that there is no display, and diagnoses `file`, or a measurement that comes with the app.
fn without_display(line: &str, file: Option<&Path>) -> ExitCode {
    hysteron_cli::complain(line);
    match file {
        Some(file) => hysteron_cli::diagnose_file(file),
        None => hysteron_cli::diagnose_bytes(DRIVE_02.id, &DRIVE_02.csv()),
    }
}
