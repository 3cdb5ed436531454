//! What kind of system was measured, and what of it.

use serde::{Deserialize, Serialize};

/// What kind of system was measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// A motor that moves an inertia: torque or force in, position and/or velocity out.
    Drive,
    /// A self-regulating process: some input in, some output `y` out.
    Process,
}

impl Kind {
    /// Its name in files and sentences.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Drive => "drive",
            Self::Process => "process",
        }
    }
}

/// Whether a drive turns or slides; a process does neither.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Motion {
    /// kg m^2, N m, rad.
    Rotational,
    /// kg, N, m.
    Translational,
    /// A process: input and output in their own units.
    None,
}

/// What a column holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    /// Manipulated input `u`: torque in N m, force in N, or a process input.
    Input,
    /// Motor position `x1`, rad or m.
    Position,
    /// Motor velocity `v1`, rad/s or m/s.
    Velocity,
    /// Load position `x2`, rad or m; for reference, never needed by a diagnosis.
    LoadPosition,
    /// Load velocity `v2`, rad/s or m/s; for reference, never needed by a diagnosis.
    LoadVelocity,
    /// Process output `y`.
    Output,
}
