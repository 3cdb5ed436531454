//! What long computations do. The same code runs on a thread natively and in a worker on the web.

use std::borrow::Cow;

use hysteron_core::backlash::estimate_gap;
use hysteron_core::by_hand::{ByHand, HandReplay};
use hysteron_core::crew::Crew;
use hysteron_core::criticism::{DiscoveryJob, ExperimentJob, StepJob};
use hysteron_core::diagnosis::{Discovery, NextExperiment, StepReport};
use hysteron_core::drive::{Recorder, record};
use hysteron_core::maps::{MapJob, Tile};
use hysteron_core::measurement::{ImportError, Measurement, Problem, columns, import};
use hysteron_core::message::Message;
use hysteron_core::msg;
use hysteron_core::mystery::{Reveal, make, seal_of};
use hysteron_core::progress::Progress;
use hysteron_core::report::sha256;
use hysteron_core::tuning::{TuningReport, tune};
use hysteron_core::user_model::UserModel;

use crate::content::Content;
use crate::packed::unpack;
use crate::tasks::{
    DiscoveryTask, ExperimentTask, GapReport, GapTask, HandTask, Made, MapTask, MysteryTask, News,
    Opened, ReadReport, ReadTask, RevealTask, Source, StepTask, Task, TuneTask, Unclear,
};

/// Where a task says its news; false when nobody listens any more and it should end.
pub type Say<'a, R> = &'a mut dyn FnMut(News<R>) -> bool;

/// A task that can be carried out here.
pub trait Work: Task {
    /// Runs until it is finished or nobody listens.
    fn run(self, say: Say<'_, Self::Report>);
}

impl Work for ReadTask {
    fn run(self, say: Say<'_, ReadReport>) {
        let bytes = bytes_of(&self.content);
        let report = match self.read(&bytes) {
            Ok(measurement) => Ok(ReadReport::Measurement(Box::new(Opened {
                measurement,
                source: Source {
                    bytes: bytes.len(),
                    sha256: sha256(&bytes),
                },
                seal: seal_of(&bytes),
            }))),
            Err(refused) => refused
                .about_columns()
                .and_then(|error| unclear(&self.file, &bytes, error))
                .map(ReadReport::Unclear)
                .ok_or(refused),
        };
        say(match report {
            Ok(report) => News::Report(Box::new(report)),
            Err(refused) => News::Failed(refused.message()),
        });
    }
}

/// The bytes of a file.
pub(crate) fn bytes_of(content: &Content) -> Cow<'_, [u8]> {
    match content {
        Content::Plain(bytes) => Cow::Borrowed(bytes),
        Content::Packed(bytes) => Cow::Owned(unpack(bytes).unwrap_or_default()),
        Content::Mystery(mystery) => Cow::Owned(mystery.csv().into_bytes()),
    }
}

/// Columns that a measurement has at least: input and output, and a period if no column has the times.
const FEWEST: usize = 2;

/// What is asked of a file that was refused for its columns, if that can help.
pub(crate) fn unclear(file: &str, bytes: &[u8], error: &ImportError) -> Option<Unclear> {
    if !error.problem.is_about_columns() {
        return None;
    }
    let columns = columns(file, bytes).ok()?;
    let reason = match error.problem {
        // What the command line says goes on about options.
        Problem::NotMapped { .. } => "A MATLAB file does not say what its columns are.".into(),
        _ => ImportError {
            advice: None,
            ..error.clone()
        }
        .message(),
    };
    (columns.len() >= FEWEST).then_some(Unclear { reason, columns })
}

/// Why a file is not read.
enum Refused {
    /// How it was to be read makes no sense.
    Reading(Message),
    File(ImportError),
}

impl Refused {
    /// What is wrong where someone who knows the columns of the file could have it read.
    fn about_columns(&self) -> Option<&ImportError> {
        match self {
            Self::File(error) if error.problem.is_about_columns() => Some(error),
            _ => None,
        }
    }
}

impl Refused {
    fn message(&self) -> Message {
        match self {
            Self::Reading(error) => error.clone(),
            Self::File(error) => error.message(),
        }
    }
}

impl ReadTask {
    fn read(&self, bytes: &[u8]) -> Result<Measurement, Refused> {
        let options = self.reading.options().map_err(Refused::Reading)?;
        // What the command line would say goes on about options.
        import(&self.file, bytes, &options).map_err(|error| {
            Refused::File(ImportError {
                advice: None,
                ..error
            })
        })
    }

    /// A measurement of which a gap is to be estimated.
    fn measured(&self) -> Result<Measurement, Message> {
        self.read(&bytes_of(&self.content)).map_err(|refused| {
            if refused.about_columns().is_some() {
                msg!(
                    "{}. Open it in Compare, which asks for its columns; then it can be opened here too.",
                    refused.message()
                )
            } else {
                refused.message()
            }
        })
    }
}

