//! A drive with a hidden gap: motor and load, joined by play, under a velocity relay.
//!
//! ```text
//! J1 dv1/dt = u - d1 v1 - c1 sgn(v1) - F      dx1/dt = v1
//! J2 dv2/dt = F - d2 v2 - c2 sgn(v2)          dx2/dt = v2
//! ```
//!
//! Between events the motion is affine, and its exact flow is summed as a Taylor series on steps short
//! enough for round-off; sticking, slipping and contact are modes with guards (see [`run`]). The force
//! `F` between the masses comes from one of two contact models ([`Contact`]).

mod cycle;
mod design;
mod engine;
mod error;
mod figures;
mod flow;
mod loop_theory;
mod modes;
mod play;
mod polynomial;
mod record;
mod relay;
mod scenario;
mod spring;
mod state;
mod structure;
mod summary;
mod trajectory;

use serde::{Deserialize, Serialize};

pub use cycle::{CyclePoint, DriftingCycle, Turn, drift_formula, drifting_cycle};
pub use design::{DriftingTest, RoughDrive, TRAVERSES, design_drifting_test};
pub use engine::{DriveJob, run};
pub use error::DriveError;
pub(crate) use error::check;
pub use figures::{DriveFigure, checks, drifting_test, figures, reference_drive};
pub use loop_theory::{LoopTheory, loop_theory};
pub use play::{PlayCycle, cycles_with_play, play_describing_function, relay_seen_through_play};
pub use record::{Recorder, record};
pub use relay::{Command, VelocityRelay};
pub(crate) use scenario::DriveFile;
pub use structure::{DriveMode, Instant};
pub use summary::{Direction, Engagement, FreeDrift, Summary, Traverse, engaged_drift, summarize};
pub use trajectory::{DriveRun, Energy, Event, EventKind, Mass, Side};

/// A mass with its friction.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Body {
    /// Inertia J, kg m^2 (or kg); above 0.
    pub inertia: f64,
    /// Viscous friction d, N m s/rad (or N s/m); at least 0.
    #[serde(default)]
    pub viscous: f64,
    /// Coulomb friction c, N m (or N); at least 0. A body at rest sticks until the force exceeds it.
    #[serde(default)]
    pub coulomb: f64,
}

/// What happens where motor and load touch.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase", deny_unknown_fields)]
pub enum Contact {
    /// Rigid play with an impact that conserves momentum, equations (10) and (11) of the paper: the
    /// velocities part with `restitution` times the speed of approach. Once they no longer bounce,
    /// both move as one mass until the force between them would have to pull.
    Rigid {
        /// 0 (they stay together) to 1 (the paper: no energy is lost).
        restitution: f64,
    },
    /// Dead zone with stiffness and damping that pushes and cannot pull (Nordin and Gutman 2002):
    /// `F = max(0, K q + D dq/dt)` for the depth `q = |x1 - x2| - beta > 0`.
    Compliant {
        /// Stiffness K, N m/rad (or N/m); above 0.
        stiffness: f64,
        /// Damping D, N m s/rad (or N s/m); at least 0.
        damping: f64,
    },
}

impl Default for Contact {
    /// As in the paper: rigid, without loss.
    fn default() -> Self {
        Self::Rigid { restitution: 1.0 }
    }
}

/// Pull that a contact withstands before it parts, N m (or N): the paper's adhesive side effect, which
/// makes the force on leaving contact differ from that on entering it, and the two sides from each other.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Adhesion {
    /// Where `x1 - x2 = +beta`; at least 0.
    pub upper: f64,
    /// Where `x1 - x2 = -beta`; at least 0.
    pub lower: f64,
}

/// Motor and load with play between them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Drive {
    /// The motor side, which is driven and measured.
    pub motor: Body,
    /// The load side.
    pub load: Body,
    /// Half gap beta, rad (or m); at least 0. The gap is `2 beta`.
    pub half_gap: f64,
    /// What happens at its ends.
    #[serde(default)]
    pub contact: Contact,
    /// Whether the ends hold on to each other.
    #[serde(default)]
    pub adhesion: Adhesion,
}

