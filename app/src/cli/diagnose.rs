//! `hysteron diagnose FILE.csv`; many files are a batch.

use std::io::{self, IsTerminal as _, Write as _};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::str::FromStr;
use std::time::Instant;

use hysteron_core::criticism::{Diagnosis, DiagnosisJob, Limits, Progress};
use hysteron_core::measurement::{
    self, ImportOptions, Mapping, Measurement, TorqueConstant, import,
};
use hysteron_core::report::{self, Provenance, ReportInput};
use hysteron_core::user_model::UserModel;

use super::Format;
use crate::cores;
use crate::enclosed::DRIVE_02;

#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// CSV with units in its header, such as t [s],u [N m],x1 [rad],v1 [rad/s], or a MATLAB file; many files: one
    /// result each
    #[arg(value_name = "FILE.csv", required = true)]
    pub files: Vec<PathBuf>,
    /// Kind of system; guessed from the columns if not given
    #[arg(long, value_enum)]
    kind: Option<Kind>,
    /// Which column is what: t, u, x1, v1, x2, v2 or y, its name in the file (- before it turns the sign), its
    /// unit; such as "t=time [ms],u=-current [A],x1=enc [counts:4096]"
    #[arg(long, value_name = "WHAT=COLUMN [UNIT],...")]
    map: Option<AsWritten<Mapping>>,
    /// What a current, voltage or command as input becomes, such as "0.05 N m/A"; without it all torques stand in
    /// multiples of it
    #[arg(long, value_name = "VALUE", allow_hyphen_values = true)]
    torque_constant: Option<AsWritten<TorqueConstant>>,
    /// For a person or for a program; of many files one block or one line of JSON each
    #[arg(long, value_enum, default_value = "text")]
    pub format: Format,
    /// What is known of the model: parameters that are fixed or roughly known, effects that it has already
    #[arg(long, value_name = "M.toml")]
    model: Option<PathBuf>,
    /// An effect of your own to be tried: a force as a formula of x, v, u, t (a process: y, u, t) with parameters
    /// to fit, and where they start if you like: "bump: -a*exp(-((x-b)/c)^2); b = 0.5"
    #[arg(long, value_name = "NAME: FORMULA", allow_hyphen_values = true)]
    effect: Vec<String>,
    /// How far the next experiment may go where effects cannot be told apart: the largest input, the longest record
    /// (s), the sampling time (s), the largest speed (of a process: output) and travel, in SI units, such as
    /// "input=0.5,duration=10,travel=3"; what is not named is as in the file, or twice as fast
    #[arg(long, value_name = "NAME=VALUE,...", value_parser = limits)]
    limits: Option<String>,
    /// Write the model with the effects that were found to this file, for --model
    #[arg(long, value_name = "OUT.toml")]
    save_model: Option<PathBuf>,
    /// Write what was found to this file as a page with pictures, for a browser or a printer
    #[arg(long, value_name = "OUT.html")]
    report: Option<PathBuf>,
    /// Add each result to this file as a line of JSON, and skip files whose result is there
    #[arg(long, value_name = "OUT")]
    pub resume: Option<PathBuf>,
    /// Of many files, how many at a time; as many as there are processors if not given
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub jobs: Option<u16>,
}

#[derive(Clone, Copy, Debug, clap::ValueEnum)]
pub(super) enum Kind {
    /// Torque or force in, position or velocity out
    Drive,
    /// Any input u, any output y
    Process,
}

impl From<Kind> for measurement::Kind {
    fn from(kind: Kind) -> Self {
        match kind {
            Kind::Drive => Self::Drive,
            Kind::Process => Self::Process,
        }
    }
}

/// A value of an option and how it was written.
#[derive(Clone, Debug)]
pub(super) struct AsWritten<T> {
    text: String,
    value: T,
}

impl<T: FromStr> FromStr for AsWritten<T> {
    type Err = T::Err;

    fn from_str(text: &str) -> Result<Self, T::Err> {
        Ok(Self {
            text: text.to_owned(),
            value: text.parse()?,
        })
    }
}

/// The limits as written, if they can be read.
fn limits(text: &str) -> Result<String, String> {
    if text.trim_matches([' ', ',']).is_empty() {
        return Err("it names no limit; expected such as input=0.5,duration=10".to_owned());
    }
    let mut any = Limits {
        input: 1.0,
        duration: 1.0,
        step: 1.0,
        speed: None,
        travel: None,
    };
    any.set(text).map_err(|e| e.to_string())?;
    Ok(text.to_owned())
}

