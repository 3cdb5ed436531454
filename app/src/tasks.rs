//! Long computations by name: what they need, what they do, what they say meanwhile. The same code runs
//! on a thread natively and in the worker on the web, which gets its tasks as JSON text.

use hysteron_core::backlash::{GapEstimate, estimate_gap};
use hysteron_core::criticism::{Progress, StepJob, StepReport};
use hysteron_core::drive::{DriveInput, Recorder, record};
use hysteron_core::effect::EffectId;
use hysteron_core::maps::{MapInput, MapJob, Tile};
use hysteron_core::measurement::{Measurement, import_csv};
use hysteron_core::tuning::{TuningInput, TuningReport, tune};
use hysteron_core::user_model::UserModel;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::pieces;

/// What a task says while it runs.
#[derive(Debug, Serialize, Deserialize)]
#[serde(tag = "type", content = "value", rename_all = "lowercase")]
pub enum News<R = StepReport> {
    /// Share done, 0 to 1, and what it is doing.
    Progress(f64, String),
    /// The result; a task may hand it over in parts.
    Report(Box<R>),
    /// Why there is none.
    Failed(String),
}

/// Where a task says its news; false when nobody listens any more and it should end.
pub type Say<'a, R> = &'a mut dyn FnMut(News<R>) -> bool;

/// A long computation.
pub trait Task: Serialize + DeserializeOwned + Send + 'static {
    /// Its name in messages.
    #[cfg_attr(
        not(target_arch = "wasm32"),
        expect(dead_code, reason = "a thread needs no messages")
    )]
    const NAME: &'static str;
    /// What it hands over.
    type Report: Serialize + DeserializeOwned + Send + 'static;
    /// Runs until it is finished or nobody listens.
    fn run(self, say: Say<'_, Self::Report>);
}

/// Criticises the baseline with effects on a measurement.
#[derive(Serialize, Deserialize)]
pub struct StepTask {
    /// The measurement.
    pub measurement: Box<Measurement>,
    /// Effects on top of the baseline.
    pub effects: Vec<EffectId>,
    /// What the user knows of the model.
    pub model: Option<UserModel>,
}

impl Task for StepTask {
    const NAME: &'static str = "step";
    type Report = StepReport;

    fn run(self, say: Say<'_, StepReport>) {
        let blank = UserModel::blank(self.measurement.kind);
        let model = self.model.as_ref().unwrap_or(&blank);
        let mut job = match StepJob::with_model(&self.measurement, &self.effects, model) {
            Ok(job) => job,
            Err(error) => {
                say(News::Failed(error.to_string()));
                return;
            }
        };
        loop {
            match job.advance_with(pieces::width(), &mut pieces::run) {
                Progress::Running { fraction, text } => {
                    if !say(News::Progress(fraction, text)) {
                        return;
                    }
                }
                Progress::Done(report) => {
                    say(News::Report(Box::new(report)));
                    return;
                }
            }
        }
    }
}

/// Computes a parameter map, handed over tile by tile.
#[derive(Serialize, Deserialize)]
pub struct MapTask(pub MapInput);

impl Task for MapTask {
    const NAME: &'static str = "map";
    type Report = Tile;

    fn run(self, say: Say<'_, Tile>) {
        let mut job = match MapJob::new(self.0) {
            Ok(job) => job,
            Err(error) => {
                say(News::Failed(error.to_string()));
                return;
            }
        };
        loop {
            let tile = advance(&mut job);
            if tile.is_empty() || !say(News::Report(Box::new(tile))) {
                return;
            }
        }
    }
}

/// Runs the auto-tuning experiments.
#[derive(Serialize, Deserialize)]
pub struct TuneTask(pub TuningInput);

impl Task for TuneTask {
    const NAME: &'static str = "tune";
    type Report = TuningReport;

    fn run(self, say: Say<'_, TuningReport>) {
        say(match tune(&self.0) {
            Ok(report) => News::Report(Box::new(report)),
            Err(error) => News::Failed(error.to_string()),
        });
    }
}

/// Estimates a gap from the motor's columns alone.
#[derive(Serialize, Deserialize)]
pub enum GapTask {
    /// Of a simulated drive, recorded as a rig would.
    Simulated(Box<DriveInput>),
    /// Of a file: its name and its text.
    File(String, String),
}

/// What the motor tells about the gap.
#[derive(Serialize, Deserialize)]
pub struct GapReport {
    /// What was read, where a file was.
    pub measurement: Option<Measurement>,
    /// The estimate, or why there can be none.
    pub estimate: Result<GapEstimate, String>,
}

impl Task for GapTask {
    const NAME: &'static str = "gap";
    type Report = GapReport;

    fn run(self, say: Say<'_, GapReport>) {
        let (read, keep) = match self {
            Self::Simulated(input) => (
                record(&input, &Recorder::default()).map_err(|e| e.to_string()),
                false,
            ),
            Self::File(name, text) => (
                import_csv(&name, text.as_bytes(), None).map_err(|e| e.to_string()),
                true,
            ),
        };
        say(match read {
            Ok(measurement) => News::Report(Box::new(GapReport {
                estimate: estimate_gap(&measurement).map_err(|e| e.to_string()),
                measurement: keep.then_some(measurement),
            })),
            Err(error) => News::Failed(error),
        });
    }
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

/// What the worker says first, when it listens.
#[cfg(target_arch = "wasm32")]
pub const READY: &str = "ready";
