//! A file of any kind.

use serde::Deserialize;
use serde::de::IgnoredAny;

use super::error::{ScenarioError, located};
use super::on_off::{OnOffScenario, is_on_off};
use super::relay_loop::Scenario;
use super::servo::ServoScenario;
use crate::drive::{DriveFile, DriveInput};

/// The keys that a file sets in its table `[run]`, in the order of the alphabet; none of a text that is no TOML.
pub fn keys_of_run(text: &str) -> Vec<String> {
    #[derive(Default, Deserialize)]
    struct Tables {
        #[serde(default)]
        run: toml::Table,
    }
    let tables: Tables = toml::from_str(text).unwrap_or_default();
    let mut keys: Vec<String> = tables.run.into_iter().map(|(key, _)| key).collect();
    keys.sort_unstable();
    keys
}

/// What a file can hold.
#[derive(Clone, Debug, PartialEq)]
pub enum AnyScenario {
    /// A relay loop around a linear plant.
    Loop(Box<Scenario>),
    /// An on-off controller as it is built, around a plant in continuous or in discrete time.
    OnOff(Box<OnOffScenario>),
    /// A controller of the position around a drive.
    Servo(Box<ServoScenario>),
    /// A drive with a hidden gap.
    Drive(Box<DriveInput>),
}

impl AnyScenario {
    /// Reads a scenario: a drive if it has a table `[drive]`, a servo if it has `[servo]`, else a loop, of an on-off
    /// controller if a key says so.
    ///
    /// # Errors
    /// Line and column of what is no TOML or not expected, or the table and value that cannot be.
    pub fn from_toml(text: &str) -> Result<Self, ScenarioError> {
        #[derive(Deserialize)]
        struct Tables {
            drive: Option<IgnoredAny>,
            plant: Option<IgnoredAny>,
            servo: Option<IgnoredAny>,
        }
        let tables: Tables = toml::from_str(text).map_err(|e| located(text, &e))?;
        let others = tables.drive.is_some() || tables.plant.is_some();
        if tables.servo.is_some() {
            return if others {
                Err(ScenarioError::Form(
                    "there is a [servo] as well; a scenario has only one of the two",
                ))
            } else {
                Ok(Self::Servo(Box::new(ServoScenario::from_toml(text)?)))
            };
        }
        match (tables.drive, tables.plant) {
            (Some(_), Some(_)) => Err(ScenarioError::Form(
                "there is a [drive] as well; a scenario has only one of the two",
            )),
            (Some(_), None) => {
                let file: DriveFile = toml::from_str(text).map_err(|e| located(text, &e))?;
                let input = file
                    .input()
                    .map_err(|(table, error)| ScenarioError::Drive { table, error })?;
                Ok(Self::Drive(Box::new(input)))
            }
            _ if is_on_off(text) => Ok(Self::OnOff(Box::new(OnOffScenario::from_toml(text)?))),
            _ => Ok(Self::Loop(Box::new(Scenario::from_toml(text)?))),
        }
    }
}
