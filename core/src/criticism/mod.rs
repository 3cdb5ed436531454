//! Where does the model fail, which effect is missing, how much, how sure?

mod atlas;
mod axes;
mod before;
mod correlation;
mod cost;
mod cut;
mod data;

mod explain;
mod fingerprint;
mod fit;
mod guess;
mod job;
mod jobs;
mod judge;
mod knowledge;
mod leap;
mod locate;
mod missing;
mod next_experiment;
mod noise;
mod odd_windows;
mod one_way;
mod output;
mod probes;
mod race;
mod record;
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
mod tell;
mod units;
mod verdict;
mod window;
mod window_sums;

pub use jobs::{DiagnosisJob, StepJob};
pub use next_experiment::{Controller, ExperimentJob};
pub use noise::noise_level;
pub use screen::screen;


