//! What a report is made from.

use crate::diagnosis::{Discovery, Profile, Step, StepReport, Verdict};
use crate::measurement::Measurement;
use crate::message::Message;
use crate::user_model::UserModel;

/// Where a report comes from and how to make it again.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Provenance {
    /// Command line that gives the same diagnosis.
    pub command: String,
    /// Version of the program.
    pub version: String,
    /// Size of the file, bytes.
    pub bytes: usize,
    /// Its [`sha256`](super::sha256).
    pub sha256: String,
}

/// The language of a report: it is made in English, and each sentence, name and number is put into words by `say`.
#[derive(Clone, Copy, Debug)]
pub struct Tongue {
    /// Its code (ISO 639-1).
    pub code: &'static str,
    /// A text in it, by what it is in English.
    pub say: fn(&Message) -> String,
}

impl Tongue {
    /// What stands in the source.
    pub const ENGLISH: Self = Self {
        code: "en",
        say: Message::to_string,
    };
}

/// What a report is made from.
#[derive(Clone, Copy, Debug)]
pub struct ReportInput<'a> {
    /// The measurement.
    pub measurement: &'a Measurement,
    /// From the baseline to the model that is reported.
    pub steps: &'a [Step],
    /// The residual of the baseline over every axis; may be empty.
    pub first_atlas: &'a [Profile],
    /// The model that is reported, with its curves.
    pub last: &'a StepReport,
    /// What the data say, if they have been heard to the end.
    pub verdict: Option<&'a Verdict>,
    /// What a search for a formula of the rest found, if there was one.
    pub discovery: Option<&'a Discovery>,
    /// The model that the user brought, if any.
    pub model: Option<&'a UserModel>,
    /// Where it comes from.
    pub provenance: &'a Provenance,
    /// The language that it speaks.
    pub tongue: Tongue,
}

/// A word of a command line, quoted if a shell would take it apart.
pub fn shell_word(text: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./:+,%@".contains(c);
    if !text.is_empty() && text.chars().all(plain) {
        text.to_owned()
    } else {
        format!("'{}'", text.replace('\'', "'\\''"))
    }
}
