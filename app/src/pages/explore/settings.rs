//! What is set on the page, besides the loop.

use hysteron_core::figures::figures;
use serde::{Deserialize, Serialize};

use super::Explore;
use crate::desk::Desk;
use crate::page::Settable;

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Settings {
    /// Number of the figure whose claim is checked.
    figure: Option<u32>,
    /// Whether the point S is shown in the Nyquist plot.
    margin: bool,
    /// Half gap of the play that is looked at, in the unit of the output.
    #[serde(default = "half_gap")]
    half_gap: f64,
    /// Where the playback stands still, s.
    paused: Option<f64>,
}

/// Links from before there was any have this.
fn half_gap() -> f64 {
    super::play::HALF_GAP
}

impl Settable for Explore {
    type Settings = Settings;

    fn set_to(&self) -> Settings {
        Settings {
            figure: self.figure,
            margin: self.nyquist.margin,
            half_gap: self.half_gap,
            paused: self.playback.paused(),
        }
    }

    fn take(
        &mut self,
        _ctx: &egui::Context,
        settings: Settings,
        _desk: &Desk,
    ) -> Result<(), String> {
        if let Some(number) = settings.figure
            && figures().iter().all(|f| f.number != number)
        {
            return Err(format!("There is no figure {number} on this page."));
        }
        if !(0.0..=1e6).contains(&settings.half_gap) {
            return Err(format!(
                "half gap is {}: must be 0 or more",
                settings.half_gap
            ));
        }
        self.half_gap = settings.half_gap;
        self.figure = settings.figure;
        self.nyquist.margin = settings.margin;
        self.playback.set(settings.paused);
        Ok(())
    }
}
