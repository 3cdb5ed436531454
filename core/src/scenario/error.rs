//! What is wrong with a file, and where.

use crate::drive::DriveError;
use crate::hunting::ServoError;
use crate::message::{Message, says};
use crate::msg;
use crate::plant::{ParseError, PlantError};
use crate::relay::RelayError;
use crate::simulate::SimulateError;

/// Why a file is no scenario.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ScenarioError {
    /// The text.
    Text {
        /// Line, from 1.
        line: usize,
        /// Column in characters, from 1.
        column: usize,
        /// What is wrong.
        message: String,
    },
    /// The plant is given in no way, or in several.
    Form(&'static str),
    /// The relay's outputs are given in no way, or in two.
    Levels(&'static str),
    /// The formula.
    Formula(ParseError),
    /// The plant.
    Plant(#[from] PlantError),
    /// The relay.
    Relay(#[from] RelayError),
    /// The run.
    Run(SimulateError),
    /// A servo.
    Servo(ServoError),
    /// A drive, its relay or its run.
    Drive {
        /// Where it stands.
        table: &'static str,
        /// What is wrong.
        error: DriveError,
    },
}

impl ScenarioError {
    /// In words.
    pub fn message(&self) -> Message {
        match self {
            Self::Text {
                line,
                column,
                message,
            } => msg!(
                "line {}, column {}: {}",
                line,
                column,
                Message::name(message)
            ),
            Self::Form(given) => msg!(
                "[plant]: {}; expected one of: numerator and denominator; formula; zeros, poles and gain; gain and \
         time_constant; a, b and c",
                given
            ),
            Self::Levels(given) => {
                msg!("[relay]: {}; expected gain, or levels = [down, up]", given)
            }
            Self::Formula(error) => msg!("[plant] formula, {}", error),
            Self::Plant(error) => msg!("[plant]: {}", error),
            Self::Relay(error) => msg!("[relay]: {}", error),
            Self::Run(error) => msg!("[run]: {}", error),
            Self::Servo(error) => msg!("[servo]: {}", error),
            Self::Drive { table, error } => msg!("{}: {}", table, error),
        }
    }
}

says!(ScenarioError);

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
