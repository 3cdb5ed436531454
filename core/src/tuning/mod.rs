//! How do I tune a controller from a relay experiment? Equations (4), (7), (8) and (9), and PID rules.
//!
//! | file | what |
//! |---|---|
//! | `experiment` | the relay test and its measurements |
//! | `ultimate` | (9): ultimate gain and period, and the true ones |
//! | `phase_margin` | (7): relay for a required phase margin |
//! | `adaptation` | (8): gain adaptation as an experiment |
//! | `moving_point` | (9): controller that moves `M` to `S` |
//! | `asymmetric_test` | a model from one asymmetric test |
//! | `rules` | the registry of tuning rules |
//! | `controller` | the PID controller and its forms |
//! | `closed_loop`, `margins` | the loop with the controller |
//! | `report` | all of it at once |
//! | [`measured`] | from a measured test instead of a simulated one |
//!
//! **Amplitude** is half of peak to peak everywhere.
//!
//! ```
//! use hysteron_core::tuning::{TuningInput, tune};
//! let report = tune(&TuningInput::default()).unwrap();
//! let tuned = report.after.unwrap();
//! assert!(tuned.margins.unwrap().max_sensitivity < 2.0);
//! ```

mod adaptation;
mod asymmetric_test;
mod closed_loop;
mod controller;
mod error;
mod experiment;
mod linear;
mod margins;
pub mod measured;
mod moving_point;
mod phase_margin;
mod report;
mod rules;
mod scan;
mod ultimate;

pub use adaptation::{Adaptation, AdaptationMethod, AdaptationStep, adapt, orders};
pub use asymmetric_test::{AsymmetricTest, Model, half_periods, identify, normalised_dead_time};
pub use closed_loop::{Disturbance, LoopReport, Response, close, respond};
pub use controller::{Parallel, Pid, Series};
pub use error::TuningError;
pub use experiment::{RelayTest, Run};
pub use margins::{Margins, margins, nyquist, unstable_poles};
pub use moving_point::{NyquistPoint, Target, pi as move_with_pi, pid as move_with_pid};
pub use phase_margin::RelayDesign;
pub use report::{
    PhaseMarginReport, PointReport, RuleReport, Step, TuningInput, TuningReport, tune,
};
pub use rules::{Identified, RULES, Rule, Wish, rule};
pub use ultimate::{
    AMPLITUDE_CONVENTION, Crossing, RelayGain, ShownPoint, StabilityLimits, Ultimate,
    UltimateReport, Without, compare, crossings, gain_on_real_axis, relay_gain, stability_limits,
    true_ultimate, ultimate_gain,
};
