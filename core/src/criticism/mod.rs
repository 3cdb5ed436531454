//! Where does the model fail, which effect is missing, how much, how sure?

mod atlas;
mod axes;
mod baseline;
mod before;
mod correlation;
mod cost;
mod cut;
mod data;
mod fingerprint;
mod fit;
mod glitches;
mod held;
mod job;
mod judge;
mod knowledge;
mod leap;
mod limited;
mod locate;
mod memory;
mod missing;
mod next_experiment;
mod noise;
mod odd_windows;
mod output;
mod probes;
mod pushes;
mod race;
mod report;
mod residual_test;
mod score;
mod screen;
mod search;
mod select;
mod session;
mod sight;
mod spectrum;
mod split;
mod step;
mod structure;
mod units;
mod verdict;
mod window;
mod window_sums;

pub use atlas::{Profile, ProfileBin};
pub use fingerprint::Fingerprint;
pub use job::{CriticismError, DiagnosisJob, Progress};
pub use knowledge::baseline_symbols;
pub use missing::MissingPart;
pub use next_experiment::{
    Controller, ExperimentJob, FittedModel, LimitError, Limits, NextExperiment, Opening, Program,
    Sine, Trial,
};
pub use noise::noise_level;
pub use report::{
    Candidate, Contradiction, Diagnosis, Finding, Parameter, Replay, ReplayChannel, Step,
    StepReport, Verdict,
};
pub use residual_test::{ResidualTest, ResidualTestKind};
pub use screen::screen;
pub use step::StepJob;
