//! The command line: `hysteron diagnose FILE.csv`.

mod diagnose;
pub mod text;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

/// A laboratory for relay feedback systems. Without a command the app opens.
#[derive(Parser)]
#[command(name = "hysteron", version, about)]
struct Arguments {
    #[command(subcommand)]
    command: Option<Command>,
}

/// One variant per command; each is a file.
#[derive(Subcommand)]
enum Command {
    /// Find out which physical effect a model of this measurement is missing
    Diagnose(diagnose::Arguments),
}

/// Exit code for bad input.
const BAD_INPUT: u8 = 2;

/// Runs the command that the arguments name; `None` if they name none and the app should open.
pub fn run() -> Option<ExitCode> {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => {
            // Help and version are no errors; they print themselves.
            if error.exit_code() == 0 {
                let _ = error.print();
                return Some(ExitCode::SUCCESS);
            }
            let text = error.to_string();
            let first: Vec<&str> = text.lines().take_while(|l| !l.trim().is_empty()).map(str::trim).collect();
            let line = first.join(" ");
            return Some(bad_input(&format!("{}; see hysteron --help", line.trim_start_matches("error: "))));
        }
    };
    let result = match arguments.command? {
        Command::Diagnose(arguments) => diagnose::run(&arguments),
    };
    Some(match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(line) => bad_input(&line),
    })
}

fn bad_input(line: &str) -> ExitCode {
    eprintln!("hysteron: {line}");
    ExitCode::from(BAD_INPUT)
}
