//! The diagnosis of one file.

use std::path::Path;
use std::time::Instant;

use hysteron_core::criticism::{DiagnosisJob, DiscoveryJob};
use hysteron_core::diagnosis::{Diagnosis, Discovery, Limits};
use hysteron_core::effect::{EffectId, VISCOUS_FRICTION};
use hysteron_core::measurement::{ImportOptions, Mapping, Measurement};
use hysteron_core::message::Message;
use hysteron_core::msg;
use hysteron_core::progress::Progress;
use hysteron_core::report::{self, Provenance, ReportInput, Tongue};
use hysteron_core::user_model::UserModel;
use hysteron_work::cores;
use hysteron_work::language::{Language, say, spoken, tr_number};

use crate::arguments::{Arguments, Kind};
use crate::read::read;
use crate::text::{formulas, render};

/// What is asked, and the model that it begins with.
pub struct Setup<'a> {
    pub arguments: &'a Arguments,
    pub model: Option<UserModel>,
}

/// A finished diagnosis of one file.
pub struct Report {
    pub name: String,
    /// What the import had to assume or leave out.
    notes: Vec<Message>,
    diagnosis: Diagnosis,
    /// The formula of what is left, if that is wanted.
    discovery: Option<Discovery>,
    /// As an HTML page, if that is wanted.
    pub page: Option<String>,
    /// The last model as a file, if that is wanted.
    pub model: Option<String>,
}

/// A diagnosis as JSON, with what belongs to the file and not to it.
#[derive(serde::Serialize)]
struct Line<'a> {
    #[serde(skip_serializing_if = "Option::is_none")]
    file: Option<&'a str>,
    #[serde(flatten)]
    diagnosis: &'a Diagnosis,
    #[serde(skip_serializing_if = "Option::is_none")]
    discovery: Option<&'a Discovery>,
    #[serde(skip_serializing_if = "<[Message]>::is_empty")]
    notes: &'a [Message],
}

impl Report {
    /// For a person, under this title.
    pub fn text(&self, title: &str) -> String {
        let mut text = render(&self.diagnosis, title, &self.notes);
        if let Some(discovery) = &self.discovery {
            text.push_str(&formulas(discovery));
        }
        text
    }

    /// One object on many lines, as a single file prints it.
    pub fn json(&self) -> serde_json::Result<String> {
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
            discovery: self.discovery.as_ref(),
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
                ids.join(&format!(" {} ", say("or")))
            })
            .collect();
        let found = if classes.is_empty() {
            say("nothing found")
        } else {
            classes.join(" + ")
        };
        let rest = if verdict.unknown {
            format!(", {}", say("and something unknown"))
        } else {
            String::new()
        };
        let seconds = tr_number(format!("({:.1} s)", self.diagnosis.seconds));
        format!("{found}{rest} {seconds}")
    }
}

/// Diagnoses one file; `show` hears of progress.
pub fn one(file: &Path, setup: &Setup, show: impl FnMut(f64, &Message)) -> Result<Report, Message> {
    let arguments = setup.arguments;
    let options = ImportOptions {
        kind: arguments.kind.map(Into::into),
        mapping: arguments
            .map
            .as_ref()
            .map_or_else(Mapping::default, |m| m.value.clone()),
        torque_constant: arguments.torque_constant.as_ref().map(|c| c.value),
        period: arguments.period.as_ref().map(|p| p.value),
    };
    let (measurement, bytes) = read(file, &options)?;
    of(&measurement, (file, &bytes), setup, show)
}

/// Diagnoses a measurement; `source` is the file that it came from and its bytes.
pub fn of(
    measurement: &Measurement,
    source: (&Path, &[u8]),
    setup: &Setup,
    mut show: impl FnMut(f64, &Message),
) -> Result<Report, Message> {
    let arguments = setup.arguments;
    let started = Instant::now();
    let name = measurement.name.clone();
    let blank = || UserModel::blank(measurement.kind);
    let mut given = setup.model.clone().unwrap_or_else(blank);
    for effect in &arguments.effect {
        given
            .add_candidate(effect)
            .map_err(|e| msg!("--effect: {}", e))?;
    }
    let mut limits = Limits::of(measurement);
    limits
        .set(arguments.limits.as_deref().unwrap_or_default())
        .map_err(|e| msg!("--limits: {}", e))?;
    let mut job = DiagnosisJob::with_model(measurement, &given)
        .map_err(|e| msg!("{}: {}", Message::name(name.clone()), e))?
        .within(limits)
        .with_crew(&cores::all());
    loop {
        match job.advance() {
            Progress::Running { fraction, text } => show(fraction, &text),
            Progress::Done(mut diagnosis) => {
                for step in &diagnosis.steps {
                    step.checked()
                        .map_err(|e| msg!("{}: {}", Message::name(name.clone()), e))?;
                }
                let discovery = if arguments.discover {
                    Some(discover(
                        measurement,
                        &diagnosis,
                        &given,
                        limits,
                        &mut show,
                    )?)
                } else {
                    None
                };
                diagnosis.seconds = started.elapsed().as_secs_f64();
                let page = arguments.report.as_ref().and_then(|_| {
                    let (first, last) = job.evidence()?;
                    Some(report::html(&ReportInput {
                        measurement,
                        steps: &diagnosis.steps,
                        first_atlas: &first.atlas,
                        last,
                        verdict: Some(&diagnosis.verdict),
                        discovery: discovery.as_ref(),
                        model: (given != blank()).then_some(&given),
                        provenance: &provenance(source.0, arguments, source.1),
                        tongue: Tongue {
                            code: spoken().code(),
                            say: |text| say(text),
                        },
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
                    discovery,
                    page,
                    model,
                });
            }
        }
    }
}

/// Looks for a formula beside the effects that were found, or in their place where they explain the record.
fn discover(
    measurement: &Measurement,
    diagnosis: &Diagnosis,
    given: &UserModel,
    limits: Limits,
    show: &mut impl FnMut(f64, &Message),
) -> Result<Discovery, Message> {
    let last = diagnosis.steps.last().filter(|_| diagnosis.verdict.unknown);
    let found: Vec<EffectId> = last.map_or_else(Vec::new, |step| {
        let effects = step.effects.iter().copied();
        effects.filter(|id| *id != VISCOUS_FRICTION).collect()
    });
    let mut job = DiscoveryJob::new(measurement, &found, given)
        .map_err(|e| format!("{}: {e}", measurement.name))?
        .within(limits)
        .with_crew(&cores::all());
    loop {
        match job.advance() {
            Progress::Running { fraction, text } => show(fraction, &text),
            Progress::Done(discovery) => return Ok(discovery),
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
        (
            "--period",
            arguments.period.as_ref().map(|m| m.text.as_str()),
        ),
        ("--limits", arguments.limits.as_deref()),
    ];
    for (option, value) in options {
        if let Some(value) = value {
            command.extend([" ", option, " ", &report::shell_word(value)]);
        }
    }
    if arguments.discover {
        command.push_str(" --discover");
    }
    if spoken() != Language::default() {
        command.extend([" --lang ", spoken().code()]);
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