/// One file by the contract of a single one; many files, or a file to resume from, as a batch.
pub(super) fn run(arguments: &Arguments) -> ExitCode {
    let model = match arguments.model.as_deref().map(read_model).transpose() {
        Ok(model) => model,
        Err(line) => return super::finish(Err(line)),
    };
    let setup = Setup { arguments, model };
    match (arguments.files.as_slice(), &arguments.resume) {
        ([file], None) => super::finish(single(file, &setup)),
        _ if arguments.report.is_some() || arguments.save_model.is_some() => {
            super::finish(Err(
                "--report and --save-model write the result of one file: give one FILE, without --resume"
                    .to_owned(),
            ))
        }
        _ => super::batch::run(&setup),
    }
}

/// What is asked, and the model that it begins with.
pub(super) struct Setup<'a> {
    pub arguments: &'a Arguments,
    model: Option<UserModel>,
}

fn read_model(path: &Path) -> Result<UserModel, String> {
    let shown = path.display();
    let bytes = std::fs::read(path).map_err(|e| format!("{shown} cannot be read: {e}"))?;
    let text =
        str::from_utf8(&bytes).map_err(|_| format!("{shown}: a model must be UTF-8 text"))?;
    UserModel::from_toml(text).map_err(|e| format!("{shown}, {e}"))
}

/// The report, or one line that says what is wrong with the input.
fn single(file: &Path, setup: &Setup) -> Result<String, String> {
    let arguments = setup.arguments;
    let mut line = ProgressLine::new();
    let report = one(file, setup, |fraction, text| line.show(fraction, text));
    line.clear();
    let report = report?;
    let files = [
        (&arguments.report, &report.page),
        (&arguments.save_model, &report.model),
    ];
    for (path, text) in files {
        if let (Some(path), Some(text)) = (path, text) {
            std::fs::write(path, text)
                .map_err(|e| format!("{} cannot be written: {e}", path.display()))?;
        }
    }
    match arguments.format {
        Format::Text => Ok(report.text(&report.name)),
        Format::Json => report.json().map_err(|e| {
            format!(
                "{}: the diagnosis cannot be written as JSON: {e}",
                report.name
            )
        }),
    }
}

/// The report on a measurement that comes with the app.
pub(super) fn of_built_in(arguments: &Arguments) -> Result<String, String> {
    let (name, bytes) = (DRIVE_02.id, DRIVE_02.csv());
    let measurement = import(name, &bytes, &ImportOptions::default()).map_err(|e| e.to_string())?;
    let setup = Setup {
        arguments,
        model: None,
    };
    let mut line = ProgressLine::new();
    let source = (Path::new(name), bytes.as_slice());
    let report = of(&measurement, source, &setup, |fraction, text| {
        line.show(fraction, text);
    });
    line.clear();
    report.map(|report| report.text(name))
}

/// A finished diagnosis of one file.
pub(super) struct Report {
    name: String,
    /// What the import had to assume or leave out.
    notes: Vec<String>,
    diagnosis: Diagnosis,
    /// As an HTML page, if that is wanted.
    page: Option<String>,
    /// The last model as a file, if that is wanted.
    model: Option<String>,
}

/// A diagnosis as JSON, with what belongs to the file and not to it.
#[derive(serde::Serialize)]
struct Line<'a> {
    #[serde(skip_serializing_if = "Option::is_none")]
    file: Option<&'a str>,
    #[serde(flatten)]
    diagnosis: &'a Diagnosis,
    #[serde(skip_serializing_if = "<[String]>::is_empty")]
    notes: &'a [String],
}

impl Report {
    /// For a person, under this title.
    pub fn text(&self, title: &str) -> String {
        super::text::render(&self.diagnosis, title, &self.notes)
    }

    /// One object on many lines, as a single file prints it.
    fn json(&self) -> serde_json::Result<String> {
        serde_json::to_string_pretty(&self.line(None)).map(|json| json + "\n")
    }

    /// The same object with the name of its file, on one line.
    pub fn json_line(&self, file: &str) -> serde_json::Result<String> {
        serde_json::to_string(&self.line(Some(file)))
    }

    fn line<'a>(&'a self, file: Option<&'a str>) -> Line<'a> {
        Line {
            file,
            diagnosis: &self.diagnosis,
            notes: &self.notes,
        }
    }

    /// The verdict in a few words, for a log.
    pub fn summary(&self) -> String {
        let verdict = &self.diagnosis.verdict;
        let classes: Vec<String> = verdict
            .missing
            .iter()
            .map(|class| {
                let ids: Vec<&str> = class.iter().map(|id| id.as_str()).collect();
                ids.join(" or ")
            })
            .collect();
        let found = if classes.is_empty() {
            "nothing found".to_owned()
        } else {
            classes.join(" + ")
        };
        let rest = if verdict.unknown {
            ", and something unknown"
        } else {
            ""
        };
        format!("{found}{rest} ({:.1} s)", self.diagnosis.seconds)
    }
}

