//! What is set on the page, besides the loop.

use hysteron_core::figures::figures;
use hysteron_core::message::Message;
use hysteron_core::msg;
use serde::{Deserialize, Serialize};

use super::Explore;
use super::controller::Controller;
use super::{on_off, servo};
use crate::desk::Desk;
use crate::page::Settable;

/// Largest half gap that a link may ask for.
const MOST_PLAY: f64 = 1e3;

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Settings {
    /// Number of the figure whose claim is checked.
    figure: Option<u32>,
    /// Whether the point S is shown in the Nyquist plot.
    margin: bool,
    /// Where the playback stands still, s.
    paused: Option<f64>,
    /// What switches or steers.
    controller: Controller,
    /// What a relay has as it is built.
    on_off: on_off::Settings,
    /// A drive with a controller.
    servo: servo::Settings,
    /// Half gap of the play before the relay.
    play: f64,
}

impl Settable for Explore {
    type Settings = Settings;

    fn set_to(&self) -> Settings {
        Settings {
            figure: self.figure,
            margin: self.nyquist.margin,
            paused: self.playback.paused(),
            controller: self.controller,
            on_off: self.on_off.set.clone(),
            servo: self.servo.set.clone(),
            play: self.theory.play,
        }
    }

    fn take(
        &mut self,
        _ctx: &egui::Context,
        settings: Settings,
        desk: &Desk,
    ) -> Result<(), Message> {
        if let Some(number) = settings.figure
            && figures().iter().all(|f| f.number != number)
        {
            return Err(msg!("There is no figure {} on this page.", number));
        }
        (settings.on_off).check(settings.controller, &desk.relay_loop)?;
        settings.servo.check()?;
        if !(0.0..=MOST_PLAY).contains(&settings.play) {
            return Err("The half gap of the play must be 0 to 1000.".into());
        }
        self.theory.play = settings.play;
        self.controller = settings.controller;
        self.on_off.put(settings.on_off);
        self.servo.put(settings.servo);
        self.figure = settings.figure;
        self.nyquist.margin = settings.margin;
        self.playback.set(settings.paused);
        Ok(())
    }
}