/// Where a run starts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Start {
    /// Motor position, rad (or m).
    pub x1: f64,
    /// Motor velocity, rad/s (or m/s).
    pub v1: f64,
    /// Load position; a rigid gap holds it within `beta` of the motor's.
    pub x2: f64,
    /// Load velocity.
    pub v2: f64,
}

/// Everything that a run depends on: the same value gives the same run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct DriveInput {
    /// The drive.
    pub drive: Drive,
    /// What drives it.
    pub command: Command,
    /// Where it starts.
    pub start: Start,
    /// How long, s; above 0.
    pub duration: f64,
    /// Distance of samples, s; `None` for events only.
    pub step: Option<f64>,
    /// Events after which the run is cut as chattering.
    pub max_events: usize,
}

/// Events after which a run is cut, unless the caller says otherwise; 12 s of a drifting drive have
/// some 30,000.
pub const MAX_EVENTS: usize = 500_000;

/// Samples that a run may have.
pub const MAX_SAMPLES: f64 = 10_000_000.0;

impl Drive {
    /// Checks every value.
    ///
    /// # Errors
    /// The first one out of its range.
    pub fn validate(&self) -> Result<(), DriveError> {
        for (body, names) in [
            (
                self.motor,
                ["motor inertia", "motor viscous", "motor coulomb"],
            ),
            (self.load, ["load inertia", "load viscous", "load coulomb"]),
        ] {
            check(names[0], body.inertia, body.inertia > 0.0, "above 0")?;
            check(names[1], body.viscous, body.viscous >= 0.0, "0 or more")?;
            check(names[2], body.coulomb, body.coulomb >= 0.0, "0 or more")?;
        }
        check("half gap", self.half_gap, self.half_gap >= 0.0, "0 or more")?;
        match self.contact {
            Contact::Rigid { restitution: e } => {
                check("restitution", e, (0.0..=1.0).contains(&e), "0 to 1")?;
            }
            Contact::Compliant { stiffness, damping } => {
                check("stiffness", stiffness, stiffness > 0.0, "above 0")?;
                check("damping", damping, damping >= 0.0, "0 or more")?;
            }
        }
        let Adhesion { upper, lower } = self.adhesion;
        check("adhesion upper", upper, upper >= 0.0, "0 or more")?;
        check("adhesion lower", lower, lower >= 0.0, "0 or more")
    }

    /// Kinetic energy, J.
    pub fn kinetic_energy(&self, v1: f64, v2: f64) -> f64 {
        0.5 * (self.motor.inertia * v1 * v1 + self.load.inertia * v2 * v2)
    }

    /// `J1 v1 + J2 v2`, N m s (or N s).
    pub fn momentum(&self, v1: f64, v2: f64) -> f64 {
        self.motor.inertia * v1 + self.load.inertia * v2
    }
}

impl DriveInput {
    /// A run of `duration` s from rest in the middle of the gap, with samples every `step` s.
    pub fn new(drive: Drive, command: Command, duration: f64, step: Option<f64>) -> Self {
        Self {
            drive,
            command,
            start: Start::default(),
            duration,
            step,
            max_events: MAX_EVENTS,
        }
    }

    /// Checks every value.
    ///
    /// # Errors
    /// The first one out of its range.
    pub fn validate(&self) -> Result<(), DriveError> {
        self.drive.validate()?;
        self.command.validate()?;
        check("duration", self.duration, self.duration > 0.0, "above 0 s")?;
        if let Some(step) = self.step {
            check("step", step, step > 0.0, "above 0 s")?;
            let count = self.duration / step;
            check(
                "number of samples",
                count,
                count <= MAX_SAMPLES,
                "at most 10,000,000: a shorter duration or a longer step",
            )?;
        }
        let Start { x1, v1, x2, v2 } = self.start;
        for (name, value) in [
            ("start x1", x1),
            ("start v1", v1),
            ("start x2", x2),
            ("start v2", v2),
        ] {
            check(name, value, true, "a number")?;
        }
        if matches!(self.drive.contact, Contact::Rigid { .. }) {
            let apart = x1 - x2;
            let fits = apart.abs() <= self.drive.half_gap;
            check(
                "start x1 - x2",
                apart,
                fits,
                "within the half gap of a rigid contact",
            )?;
        }
        Ok(())
    }
}
