//! What the user wants of a measured test.

use super::gains::Form;
use super::report::Settings;
use crate::message::Message;

/// What the user wants besides; it beats what a log says.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Wishes {
    /// Form of the gains; parallel, or for a log that of its firmware, where it is not given.
    pub form: Option<Form>,
    /// Largest value of the input; guessed where it is not given.
    pub full_scale: Option<f64>,
    /// Set point of the test, in the unit of the output.
    pub target: Option<f64>,
    /// Half the distance between the outputs at which the relay switches, where a record or a log does not tell it.
    pub hysteresis: Option<f64>,
    /// Input while the relay is down and up, where a log does not tell it.
    pub levels: Option<[f64; 2]>,
}

impl Wishes {
    /// The same for a record or for numbers.
    pub fn settings(&self, notes: Vec<Message>) -> Settings {
        Settings {
            form: self.form.unwrap_or_default(),
            full_scale: self.full_scale,
            target: self.target,
            hysteresis: self.hysteresis,
            notes,
        }
    }
}
