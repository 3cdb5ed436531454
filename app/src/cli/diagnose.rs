//! `hysteron diagnose FILE.csv`

use std::io::{self, IsTerminal as _, Write as _};
use std::path::{Path, PathBuf};
use std::time::Instant;

use hysteron_core::criticism::{Diagnosis, DiagnosisJob, Progress};
use hysteron_core::measurement::{self, Measurement, import_csv};

#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// Measurement with units in its header, such as t [s],u [N m],x1 [rad],v1 [rad/s]
    #[arg(value_name = "FILE.csv")]
    file: PathBuf,
    /// Kind of system; guessed from the columns if not given
    #[arg(long, value_enum)]
    kind: Option<Kind>,
    /// For a person or for a program
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
}

#[derive(Clone, Copy, Debug, clap::ValueEnum)]
enum Kind {
    /// Torque or force in, position or velocity out
    Drive,
    /// Any input u, any output y
    Process,
}

#[derive(Clone, Copy, Debug, clap::ValueEnum)]
enum Format {
    /// A report in words and tables
    Text,
    /// One JSON object
    Json,
}

/// The report, or one line that says what is wrong with the input.
pub(super) fn run(arguments: &Arguments) -> Result<String, String> {
    let started = Instant::now();
    let measurement = read(&arguments.file, arguments.kind)?;
    let mut diagnosis = diagnose(&measurement).map_err(|e| format!("{}: {e}", measurement.name))?;
    diagnosis.seconds = started.elapsed().as_secs_f64();
    match arguments.format {
        Format::Text => Ok(super::text::render(&diagnosis, &measurement.name)),
        Format::Json => serde_json::to_string_pretty(&diagnosis)
            .map(|json| json + "\n")
            .map_err(|e| {
                format!(
                    "{}: the diagnosis cannot be written as JSON: {e}",
                    measurement.name
                )
            }),
    }
}

fn read(path: &Path, kind: Option<Kind>) -> Result<Measurement, String> {
    let name = path
        .file_name()
        .unwrap_or(path.as_os_str())
        .to_string_lossy();
    let shown = path.display();
    if path.is_dir() {
        return Err(format!("{shown} is a directory; expected a CSV file"));
    }
    let bytes = std::fs::read(path).map_err(|e| format!("{shown} cannot be read: {e}"))?;
    let kind = kind.map(|k| match k {
        Kind::Drive => measurement::Kind::Drive,
        Kind::Process => measurement::Kind::Process,
    });
    import_csv(&name, &bytes, kind).map_err(|e| e.to_string())
}

fn diagnose(
    measurement: &Measurement,
) -> Result<Diagnosis, hysteron_core::criticism::CriticismError> {
    let mut job = DiagnosisJob::new(measurement)?;
    let mut line = ProgressLine::new();
    loop {
        match job.advance() {
            Progress::Running { fraction, text } => line.show(fraction, &text),
            Progress::Done(diagnosis) => {
                line.clear();
                return Ok(diagnosis);
            }
        }
    }
}

/// One line on stderr that is written over again and again; nothing where stderr is no terminal.
struct ProgressLine {
    terminal: bool,
    shown: String,
}

impl ProgressLine {
    fn new() -> Self {
        Self {
            terminal: io::stderr().is_terminal(),
            shown: String::new(),
        }
    }

    fn show(&mut self, fraction: f64, text: &str) {
        if !self.terminal {
            return;
        }
        let line: String = format!("{:3.0} % {text}", fraction * 100.0)
            .chars()
            .take(79)
            .collect();
        if line != self.shown {
            // Progress that cannot be shown is no reason to stop.
            let _ = write!(io::stderr(), "\r\x1b[K{line}");
            self.shown = line;
        }
    }

    fn clear(&self) {
        if !self.shown.is_empty() {
            let _ = write!(io::stderr(), "\r\x1b[K");
        }
    }
}
