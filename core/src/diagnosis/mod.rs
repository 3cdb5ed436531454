//! What a diagnosis says: plain values, the same in JSON, on the command line and on screen.
//!
//! Nothing is fitted or simulated here: the jobs of [`criticism`](crate::criticism) fill these values, everything else
//! reads them.

mod answer;
mod discovery;
mod error;
mod experiment;
mod fingerprint;
mod limits;
mod missing;
mod noise;
mod parameter;
mod profile;
mod program;
mod relay_loop;
mod replay;
mod report;
mod residual_test;
mod screening;
mod step;
mod verdict;

pub use answer::Reach;
pub use discovery::{Discovery, DiscoveryEnd, FoundFormula};
pub use error::CriticismError;
pub use experiment::{FittedModel, NextExperiment, Trial};
pub use fingerprint::Fingerprint;
pub use limits::{LimitError, Limits};
pub use missing::MissingPart;
pub use noise::ChannelNoise;
pub use parameter::{Parameter, Status};
pub use profile::{Profile, ProfileBin};
pub use program::{Program, Sine};
pub use relay_loop::LoopError;
pub use replay::{Replay, ReplayChannel};
pub(crate) use report::NOISE_FLOOR;
pub use report::{Diagnosis, StepReport};
pub use residual_test::{ResidualTest, ResidualTestKind};
pub use screening::{InputCheck, InputVerdict, Screening, Subset};
pub use step::{Candidate, Finding, Step};
pub use verdict::{Contradiction, Overruled, Verdict};

pub(crate) use experiment::{LEAST, times};
pub(crate) use program::short;
