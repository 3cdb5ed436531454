//! How a measured test is set.

use super::{BUILT_IN, Measured, Settings};
use crate::files::Held;
use crate::link::not_enclosed;
use hysteron_core::message::Message;
use hysteron_core::msg;

impl Measured {
    pub fn set_to(&self) -> Settings {
        Settings {
            from: self.from,
            file: self.file.as_ref().map(|f| f.name.clone()),
            readings: self.readings.clone(),
            wishes: self.wishes.clone(),
            chosen: self.chosen.clone(),
        }
    }

    pub fn take(&mut self, settings: &Settings) -> Result<(), Message> {
        settings
            .readings
            .validate()
            .map_err(|e| msg!("These numbers are not possible: {}.", e))?;
        let positive = |v: Option<f64>| v.is_none_or(|v| v.is_finite() && v > 0.0);
        if !positive(settings.wishes.full_scale) {
            return Err("The full scale of the input must be above 0.".into());
        }
        let present = self.file.as_ref().map(|f| &f.name);
        let file = match &settings.file {
            Some(name) if Some(name) != present => {
                Some(self.known(name).ok_or_else(|| not_enclosed(name))?)
            }
            _ => None,
        };
        if let Some(file) = file {
            self.open(file);
        } else if settings.file.is_none() && self.file.is_some() {
            self.file = None;
            self.opened += 1;
        }
        self.from = settings.from;
        self.readings = settings.readings.clone();
        self.wishes = settings.wishes.clone();
        self.chosen.clone_from(&settings.chosen);
        Ok(())
    }

    /// The test of this name, if it comes with the page or was open before.
    fn known(&self, name: &str) -> Option<Held> {
        let built_in = (name == BUILT_IN.id).then(|| Held::from(&BUILT_IN));
        built_in.or_else(|| self.files.held(name).cloned())
    }
}
