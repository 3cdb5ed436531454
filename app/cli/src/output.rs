//! What goes to stdout and stderr, and the exit code that comes of it.

use std::io::{self, Write as _};
use std::process::ExitCode;

use hysteron_core::message::Message;
use hysteron_core::msg;
use hysteron_core::simulate::Noise;
use hysteron_work::language::say;

/// How a result is written.
#[derive(Clone, Copy, Debug, clap::ValueEnum)]
pub enum Format {
    /// Words and tables
    Text,
    /// One JSON object; of many files one line each
    Json,
}

/// Prints what a subcommand has to say, or the one line that says what is wrong with its input.
pub fn finish(result: Result<String, Message>) -> ExitCode {
    match result {
        Ok(output) => print(&output),
        Err(line) => fail(line, 2),
    }
}

/// Prints a text; the exit code.
pub fn print(output: &str) -> ExitCode {
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
pub fn write_error(error: &io::Error) -> ExitCode {
    if error.kind() == io::ErrorKind::BrokenPipe {
        ExitCode::SUCCESS
    } else {
        let cause = Message::name(error.to_string());
        fail(msg!("the output cannot be written: {}", cause), 1)
    }
}

/// Says in one line what is wrong, in the language that is spoken; the exit code.
pub fn fail(message: impl Into<Message>, code: u8) -> ExitCode {
    complain(&say(message.into()));
    ExitCode::from(code)
}

/// Exactly one line on stderr, whatever a file name or an argument has in it.
pub fn complain(message: &str) {
    let words: Vec<&str> = message
        .split(|c: char| c.is_control() || c == ' ')
        .filter(|w| !w.is_empty())
        .collect();
    // Where stderr is closed there is nobody left to tell.
    let _ = writeln!(io::stderr(), "hysteron: {}", words.join(" "));
}

/// Each line in the language that is spoken.
pub fn say_lines(lines: &[Message]) -> String {
    lines.iter().map(|line| say(line) + "\n").collect()
}

/// How far a prediction of period and amplitude is off, in a sentence.
pub fn off_by(predicted: [f64; 2], exact: [f64; 2]) -> Message {
    let [period, amplitude] = [0, 1].map(|i| 100.0 * (predicted[i] / exact[i] - 1.0));
    let trusted = period.abs() <= TRUSTED && amplitude.abs() <= TRUSTED;
    let [period, amplitude] = [period, amplitude].map(|off| format!("{off:+.1}"));
    if trusted {
        msg!(
            "The describing function is off by {} % in period and {} % in amplitude.",
            period,
            amplitude
        )
    } else {
        msg!(
            "The describing function is off by {} % in period and {} % in amplitude: do not trust it here.",
            period,
            amplitude
        )
    }
}

/// Beside an answer for a loop without noise, where the file has some; nothing where it has none.
pub fn without_noise(noise: Option<Noise>) -> &'static str {
    noise.map_or(
        "",
        |_| "The noise of the file is left out here; simulate has it.",
    )
}

/// Per cent by which a prediction may be off and still be called good.
const TRUSTED: f64 = 5.0;
