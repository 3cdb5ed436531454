//! A run that is played back.

use crate::motion;

/// Longest step from frame to frame, s: a window that was hidden does not leap.
const LONGEST_STEP: f64 = 0.1;

/// The place in a run that is shown, and whether it moves on.
pub struct Playback {
    pub playing: bool,
    /// Whether someone has started it: else it stands still where less motion is asked for.
    started: bool,
    /// Time since the start of the run, s.
    pub clock: f64,
}

impl Default for Playback {
    fn default() -> Self {
        Self {
            playing: true,
            started: false,
            clock: 0.0,
        }
    }
}

impl Playback {
    /// Moves on by `speed` seconds of the run a second; at its `end` it begins again.
    pub fn advance(&mut self, ui: &egui::Ui, speed: f64, end: f64) {
        if self.moves(ui.ctx()) {
            let seconds = f64::from(ui.input(|i| i.stable_dt)).min(LONGEST_STEP);
            self.clock += seconds * speed;
            ui.ctx().request_repaint();
        }
        if self.clock > end {
            self.clock = 0.0;
        }
    }

    /// Whether it moves on.
    fn moves(&self, ctx: &egui::Context) -> bool {
        self.playing && (self.started || !motion::reduced(ctx))
    }

    /// Plays or pauses.
    pub fn toggle(&mut self, ctx: &egui::Context) {
        self.playing = !self.moves(ctx);
        self.started = self.playing;
    }

    /// What its button does now.
    pub fn label(&self, ctx: &egui::Context) -> &'static str {
        if self.moves(ctx) { "Pause" } else { "Play" }
    }

    /// Where it stands still, s.
    pub fn paused(&self) -> Option<f64> {
        (!self.playing).then_some(self.clock)
    }

    /// Stands still at a time, or plays.
    pub fn set(&mut self, paused: Option<f64>) {
        self.playing = paused.is_none();
        self.clock = paused.unwrap_or(self.clock).max(0.0);
    }
}