/// Diagnoses one file; `show` hears of progress.
pub(super) fn one(
    file: &Path,
    setup: &Setup,
    show: impl FnMut(f64, &str),
) -> Result<Report, String> {
    let arguments = setup.arguments;
    let options = ImportOptions {
        kind: arguments.kind.map(Into::into),
        mapping: arguments
            .map
            .as_ref()
            .map_or_else(Mapping::default, |m| m.value.clone()),
        torque_constant: arguments.torque_constant.as_ref().map(|c| c.value),
    };
    let (measurement, bytes) = read(file, &options)?;
    of(&measurement, (file, &bytes), setup, show)
}

/// Diagnoses a measurement; `source` is the file that it came from and its bytes.
fn of(
    measurement: &Measurement,
    source: (&Path, &[u8]),
    setup: &Setup,
    mut show: impl FnMut(f64, &str),
) -> Result<Report, String> {
    let arguments = setup.arguments;
    let started = Instant::now();
    let name = measurement.name.clone();
    let blank = || UserModel::blank(measurement.kind);
    let mut given = setup.model.clone().unwrap_or_else(blank);
    for effect in &arguments.effect {
        given
            .add_candidate(effect)
            .map_err(|e| format!("--effect: {e}"))?;
    }
    let mut limits = Limits::of(measurement);
    limits
        .set(arguments.limits.as_deref().unwrap_or_default())
        .map_err(|e| format!("--limits: {e}"))?;
    let mut job = DiagnosisJob::with_model(measurement, &given)
        .map_err(|e| format!("{name}: {e}"))?
        .within(limits)
        .with_crew(&cores::all());
    loop {
        match job.advance() {
            Progress::Running { fraction, text } => show(fraction, &text),
            Progress::Done(mut diagnosis) => {
                for step in &diagnosis.steps {
                    step.checked().map_err(|e| format!("{name}: {e}"))?;
                }
                diagnosis.seconds = started.elapsed().as_secs_f64();
                let page = arguments.report.as_ref().and_then(|_| {
                    let (first, last) = job.evidence()?;
                    Some(report::html(&ReportInput {
                        measurement,
                        steps: &diagnosis.steps,
                        first_atlas: &first.atlas,
                        last,
                        verdict: Some(&diagnosis.verdict),
                        model: (given != blank()).then_some(&given),
                        provenance: &provenance(source.0, arguments, source.1),
                    }))
                });
                let last = diagnosis.steps.last();
                let model = last.filter(|_| arguments.save_model.is_some()).map(|step| {
                    UserModel::from_step(measurement.kind, step, Some(&given)).to_toml()
                });
                return Ok(Report {
                    name,
                    notes: measurement.warnings.clone(),
                    diagnosis,
                    page,
                    model,
                });
            }
        }
    }
}

/// How the diagnosis of this file can be made again.
fn provenance(file: &Path, arguments: &Arguments, bytes: &[u8]) -> Provenance {
    let mut command = format!(
        "hysteron diagnose {}",
        report::shell_word(&file.to_string_lossy())
    );
    let kind = arguments.kind.map(|kind| match kind {
        Kind::Drive => "drive",
        Kind::Process => "process",
    });
    let model = arguments.model.as_ref().map(|m| m.to_string_lossy());
    let options = [
        ("--kind", kind),
        ("--model", model.as_deref()),
        ("--map", arguments.map.as_ref().map(|m| m.text.as_str())),
        (
            "--torque-constant",
            arguments.torque_constant.as_ref().map(|m| m.text.as_str()),
        ),
        ("--limits", arguments.limits.as_deref()),
    ];
    for (option, value) in options {
        if let Some(value) = value {
            command.extend([" ", option, " ", &report::shell_word(value)]);
        }
    }
    for effect in &arguments.effect {
        command.extend([" --effect ", &report::shell_word(effect)]);
    }
    Provenance {
        command,
        version: env!("CARGO_PKG_VERSION").to_owned(),
        bytes: bytes.len(),
        sha256: report::sha256(bytes),
    }
}

/// The measurement and the bytes that it was read from; else one line that says what is wrong with it.
pub(super) fn read(path: &Path, options: &ImportOptions) -> Result<(Measurement, Vec<u8>), String> {
    let name = path
        .file_name()
        .unwrap_or(path.as_os_str())
        .to_string_lossy();
    let shown = path.display();
    if path.is_dir() {
        return Err(format!(
            "{shown} is a directory; expected a CSV or MATLAB file"
        ));
    }
    let bytes = std::fs::read(path).map_err(|e| format!("{shown} cannot be read: {e}"))?;
    let measurement = import(&name, &bytes, options).map_err(|e| e.to_string())?;
    Ok((measurement, bytes))
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
