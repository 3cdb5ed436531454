//! Long computations by name: what they need, and what they say meanwhile. What they do is in `work.rs`: on
//! the web it is the worker that does it.

use hysteron_core::backlash::GapEstimate;
use hysteron_core::by_hand::HandReplay;
use hysteron_core::diagnosis::{Discovery, FittedModel, Limits, NextExperiment, StepReport};
use hysteron_core::drive::DriveInput;
use hysteron_core::effect::EffectId;
use hysteron_core::explore::{ExploreData, ExploreInput};
use hysteron_core::figures::Check;
use hysteron_core::hunting::{HuntingData, Servo};
use hysteron_core::maps::{MapInput, Tile};
use hysteron_core::measurement::{FoundColumn, Measurement};
use hysteron_core::message::Message;
use hysteron_core::mystery::{Answer, Mystery, Request, Reveal};
use hysteron_core::on_off::{OnOffData, OnOffInput};
use hysteron_core::tuning::measured::{MeasuredTuning, Readings, Record, Wishes};
use hysteron_core::tuning::{Response, TuningInput, TuningReport};
use hysteron_core::user_model::UserModel;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::content::Content;
use crate::reading::Reading;

/// What a task says while it runs.
#[derive(Debug, Serialize, Deserialize)]
#[serde(tag = "type", content = "value", rename_all = "lowercase")]
pub enum News<R = StepReport> {
    /// Share done, 0 to 1, and what it is doing.
    Progress(f64, Message),
    /// The result; a task may hand it over in parts.
    Report(Box<R>),
    /// Why there is none.
    Failed(Message),
}

/// A long computation.
pub trait Task: Serialize + DeserializeOwned + Send + 'static {
    /// Its name in messages.
    const NAME: &'static str;
    /// What it hands over.
    type Report: Serialize + DeserializeOwned + Send + 'static;
}

/// Reads a measurement.
#[derive(Serialize, Deserialize)]
pub struct ReadTask {
    /// Name of the file.
    pub file: String,
    /// What is in it.
    pub content: Content,
    /// What it does not say itself.
    pub reading: Reading,
}

/// What was read.
#[derive(Serialize, Deserialize)]
pub enum ReadReport {
    /// A measurement.
    Measurement(Box<Opened>),
    /// A table that does not say what its columns are.
    Unclear(Unclear),
}

/// What is asked of a table that does not say what its columns are.
#[derive(Serialize, Deserialize)]
pub struct Unclear {
    /// What is not understood.
    pub reason: Message,
    /// What there is.
    pub columns: Vec<FoundColumn>,
}

/// A measurement, and what else is known of its file.
#[derive(Serialize, Deserialize)]
pub struct Opened {
    /// What was measured.
    pub measurement: Measurement,
    /// Where it comes from.
    pub source: Source,
    /// The truth about it, sealed, if it is a mystery.
    pub seal: Option<Vec<u8>>,
}

/// The very file that was read.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Source {
    /// Its length.
    pub bytes: usize,
    /// Its fingerprint.
    pub sha256: String,
}

impl Task for ReadTask {
    const NAME: &'static str = "read";
    type Report = ReadReport;
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
}

/// Looks for a formula of what a model leaves.
#[derive(Serialize, Deserialize)]
pub struct DiscoveryTask {
    /// The measurement.
    pub measurement: Box<Measurement>,
    /// Effects on top of the baseline.
    pub effects: Vec<EffectId>,
    /// What the user knows of the model.
    pub model: Option<UserModel>,
}

impl Task for DiscoveryTask {
    const NAME: &'static str = "discovery";
    type Report = Discovery;
}

/// Replays a fitted model with values that are set by hand.
#[derive(Serialize, Deserialize)]
pub struct HandTask {
    /// The measurement.
    pub measurement: Box<Measurement>,
    /// The fit.
    pub report: Box<StepReport>,
    /// The values, in the order of its parameters.
    pub values: Vec<f64>,
}

impl Task for HandTask {
    const NAME: &'static str = "hand";
    type Report = HandReplay;
}

/// Looks for the experiment that tells models apart, within limits.
#[derive(Serialize, Deserialize)]
pub struct ExperimentTask {
    /// The measurement.
    pub measurement: Box<Measurement>,
    /// What the user knows of the model.
    pub model: Option<UserModel>,
    /// The models, fitted.
    pub models: Vec<FittedModel>,
    /// How far the experiment may go.
    pub limits: Limits,
    /// What the others leave in this record beyond the first, in noise units.
    pub today: f64,
}

impl Task for ExperimentTask {
    const NAME: &'static str = "experiment";
    type Report = NextExperiment;
}

/// Computes a parameter map, handed over tile by tile.
#[derive(Serialize, Deserialize)]
pub struct MapTask(pub MapInput);

impl Task for MapTask {
    const NAME: &'static str = "map";
    type Report = Tile;
}

/// Runs the auto-tuning experiments.
#[derive(Serialize, Deserialize)]
pub struct TuneTask(pub TuningInput);

