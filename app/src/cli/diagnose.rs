//! `hysteron diagnose`: a measurement goes in, the missing effect comes out.

use std::io::{self, IsTerminal, Write};
use std::path::PathBuf;

use hysteron_core::criticism::{Diagnosis, DiagnosisJob, Progress};
use hysteron_core::measurement::{Kind, import_csv};
use web_time::Instant;

use super::text;

/// How the result is written.
#[derive(Clone, Copy, clap::ValueEnum)]
enum Format {
    /// For reading
    Text,
    /// One JSON object
    Json,
}

/// What was measured.
#[derive(Clone, Copy, clap::ValueEnum)]
enum KindArgument {
    /// A motor that moves an inertia
    Drive,
    /// A process with output y
    Process,
}

/// Arguments of `hysteron diagnose`.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The measurement, with units in the header: t [s],u [N m],x1 [rad],v1 [rad/s]
    file: PathBuf,
    /// What was measured; guessed from the columns if left out
    #[arg(long)]
    kind: Option<KindArgument>,
    /// How to write the result
    #[arg(long, default_value = "text")]
    format: Format,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), String> {
    let started = Instant::now();
    let name = arguments
        .file
        .file_name()
        .map_or_else(|| arguments.file.to_string_lossy(), |n| n.to_string_lossy())
        .into_owned();
    let bytes = std::fs::read(&arguments.file)
        .map_err(|e| format!("{}: cannot be read ({e})", arguments.file.to_string_lossy()))?;
    let kind = arguments.kind.map(|k| match k {
        KindArgument::Drive => Kind::Drive,
        KindArgument::Process => Kind::Process,
    });
    let measurement = import_csv(&name, &bytes, kind).map_err(|e| e.to_string())?;
    for warning in &measurement.warnings {
        eprintln!("{name}: {warning}");
    }
    let job = DiagnosisJob::new(&measurement).map_err(|e| format!("{name}: {e}"))?;
    let mut diagnosis = finish(job);
    diagnosis.seconds = started.elapsed().as_secs_f64();
    let output = match arguments.format {
        Format::Json => serde_json::to_string(&diagnosis).map_err(|e| e.to_string())? + "\n",
        Format::Text => text::render(&diagnosis, &name),
    };
    match io::stdout().write_all(output.as_bytes()) {
        // The reader (head, less) has seen enough.
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        other => other.map_err(|e| format!("the result cannot be written ({e})")),
    }
}

/// Runs the job to its end, with progress where somebody watches.
fn finish(mut job: DiagnosisJob) -> Diagnosis {
    let watched = io::stderr().is_terminal();
    let mut shown = String::new();
    loop {
        match job.advance() {
            Progress::Done(diagnosis) => {
                if watched {
                    eprint!("\r{:78}\r", "");
                }
                return diagnosis;
            }
            Progress::Running { fraction, text } => {
                let line = format!("{:3.0} %  {text}", 100.0 * fraction);
                if watched && line != shown {
                    eprint!("\r{line:78.78}");
                    shown = line;
                }
            }
        }
    }
}
