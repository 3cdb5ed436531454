//! What is measured, and what it is driven with.

use serde::{Deserialize, Serialize};

use crate::measurement::Kind;

/// What is measured, and what it is driven with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Experiment {
    /// A relay on the velocity of a drive, a little asymmetric.
    Relay,
    /// A sum of sines on a drive.
    #[default]
    Sines,
    /// Steps of growing size in both directions on a drive.
    Stairs,
    /// A relay on the velocity of a drive that lets it drift to and fro.
    Drifting,
    /// A relay on the output of a process.
    ProcessRelay,
    /// Levels of several sizes on a process.
    ProcessStairs,
    /// Two levels on a process, held for random times.
    ProcessBinary,
}

impl Experiment {
    /// All of them on such a system.
    pub const fn of(kind: Kind) -> &'static [Self] {
        match kind {
            Kind::Drive => &[Self::Sines, Self::Relay, Self::Stairs, Self::Drifting],
            Kind::Process => &[Self::ProcessBinary, Self::ProcessRelay, Self::ProcessStairs],
        }
    }

    /// What is measured.
    pub const fn kind(self) -> Kind {
        match self {
            Self::Relay | Self::Sines | Self::Stairs | Self::Drifting => Kind::Drive,
            Self::ProcessRelay | Self::ProcessStairs | Self::ProcessBinary => Kind::Process,
        }
    }
}