impl Task for TuneTask {
    const NAME: &'static str = "tune";
    type Report = TuningReport;
}

/// Follows a loop with an on-off controller as it is built.
#[derive(Serialize, Deserialize)]
pub struct OnOffTask(pub OnOffInput);

impl Task for OnOffTask {
    const NAME: &'static str = "on-off";
    type Report = OnOffData;
}

/// Computes a relay loop and, where it is one of the paper's figures, checks its claim.
#[derive(Clone, PartialEq, Serialize, Deserialize)]
pub struct LoopTask {
    /// The loop.
    pub input: ExploreInput,
    /// Number of the figure.
    pub figure: Option<u32>,
}

impl Task for LoopTask {
    const NAME: &'static str = "loop";
    type Report = (ExploreData, Vec<Check>);
}

/// Follows a drive with a controller of its position.
#[derive(Serialize, Deserialize)]
pub struct ServoTask(pub Servo);

impl Task for ServoTask {
    const NAME: &'static str = "servo";
    type Report = HuntingData;
}

/// Reads a scenario.
#[derive(Serialize, Deserialize)]
pub struct ScenarioTask(pub String);

/// What is in a scenario.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum ScenarioReport {
    /// A relay with two levels around a plant.
    Loop(Box<ExploreInput>),
    /// An on-off controller as it is built.
    OnOff(Box<OnOffInput>),
    /// A drive with a controller of its position.
    Servo(Box<Servo>),
    /// A drive with a hidden gap under a relay.
    Drive(Box<DriveInput>),
}

/// A scenario as it was read.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ReadScenario {
    /// What is in it.
    pub report: ScenarioReport,
    /// What its table `[run]` sets and a page that shows the cycle does not.
    pub left_out: Vec<String>,
}

impl Task for ScenarioTask {
    const NAME: &'static str = "scenario";
    type Report = ReadScenario;
}

/// Tells what a measured relay test tells.
#[derive(Serialize, Deserialize)]
pub struct MeasuredTask {
    /// What there is of it.
    pub test: MeasuredTest,
    /// What the user wants besides.
    pub wishes: Wishes,
}

/// What there is of a relay test that was measured.
#[derive(Serialize, Deserialize)]
pub enum MeasuredTest {
    /// A record, or the log of an auto-tuner.
    File(Box<ReadTask>),
    /// What was read off it.
    Readings(Readings),
}

/// What a measured relay test tells, and what is drawn of it.
#[derive(Serialize, Deserialize)]
pub struct MeasuredReport {
    /// All that it tells.
    pub tuning: MeasuredTuning,
    /// The record, or some of its samples where there are very many.
    pub record: Option<Record>,
    /// Nyquist curve of the preferred model, real and imaginary parts.
    pub nyquist: Vec<[f64; 2]>,
    /// With each of the gains: what a step of the set point and one of the load do to the model.
    pub loops: Vec<Option<[Response; 2]>>,
    /// What the load does where no controller answers.
    pub alone: Option<Response>,
}

/// What was read of a relay test that was measured.
#[derive(Serialize, Deserialize)]
pub enum ReadTest {
    /// What it tells.
    Told(Box<MeasuredReport>),
    /// A table that does not say what its columns are.
    Unclear(Unclear),
}

impl Task for MeasuredTask {
    const NAME: &'static str = "measured";
    type Report = ReadTest;
}

/// Estimates a gap from the motor's columns alone.
#[derive(Serialize, Deserialize)]
pub enum GapTask {
    /// Of a simulated drive, recorded as a rig would.
    Simulated(Box<DriveInput>),
    /// Of a measurement that is to be read.
    Measured(Box<ReadTask>),
}

/// What the motor tells about the gap.
#[derive(Serialize, Deserialize)]
pub struct GapReport {
    /// What was read, where a file was.
    pub measurement: Option<Measurement>,
    /// The estimate, or why there can be none.
    pub estimate: Result<GapEstimate, Message>,
}

impl Task for GapTask {
    const NAME: &'static str = "gap";
    type Report = GapReport;
}

/// Makes a mystery on the bench.
#[derive(Serialize, Deserialize)]
pub struct MysteryTask(pub Request);

/// A mystery that was made.
#[derive(Serialize, Deserialize)]
pub struct Made {
    /// The record, with the truth sealed.
    pub mystery: Mystery,
    /// The same as a text for a link.
    pub link: String,
}

impl Task for MysteryTask {
    const NAME: &'static str = "mystery";
    type Report = Made;
}

/// Opens the sealed truth and judges a model by it.
#[derive(Serialize, Deserialize)]
pub struct RevealTask {
    /// The truth, sealed.
    pub seal: Vec<u8>,
    /// The word that opens it.
    pub word: String,
    /// The model.
    pub answer: Answer,
}

impl Task for RevealTask {
    const NAME: &'static str = "reveal";
    type Report = Reveal;
}

/// What the worker says whenever it listens: first, and after each task.
#[cfg(target_arch = "wasm32")]
pub const READY: &str = "ready";
