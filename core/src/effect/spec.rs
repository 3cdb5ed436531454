//! What a parameter of an effect is: symbol, unit, bounds.

use serde::{Deserialize, Serialize};

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

/// Physical dimension of a parameter; its SI unit follows from the [`Motion`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dimension {
    /// Torque or force; for a process the unit of its input.
    Force,
    /// s.
    Time,
    /// Plain number.
    Ratio,
    /// kg m^2 or kg.
    Inertia,
    /// N m s/rad or N s/m.
    ViscousFriction,
    /// rad or m.
    Position,
}

impl Dimension {
    /// SI unit as written on screen.
    pub const fn unit(self, motion: Motion) -> &'static str {
        match (self, motion) {
            (Self::Time, _) => "s",
            (Self::Ratio, _) | (_, Motion::None) => "1",
            (Self::Force, Motion::Rotational) => "N m",
            (Self::Force, Motion::Translational) => "N",
            (Self::Inertia, Motion::Rotational) => "kg m^2",
            (Self::Inertia, Motion::Translational) => "kg",
            (Self::ViscousFriction, Motion::Rotational) => "N m s/rad",
            (Self::ViscousFriction, Motion::Translational) => "N s/m",
            (Self::Position, Motion::Rotational) => "rad",
            (Self::Position, Motion::Translational) => "m",
        }
    }
}

/// A parameter of an effect.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParameterSpec {
    /// Symbol, such as `c`.
    pub symbol: &'static str,
    /// Plain words, such as `friction level`.
    pub label: &'static str,
    /// Dimension, from which the unit follows.
    pub dimension: Dimension,
}
