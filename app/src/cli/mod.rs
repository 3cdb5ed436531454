//! The command line: one file per subcommand, one line in `Command` and one in `dispatch`.
//!
//! Exit code 0 on success, 2 for bad input with exactly one line on stderr (of many files: one for
//! each), 1 where the output cannot be written. A reader that closes the pipe early, such as `head`, is a success.

mod batch;
mod diagnose;
mod gap;
mod limit_cycle;
mod limit_cycle_drive;
mod simulate;
mod text;
mod tune;

use std::ffi::{OsStr, OsString};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Parser;

pub use text::render;

/// A laboratory for relay feedback systems. Without a command, the app opens, with a measurement if one is given.
#[derive(Debug, Parser)]
#[command(name = "hysteron", version, args_conflicts_with_subcommands = true)]
struct Arguments {
    /// A measurement to open in the app, as CSV or MATLAB file; of many the first
    #[arg(value_name = "FILE.csv")]
    files: Vec<PathBuf>,
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Debug, clap::Subcommand)]
enum Command {
    /// Say where a model of a measured system fails and which physical effect is missing.
    Diagnose(diagnose::Arguments),
    /// Run a relay loop or a drive from a file.
    Simulate(simulate::Arguments),
    /// Predict a loop's oscillation: describing function, exact, simulated.
    LimitCycle(limit_cycle::Arguments),
    /// Say how wide a drive's hidden gap is, from the motor's columns of a drifting test.
    Gap(gap::Arguments),
    /// From a measured relay test, or the log of an auto-tuner, to gains: what it shows, models, and why it stalls.
    Tune(tune::Arguments),
}

/// How a result is written.
#[derive(Clone, Copy, Debug, clap::ValueEnum)]
enum Format {
    /// Words and tables
    Text,
    /// One JSON object; of many files one line each
    Json,
}

fn dispatch(command: &Command) -> ExitCode {
    match command {
        Command::Diagnose(arguments) => diagnose::run(arguments),
        Command::Simulate(arguments) => finish(simulate::run(arguments)),
        Command::LimitCycle(arguments) => finish(limit_cycle::run(arguments)),
        Command::Gap(arguments) => finish(gap::run(arguments)),
        Command::Tune(arguments) => finish(tune::run(arguments)),
    }
}

/// What becomes of the program's arguments.
#[derive(Debug)]
pub enum Outcome {
    /// All was done.
    Ended(ExitCode),
    /// The app should start, with this file if there is one.
    Window(Option<PathBuf>),
}

/// Runs the subcommand in `arguments`, the first of which is the program.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> Outcome {
    Outcome::Ended(match Arguments::try_parse_from(arguments) {
        Ok(Arguments {
            command: Some(command),
            ..
        }) => dispatch(&command),
        Ok(Arguments { files, .. }) => match files.into_iter().next() {
            // A command that is misspelled is no file either.
            Some(file) if !file.exists() => {
                let name = file.display();
                let line = format!("{name}: there is no such file or command; see hysteron --help");
                fail(&line, 2)
            }
            file => return Outcome::Window(file),
        },
        // Help and version are asked for, not errors.
        Err(error) if !error.use_stderr() => finish(Ok(error.to_string())),
        Err(error) => finish(Err(usage_error(&error))),
    })
}

/// What the program does where there is no display: says so, and diagnoses `file`, or a measurement that comes with it.
pub fn without_display(line: &str, file: Option<&Path>) -> ExitCode {
    complain(line);
    let name = file.map_or(OsStr::new("built-in"), Path::as_os_str);
    let diagnose = ["hysteron", "diagnose", "--"].map(OsStr::new);
    let arguments = Arguments::try_parse_from(diagnose.into_iter().chain([name]));
    match (arguments.map(|a| a.command), file) {
        (Ok(Some(command)), Some(_)) => dispatch(&command),
        (Ok(Some(Command::Diagnose(arguments))), None) => finish(diagnose::of_built_in(&arguments)),
        _ => ExitCode::from(2),
    }
}

/// Prints what a subcommand has to say, or the one line that says what is wrong with its input.
fn finish(result: Result<String, String>) -> ExitCode {
    match result {
        Ok(output) => print(&output),
        Err(line) => fail(&line, 2),
    }
}

/// What was wrong with the arguments, without the usage text beneath it.
fn usage_error(error: &clap::Error) -> String {
    let text = error.to_string();
    let first = text.split("\n\n").next().unwrap_or_default();
    let first = first.strip_prefix("error: ").unwrap_or(first);
    format!("{first}; see hysteron --help")
}

fn print(output: &str) -> ExitCode {
    let mut stdout = io::stdout().lock();
    match stdout
        .write_all(output.as_bytes())
        .and_then(|()| stdout.flush())
    {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => write_error(&error),
    }
}

/// The exit code where stdout or a file of results cannot be written.
fn write_error(error: &io::Error) -> ExitCode {
    if error.kind() == io::ErrorKind::BrokenPipe {
        ExitCode::SUCCESS
    } else {
        fail(&format!("the output cannot be written: {error}"), 1)
    }
}

fn fail(message: &str, code: u8) -> ExitCode {
    complain(message);
    ExitCode::from(code)
}

/// Exactly one line on stderr, whatever a file name or an argument has in it.
fn complain(message: &str) {
    let words: Vec<&str> = message
        .split(|c: char| c.is_control() || c == ' ')
        .filter(|w| !w.is_empty())
        .collect();
    // Where stderr is closed there is nobody left to tell.
    let _ = writeln!(io::stderr(), "hysteron: {}", words.join(" "));
}
