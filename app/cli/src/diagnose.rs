//! `hysteron diagnose FILE.csv`; many files are a batch.

use std::path::Path;
use std::process::ExitCode;

use hysteron_core::measurement::{ImportOptions, import};
use hysteron_core::message::Message;
use hysteron_core::msg;
use hysteron_core::user_model::UserModel;

use crate::arguments::Arguments;
use crate::batch;
use crate::one::{Setup, of, one};
use crate::output::{Format, finish};
use crate::progress_line::ProgressLine;
use crate::read::{bytes_of, shown};

/// One file by the contract of a single one; many files, or a file to resume from, as a batch.
pub fn run(arguments: &Arguments) -> ExitCode {
    let model = match arguments.model.as_deref().map(read_model).transpose() {
        Ok(model) => model,
        Err(line) => return finish(Err(line)),
    };
    let setup = Setup { arguments, model };
    match (arguments.files.as_slice(), &arguments.resume) {
        ([file], None) => finish(single(file, &setup)),
        _ if arguments.report.is_some() || arguments.save_model.is_some() => {
            finish(Err(
                "--report and --save-model write the result of one file: give one FILE, without --resume"
                    .into(),
            ))
        }
        _ => batch::run(&setup),
    }
}

fn read_model(path: &Path) -> Result<UserModel, Message> {
    let bytes = bytes_of(path)?;
    let text =
        str::from_utf8(&bytes).map_err(|_| msg!("{}: a model must be UTF-8 text", shown(path)))?;
    UserModel::from_toml(text).map_err(|e| msg!("{}, {}", shown(path), e))
}

/// The report, or one line that says what is wrong with the input.
fn single(file: &Path, setup: &Setup) -> Result<String, Message> {
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
            std::fs::write(path, text).map_err(|e| {
                msg!(
                    "{} cannot be written: {}",
                    Message::name(path.display().to_string()),
                    Message::name(e.to_string())
                )
            })?;
        }
    }
    match arguments.format {
        Format::Text => Ok(report.text(&report.name)),
        Format::Json => report.json().map_err(|e| {
            msg!(
                "{}: the diagnosis cannot be written as JSON: {}",
                Message::name(report.name.clone()),
                Message::name(e.to_string())
            )
        }),
    }
}

/// Diagnoses a measurement that is no file, for a person.
///
/// # Errors
/// One line that says what is wrong with it.
pub fn of_bytes(name: &str, bytes: &[u8]) -> Result<String, Message> {
    let measurement = import(name, bytes, &ImportOptions::default()).map_err(Message::from)?;
    let setup = Setup {
        arguments: &Arguments::of(name),
        model: None,
    };
    let mut line = ProgressLine::new();
    let source = (Path::new(name), bytes);
    let report = of(&measurement, source, &setup, |fraction, text| {
        line.show(fraction, text);
    });
    line.clear();
    report.map(|report| report.text(name))
}
