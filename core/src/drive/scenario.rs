//! A drive in a file: drive, relay and run as TOML.
//!
//! ```toml
//! [drive]
//! motor = { inertia = 8.8e-4, viscous = 2e-3, coulomb = 0.03 }  # kg m^2, N m s/rad, N m
//! load = { inertia = 8.8e-4, coulomb = 0.01 }                   # friction is 0 if left out
//! half_gap = 0.0095                                             # beta, rad
//! contact = { rigid = { restitution = 1.0 } }                   # so if left out
//! # or: contact = { compliant = { stiffness = 1500.0, damping = 0.2 } }
//! # adhesion = { upper = 0.02, lower = 0.0 }                    # N m; none if left out
//! [relay]                                                       # on the motor's velocity
//! gain = 0.5                                                    # N m
//! hysteresis = 0.5                                              # rad/s
//! asymmetry = 0.15                                              # 0 if left out, as are bias and delay (s)
//! flip = 3.0                                                    # s; never if left out
//! sampling = 2e-4                                               # s; none if left out
//! [run]
//! duration = 12.0                                               # s
//! step = 2e-4                                                   # s; a two-thousandth of the duration if left out
//! start = { x1 = 0.0, v1 = 0.0, x2 = 0.0, v2 = 0.0 }            # at rest in the middle if left out
//! ```

use serde::Deserialize;

use super::{Command, Drive, DriveError, DriveInput, MAX_EVENTS, Start, VelocityRelay};
use crate::relay::Relay;

/// The file as it stands.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct DriveFile {
    drive: Drive,
    relay: RelayTable,
    #[serde(default)]
    run: RunTable,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RelayTable {
    gain: f64,
    #[serde(default)]
    hysteresis: f64,
    #[serde(default)]
    asymmetry: f64,
    #[serde(default)]
    bias: f64,
    #[serde(default)]
    delay: f64,
    flip: Option<f64>,
    sampling: Option<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, default)]
struct RunTable {
    duration: f64,
    step: Option<f64>,
    start: Start,
}

impl Default for RunTable {
    fn default() -> Self {
        Self {
            duration: 10.0,
            step: None,
            start: Start::default(),
        }
    }
}

/// Samples of a run whose step the file does not set.
const SAMPLES: f64 = 2000.0;

impl DriveFile {
    /// The run that the file describes, or the table that is wrong and why.
    pub fn input(self) -> Result<DriveInput, (&'static str, DriveError)> {
        let r = self.relay;
        let relay = VelocityRelay {
            relay: Relay {
                gain: r.gain,
                hysteresis: r.hysteresis,
                asymmetry: r.asymmetry,
                bias: r.bias,
                delay: r.delay,
            },
            flip: r.flip,
            sampling: r.sampling,
        };
        self.drive.validate().map_err(|e| ("[drive]", e))?;
        relay.validate().map_err(|e| ("[relay]", e))?;
        let input = DriveInput {
            drive: self.drive,
            command: Command::Relay(relay),
            start: self.run.start,
            duration: self.run.duration,
            step: Some(self.run.step.unwrap_or(self.run.duration / SAMPLES)),
            max_events: MAX_EVENTS,
        };
        input.validate().map_err(|e| ("[run]", e))?;
        Ok(input)
    }
}
