//! What is in a file: a record of a test, or the log of an auto-tuner.

use super::log::{self, Held, Log, LogError};
use super::record::Record;
use super::report::{MeasuredTuning, tune_record};
use super::wishes::Wishes;
use crate::measurement::{ImportError, ImportOptions, Kind, import};
use crate::message::{Message, says};

/// What was read.
#[derive(Clone, Debug)]
pub enum Opened {
    /// The log of an auto-tuner.
    Log(Box<Log>),
    /// A record, and what is to be said of how it was read.
    Record(Box<Record>, Vec<Message>),
}

/// Why nothing was read.
#[derive(Clone, Debug)]
pub enum OpenError {
    /// A log that is not as it should be.
    Log(LogError),
    /// A table that is not as it should be.
    Import(ImportError),
}

impl OpenError {
    /// In words.
    pub fn message(&self) -> Message {
        match self {
            Self::Log(error) => error.message(),
            Self::Import(error) => error.message(),
        }
    }
}

says!(OpenError);

/// Reads a file. It may be a log where nothing is said about its columns.
///
/// # Errors
/// One sentence about the log or the table.
pub fn open(name: &str, bytes: &[u8], options: &ImportOptions) -> Result<Opened, OpenError> {
    let logged = (*options == ImportOptions::default())
        .then(|| log::read(name, &String::from_utf8_lossy(bytes)))
        .flatten();
    if let Some(log) = logged {
        return log
            .map(|log| Opened::Log(Box::new(log)))
            .map_err(OpenError::Log);
    }
    // A process, unless the user says otherwise; a drive is a plant as well.
    let process = ImportOptions {
        kind: options
            .kind
            .or_else(|| options.mapping.is_empty().then_some(Kind::Process)),
        ..options.clone()
    };
    let measurement = import(name, bytes, &process)
        .or_else(|error| import(name, bytes, options).map_err(|_| error))
        .map_err(OpenError::Import)?;
    let notes = measurement.warnings.clone();
    Ok(Opened::Record(Box::new(Record::of(&measurement)), notes))
}

impl Opened {
    /// The record, where there is one.
    pub fn record(&self) -> Option<&Record> {
        match self {
            Self::Record(record, _) => Some(record),
            Self::Log(log) => match &log.held {
                Held::Record(record) => Some(record),
                Held::Readings(_) => None,
            },
        }
    }

    /// What it tells.
    ///
    /// # Errors
    /// A record or numbers that cannot be used.
    pub fn tune(self, wishes: &Wishes) -> Result<MeasuredTuning, LogError> {
        match self {
            Self::Log(log) => log.with(wishes)?.tune(wishes.form),
            Self::Record(..) if wishes.levels.is_some() => Err(LogError::Levels),
            Self::Record(record, notes) => Ok(tune_record(&record, &wishes.settings(notes))?),
        }
    }
}
