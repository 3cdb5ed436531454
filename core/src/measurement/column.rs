//! What a column can be, and how it is called.

use serde::{Deserialize, Serialize};

use super::kind::Quantity;

/// What a column can be.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Role {
    /// The times of the samples.
    Time,
    /// What was recorded at them.
    Measured(Quantity),
}

impl Role {
    /// Its name in headers and mappings.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Time => "t",
            Self::Measured(Quantity::Input) => "u",
            Self::Measured(Quantity::Position) => "x1",
            Self::Measured(Quantity::Velocity) => "v1",
            Self::Measured(Quantity::LoadPosition) => "x2",
            Self::Measured(Quantity::LoadVelocity) => "v2",
            Self::Measured(Quantity::Output) => "y",
        }
    }

    /// The role of this name.
    pub(super) fn called(name: &str) -> Option<Self> {
        role(name).filter(|role| role.name().eq_ignore_ascii_case(name))
    }
}

/// Role that a column name stands for.
pub(super) fn role(name: &str) -> Option<Role> {
    use Quantity::{Input, LoadPosition, LoadVelocity, Output, Position, Velocity};
    Some(match name.to_lowercase().as_str() {
        "t" | "time" | "zeit" => Role::Time,
        "u" | "torque" | "tau" | "force" | "f" | "input" | "motor_torque" => Role::Measured(Input),
        "x1" | "x" | "position" | "pos" | "theta" | "angle" | "q" | "phi" => {
            Role::Measured(Position)
        }
        "v1" | "v" | "velocity" | "vel" | "omega" | "speed" | "w" => Role::Measured(Velocity),
        "x2" | "load_position" => Role::Measured(LoadPosition),
        "v2" | "load_velocity" => Role::Measured(LoadVelocity),
        "y" | "output" => Role::Measured(Output),
        _ => return None,
    })
}

/// At most 30 characters of a text from the file, none of which can break a line of the terminal.
pub(super) fn shorten(text: &str) -> String {
    text.chars().filter(|c| !c.is_control()).take(30).collect()
}

/// The begin of a line of a file, with a mark where it goes on.
pub(super) fn begin_of(line: &str) -> String {
    let shown: String = line.chars().filter(|c| !c.is_control()).collect();
    match shown.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{} ...", shown[..end].trim_end()),
        None => shown,
    }
}

/// Most characters of a line that are shown.
const LONGEST: usize = 70;
