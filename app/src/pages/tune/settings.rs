//! What is set on the page, besides plant and relay.

use hysteron_core::message::Message;
use hysteron_core::tuning::{Pid, rule};
use serde::{Deserialize, Serialize};

use super::{STAGES, Tune, measured};
use crate::desk::Desk;
use crate::page::Settable;

/// Phase margins that are taken, rad.
const MARGINS: std::ops::RangeInclusive<f64> = 0.01..=1.55;

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Settings {
    /// Id of the step in view.
    step: String,
    /// Asymmetry of the asymmetric test.
    asymmetry: f64,
    /// Wanted phase margin, rad.
    phase_margin: f64,
    /// Gain of the proportional controller before.
    gain_before: f64,
    /// Id of the rule.
    rule: String,
    /// A test that was measured.
    measured: measured::Settings,
}

impl Settable for Tune {
    type Settings = Settings;

    fn set_to(&self) -> Settings {
        Settings {
            step: STAGES.get(self.stage).map_or("", |s| s.id).to_owned(),
            asymmetry: self.asymmetry,
            phase_margin: self.input.wish.phase_margin,
            gain_before: self.input.present.gain,
            rule: self.input.rule.clone(),
            measured: self.measured.set_to(),
        }
    }

    fn take(
        &mut self,
        _ctx: &egui::Context,
        settings: Settings,
        _desk: &Desk,
    ) -> Result<(), Message> {
        let stage = STAGES.iter().position(|s| s.id == settings.step);
        let stage = stage.ok_or("This step of the tuning does not exist.")?;
        rule(&settings.rule).map_err(|_| "This tuning rule does not exist.")?;
        if settings.asymmetry.abs() > 0.99 {
            return Err("The asymmetry must be between -0.99 and 0.99.".into());
        }
        if !MARGINS.contains(&settings.phase_margin) {
            return Err("The phase margin must be between 0.01 and 1.55 rad.".into());
        }
        self.measured.take(&settings.measured)?;
        self.stage = stage;
        self.asymmetry = settings.asymmetry;
        self.input.wish.phase_margin = settings.phase_margin;
        self.input.present = Pid::p(settings.gain_before);
        self.input.rule = settings.rule;
        Ok(())
    }
}
