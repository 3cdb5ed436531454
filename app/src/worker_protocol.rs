//! What the page and its worker say to each other: JSON text by `postMessage`.

use hysteron_core::criticism::StepReport;
use hysteron_core::effect::EffectId;
use hysteron_core::measurement::Measurement;
use serde::{Deserialize, Serialize};

/// From the page to the worker. To cancel, the page ends the worker and makes a new one.
#[derive(Serialize, Deserialize)]
#[serde(tag = "type", rename_all = "lowercase")]
pub enum Request {
    /// Criticise the baseline with these effects on this measurement.
    Step {
        /// The measurement.
        measurement: Box<Measurement>,
        /// Effects on top of the baseline.
        effects: Vec<EffectId>,
    },
}

/// From the worker to the page.
#[derive(Serialize, Deserialize)]
#[serde(tag = "type", rename_all = "lowercase")]
pub enum Reply {
    /// The worker listens.
    Ready,
    /// How far it has come.
    Progress {
        /// Share done, 0 to 1.
        fraction: f64,
        /// What it is doing.
        text: String,
    },
    /// Finished.
    Report {
        /// The result.
        report: Box<StepReport>,
    },
    /// It cannot be done.
    Error {
        /// One sentence.
        text: String,
    },
}
