//! What does a measured relay test tell, and which gains follow from it?
//!
//! A record of input and output, or only what was read off it, or the log of a firmware's auto-tuner. The cycle shows
//! the plant at **one** frequency, and with hysteresis not where its phase is -180 degrees: amplitude `a` and
//! hysteresis `h` of a symmetric relay put it near `-180 + asin(h/a)`. The ultimate gain is therefore told only where
//! it follows, with its error, and else what would have to be done.
//!
//! | file | what |
//! |---|---|
//! | `record` | time, input and output, checked |
//! | `cycle` | switches, half periods, amplitude, hysteresis |
//! | `response` | exact responses of lags and integrators to a held input with dead time |
//! | `structure` | lags, integrators, a zero: what a model consists of |
//! | `least_squares` | linear least squares, residuals that hang together |
//! | `compared` | the record as the fits see it |
//! | `wander` | residuals that wander |
//! | `fit` | models by least squares on the whole record |
//! | `fourier` | the point of the Nyquist curve |
//! | `ultimate` | ultimate gain and period, where they follow |
//! | `gains` | rules, forms, margins achieved |
//! | `evidence` | causes, and what they are looked for in |
//! | `minimum_time` | whether a least time holds the relay |
//! | `ending` | why the input no longer changes at the end |
//! | `trouble` | why a test stalls or misleads |
//! | `readings` | from a few numbers, without a record |
//! | `family` | the plants whose cycle shows the same numbers |
//! | `log` | logs of firmwares |
//! | `opened` | what is in a file |
//! | `wishes` | what the user wants besides |
//! | `report` | all of it at once |
//!
//! **Amplitude** is half of peak to peak everywhere.

mod compared;
mod cycle;
mod ending;
mod evidence;
mod family;
mod fit;
mod fourier;
mod gains;
pub mod log;
mod minimum_time;
mod number;
mod opened;
mod readings;
mod record;
mod report;
mod response;
mod structure;
mod trouble;
mod ultimate;
mod wander;
mod wishes;

pub use cycle::Cycle;
pub use evidence::{Trouble, TroubleKind};
pub use fourier::Point;
pub use gains::{Form, TunedGains, alone, steps};
pub use opened::{OpenError, Opened, open};
pub use readings::{AmplitudeConvention, Readings, tune_readings};
pub use record::{Record, RecordError};
pub use report::{Conventional, MeasuredTuning, Settings, Summary, tune_record};
pub use structure::{FittedModel, Structure, Value};
pub use ultimate::MeasuredUltimate;
pub use wishes::Wishes;
