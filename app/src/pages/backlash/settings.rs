//! What is set on the page.

use hysteron_core::drive::{Command, DriveInput, figures};
use hysteron_core::message::Message;
use hysteron_core::msg;
use serde::{Deserialize, Serialize};

use super::Backlash;
use super::built_in::BUILT_IN;
use crate::desk::Desk;
use crate::files::Held;
use crate::page::Settable;

/// The most that a link may ask for: a longer run, or one of more events, would fill the memory.
const LONGEST_RUN: f64 = 120.0;
const MOST_SAMPLES: f64 = 500_000.0;

/// Slowest and fastest playback, times real time.
const SPEEDS: std::ops::RangeInclusive<f64> = 1e-6..=1e3;

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Settings {
    /// Number of the figure whose claim is checked.
    figure: Option<u32>,
    /// Whether the drive is drawn as the block diagram of Fig. 8.
    structure: bool,
    /// The drive, its relay, and how long it runs.
    run: DriveInput,
    /// Gap, rad, and torque, N m, for which a drifting test is designed.
    expected_gap: f64,
    largest_torque: f64,
    /// Playback, times real time.
    speed: f64,
    /// Where it stands still, s.
    paused: Option<f64>,
    /// The measurement that is open.
    file: Option<String>,
}

impl Settable for Backlash {
    type Settings = Settings;

    fn set_to(&self) -> Settings {
        Settings {
            figure: self.figure,
            structure: self.structure,
            run: self.input,
            expected_gap: self.design.gap,
            largest_torque: self.design.torque,
            speed: self.speed,
            paused: self.playback.paused(),
            file: self.file.clone(),
        }
    }

    fn take(
        &mut self,
        ctx: &egui::Context,
        settings: Settings,
        _desk: &Desk,
    ) -> Result<(), Message> {
        settings.check()?;
        let file = match &settings.file {
            Some(name) if settings.file != self.file => {
                let file = self.known(name);
                Some(file.ok_or_else(|| crate::link::not_enclosed(name))?)
            }
            _ => None,
        };
        if settings.figure != self.figure && self.file.is_none() {
            // What the figure claims is checked when the scene is made.
            self.scene = None;
        }
        self.figure = settings.figure;
        self.structure = settings.structure;
        self.input = settings.run;
        self.design.gap = settings.expected_gap;
        self.design.torque = settings.largest_torque;
        self.speed = settings.speed;
        self.message = None;
        if let Some(file) = file {
            self.open_held(ctx, file);
        } else if settings.file.is_none() && self.file.is_some() {
            self.close();
        }
        self.playback.set(settings.paused);
        Ok(())
    }
}

impl Backlash {
    /// The measurement of this name, if it comes with the page or was open before.
    fn known(&self, name: &str) -> Option<Held> {
        let built_in = BUILT_IN.iter().find(|b| b.file.id == name);
        let built_in = built_in.map(|b| Held::from(&b.file));
        built_in.or_else(|| self.files.held(name).cloned())
    }
}

impl Settings {
    fn check(&self) -> Result<(), Message> {
        if let Some(number) = self.figure
            && figures().iter().all(|f| f.number != number)
        {
            return Err(msg!("There is no figure {} on this page.", number));
        }
        let run = &self.run;
        let sentence = |e: Message| msg!("This drive is not possible: {}.", e);
        run.drive.validate().map_err(|e| sentence(e.into()))?;
        if let Command::Relay(relay) = run.command {
            relay.validate().map_err(|e| sentence(e.into()))?;
        }
        if !(run.duration > 0.0 && run.duration <= LONGEST_RUN) {
            return Err(msg!(
                "A run must last more than 0 and at most {} s.",
                LONGEST_RUN
            ));
        }
        let samples = run.step.map_or(0.0, |step| run.duration / step);
        if !(0.0..=MOST_SAMPLES).contains(&samples) {
            return Err(msg!("A run may have at most {} samples.", MOST_SAMPLES));
        }
        if run.max_events > hysteron_core::drive::MAX_EVENTS {
            return Err(sentence("it may have at most 500,000 events".into()));
        }
        let positive = |v: f64| v > 0.0 && v <= 1e6;
        if !positive(self.expected_gap) || !positive(self.largest_torque) {
            return Err("Gap and torque of the design must be above 0.".into());
        }
        if !SPEEDS.contains(&self.speed) {
            return Err("The speed of the playback must be above 0.".into());
        }
        Ok(())
    }
}
