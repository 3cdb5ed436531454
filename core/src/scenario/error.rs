//! What is wrong with a file, and where.

use crate::drive::DriveError;
use crate::hunting::ServoError;
use crate::plant::{ParseError, PlantError};
use crate::relay::RelayError;
use crate::simulate::SimulateError;

/// Why a file is no scenario.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ScenarioError {
    /// The text.
    #[error("line {line}, column {column}: {message}")]
    Text {
        /// Line, from 1.
        line: usize,
        /// Column in characters, from 1.
        column: usize,
        /// What is wrong.
        message: String,
    },
    /// The plant is given in no way, or in several.
    #[error(
        "[plant]: {0}; expected one of: numerator and denominator; formula; zeros, poles and gain; gain and \
         time_constant; a, b and c"
    )]
    Form(&'static str),
    /// The relay's outputs are given in no way, or in two.
    #[error("[relay]: {0}; expected gain, or levels = [down, up]")]
    Levels(&'static str),
    /// The formula.
    #[error("[plant] formula, {0}")]
    Formula(ParseError),
    /// The plant.
    #[error("[plant]: {0}")]
    Plant(#[from] PlantError),
    /// The relay.
    #[error("[relay]: {0}")]
    Relay(#[from] RelayError),
    /// The run.
    #[error("[run]: {0}")]
    Run(SimulateError),
    /// A servo.
    #[error("[servo]: {0}")]
    Servo(ServoError),
    /// A drive, its relay or its run.
    #[error("{table}: {error}")]
    Drive {
        /// Where it stands.
        table: &'static str,
        /// What is wrong.
        error: DriveError,
    },
}

/// What the reader of TOML says, with its place.
pub(super) fn located(text: &str, error: &toml::de::Error) -> ScenarioError {
    let at = error.span().map_or(0, |s| s.start).min(text.len());
    let before = text.get(..at).unwrap_or(text);
    let line = before.matches('\n').count() + 1;
    let column = before.chars().rev().take_while(|c| *c != '\n').count() + 1;
    ScenarioError::Text {
        line,
        column,
        message: error.message().to_owned(),
    }
}
