//! The command line: one file per subcommand, one line in [`Command`] and one in [`Command::run`].
//!
//! Exit code 0 on success, 2 for bad input with exactly one line on stderr (of many files: one for
//! each), 1 where the output cannot be written. A reader that closes the pipe early, such as `head`, is a success.

mod arguments;
mod batch;
mod cycle_table;
mod diagnose;
mod gap;
mod limit_cycle;
mod limit_cycle_drive;
mod limit_cycle_on_off;
mod limit_cycle_servo;
mod one;
mod output;
mod progress_line;
mod read;
mod screen;
mod simulate;
mod text;
mod tune;

use std::ffi::OsString;
use std::path::Path;
use std::process::ExitCode;

use clap::Parser;
use hysteron_core::message::Message;
use hysteron_work::language::{self, Language};

pub use output::{complain, fail};
pub use text::render;

use output::finish;

/// The language that is spoken, for every subcommand.
#[derive(Clone, Copy, Debug, Default, clap::Args)]
pub struct Speech {
    /// Language of text and report: English or German; JSON, help and files stay as they are
    #[arg(
        long,
        value_enum,
        value_name = "LANGUAGE",
        global = true,
        default_value = "en"
    )]
    lang: Code,
}

/// A language by its code.
#[derive(Clone, Copy, Debug, Default, clap::ValueEnum)]
enum Code {
    /// English
    #[default]
    En,
    /// Deutsch
    De,
}

impl Speech {
    /// Speaks it from now on.
    pub fn begin(self) {
        language::speak(match self.lang {
            Code::En => Language::English,
            Code::De => Language::German,
        });
    }
}

/// A subcommand and its arguments.
#[derive(Debug, clap::Subcommand)]
pub enum Command {
    /// Say where a model of a measured system fails and which physical effect is missing.
    Diagnose(arguments::Arguments),
    /// Run a relay loop or a drive from a file.
    Simulate(simulate::Arguments),
    /// Predict a loop's oscillation: describing function, exact, simulated.
    LimitCycle(limit_cycle::Arguments),
    /// Say how wide a drive's hidden gap is, from the motor's columns of a drifting test.
    Gap(gap::Arguments),
    /// Say in a second what could explain a record, by regression and without a simulation.
    Screen(screen::Arguments),
    /// Turn a measured relay test, or the log of an auto-tuner, into models and gains, and say why it stalls.
    Tune(tune::Arguments),
}

impl Command {
    /// Carries it out.
    pub fn run(&self) -> ExitCode {
        match self {
            Self::Diagnose(arguments) => diagnose::run(arguments),
            Self::Simulate(arguments) => finish(simulate::run(arguments)),
            Self::LimitCycle(arguments) => finish(limit_cycle::run(arguments)),
            Self::Gap(arguments) => finish(gap::run(arguments)),
            Self::Screen(arguments) => finish(screen::run(arguments)),
            Self::Tune(arguments) => finish(tune::run(arguments)),
        }
    }
}

/// Reads `arguments`, the first of which is the program.
///
/// # Errors
/// The exit code where there is nothing more to do: help or version is printed, or one line that says what is wrong.
pub fn parse<A: Parser>(arguments: impl IntoIterator<Item = OsString>) -> Result<A, ExitCode> {
    A::try_parse_from(arguments).map_err(|error| {
        // Help and version are asked for, not errors.
        finish(if error.use_stderr() {
            Err(usage_error(&error, A::command().get_name()))
        } else {
            Ok(error.to_string())
        })
    })
}

/// What was wrong with the arguments, without the usage text beneath it.
fn usage_error(error: &clap::Error, program: &str) -> Message {
    let text = error.to_string();
    let first = text.split("\n\n").next().unwrap_or_default();
    let first = first.strip_prefix("error: ").unwrap_or(first);
    Message::name(format!("{first}; see {program} --help"))
}

/// Diagnoses a file as `diagnose FILE.csv` does.
pub fn diagnose_file(file: &Path) -> ExitCode {
    diagnose::run(&arguments::Arguments::of(file))
}

/// Diagnoses a measurement of this name that is no file.
pub fn diagnose_bytes(name: &str, bytes: &[u8]) -> ExitCode {
    finish(diagnose::of_bytes(name, bytes))
}
