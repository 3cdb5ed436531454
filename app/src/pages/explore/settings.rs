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
    /// Where the playback stands still, s.
    paused: Option<f64>,
}

impl Settable for Explore {
    type Settings = Settings;

    fn set_to(&self) -> Settings {
        Settings {
            figure: self.figure,
            margin: self.nyquist.margin,
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
        self.figure = settings.figure;
        self.nyquist.margin = settings.margin;
        self.playback.set(settings.paused);
        Ok(())
    }
}
