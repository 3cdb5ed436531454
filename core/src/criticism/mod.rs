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
mod jobs;
mod knowledge;
mod locate;
mod missing;
mod next_experiment;
mod noise;
mod odd_windows;
mod one_way;
mod output;
mod probes;
mod record;
mod residual_test;
mod score;
mod screen;
mod select;
mod session;
mod sight;
mod spectrum;
mod split;
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