impl Work for StepTask {
    fn run(self, say: Say<'_, StepReport>) {
        let blank = UserModel::blank(self.measurement.kind);
        let model = self.model.as_ref().unwrap_or(&blank);
        let job = StepJob::with_model(&self.measurement, &self.effects, model);
        let Some(job) = begun(job, say) else { return };
        let mut job = job.with_crew(&crew());
        if let Some(report) = finish(|| job.advance(), say) {
            let wrong = report.step.checked().err();
            say(match wrong {
                Some(error) => News::Failed(error.into()),
                None => News::Report(Box::new(report)),
            });
        }
    }
}

impl Work for DiscoveryTask {
    fn run(self, say: Say<'_, Discovery>) {
        let blank = UserModel::blank(self.measurement.kind);
        let model = self.model.as_ref().unwrap_or(&blank);
        let job = DiscoveryJob::new(&self.measurement, &self.effects, model);
        let Some(job) = begun(job, say) else { return };
        let mut job = job.with_crew(&crew());
        if let Some(discovery) = finish(|| job.advance(), say) {
            say(News::Report(Box::new(discovery)));
        }
    }
}

impl Work for HandTask {
    fn run(self, say: Say<'_, HandReplay>) {
        let all = (0, self.measurement.len());
        let hand = ByHand::new(&self.measurement, &self.report, all);
        say(match hand {
            Some(hand) => News::Report(Box::new(hand.settled(&self.values))),
            None => News::Failed("The values of this model cannot be set by hand.".into()),
        });
    }
}

impl Work for ExperimentTask {
    fn run(self, say: Say<'_, NextExperiment>) {
        let blank = UserModel::blank(self.measurement.kind);
        let model = self.model.as_ref().unwrap_or(&blank);
        let job = ExperimentJob::new(
            &self.measurement,
            model,
            &self.models,
            self.limits,
            self.today,
        );
        let Some(mut job) = begun(job, say) else {
            return;
        };
        match finish(|| job.advance(), say) {
            Some(Some(found)) => say(News::Report(Box::new(found))),
            Some(None) => say(News::Failed(NO_ROOM.into())),
            None => false,
        };
    }
}

/// What is said where nothing can be tried.
const NO_ROOM: &str =
    "These limits leave no room for an experiment: allow a longer record or more motion.";

/// A job; where there is none, why is said.
fn begun<J, E: Into<Message>, R>(job: Result<J, E>, say: Say<'_, R>) -> Option<J> {
    job.map_err(|error| say(News::Failed(error.into()))).ok()
}

/// Advances a job to its end; `None` where nobody listens any more.
fn finish<T, R>(mut advance: impl FnMut() -> Progress<T>, say: Say<'_, R>) -> Option<T> {
    loop {
        match advance() {
            Progress::Running { fraction, text } => {
                if !say(News::Progress(fraction, text)) {
                    return None;
                }
            }
            Progress::Done(result) => return Some(result),
        }
    }
}

impl Work for MapTask {
    fn run(self, say: Say<'_, Tile>) {
        let Some(mut job) = begun(MapJob::new(self.0), say) else {
            return;
        };
        loop {
            let tile = advance(&mut job);
            if tile.is_empty() || !say(News::Report(Box::new(tile))) {
                return;
            }
        }
    }
}

impl Work for TuneTask {
    fn run(self, say: Say<'_, TuningReport>) {
        say(match tune(&self.0) {
            Ok(report) => News::Report(Box::new(report)),
            Err(error) => News::Failed(error.into()),
        });
    }
}

impl Work for GapTask {
    fn run(self, say: Say<'_, GapReport>) {
        let (read, keep) = match self {
            Self::Simulated(input) => (
                record(&input, &Recorder::default()).map_err(Message::from),
                false,
            ),
            Self::Measured(task) => (task.measured(), true),
        };
        say(match read {
            Ok(measurement) => News::Report(Box::new(GapReport {
                estimate: estimate_gap(&measurement).map_err(Message::from),
                measurement: keep.then_some(measurement),
            })),
            Err(error) => News::Failed(error),
        });
    }
}

impl Work for MysteryTask {
    fn run(self, say: Say<'_, Made>) {
        say(match make(&self.0) {
            Ok(mystery) => News::Report(Box::new(Made {
                link: mystery.link(),
                mystery,
            })),
            Err(error) => News::Failed(error.into()),
        });
    }
}

impl Work for RevealTask {
    fn run(self, say: Say<'_, Reveal>) {
        say(match Reveal::open(&self.seal, &self.word, &self.answer) {
            Ok(reveal) => News::Report(Box::new(reveal)),
            Err(error) => News::Failed(error.into()),
        });
    }
}

/// Who does the parts of a computation: all cores.
#[cfg(not(target_arch = "wasm32"))]
fn crew() -> Crew {
    crate::cores::all()
}

/// The worker alone.
#[cfg(target_arch = "wasm32")]
fn crew() -> Crew {
    Crew::default()
}

/// One batch on all cores.
#[cfg(not(target_arch = "wasm32"))]
fn advance(job: &mut MapJob) -> Tile {
    use rayon::prelude::*;
    let outcomes = job
        .batch()
        .par_iter()
        .map(|place| job.outcome(*place))
        .collect();
    job.accept(outcomes)
}

#[cfg(target_arch = "wasm32")]
fn advance(job: &mut MapJob) -> Tile {
    job.advance()
}
