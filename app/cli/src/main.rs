//! The command line of Hysteron where no window is wanted, such as on the nodes of a cluster.

use std::process::ExitCode;

/// A laboratory for relay feedback systems, without a window.
#[derive(Debug, clap::Parser)]
#[command(name = "hysteron-cli", version, arg_required_else_help = false)]
struct Arguments {
    #[command(flatten)]
    speech: hysteron_cli::Speech,
    #[command(subcommand)]
    command: hysteron_cli::Command,
}

fn main() -> ExitCode {
    match hysteron_cli::parse::<Arguments>(std::env::args_os()) {
        Ok(arguments) => {
            arguments.speech.begin();
            arguments.command.run()
        }
        Err(code) => code,
    }
}
