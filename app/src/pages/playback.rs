//! A run that is played back.

/// Longest step from frame to frame, s: a window that was hidden does not leap.
const LONGEST_STEP: f64 = 0.1;

/// The place in a run that is shown, and whether it moves on.
pub struct Playback {
    pub playing: bool,
    /// Time since the start of the run, s.
    pub clock: f64,
}

impl Default for Playback {
    fn default() -> Self {
        Self {
            playing: true,
            clock: 0.0,
        }
    }
}

impl Playback {
    /// Moves on by `speed` seconds of the run a second; at its `end` it begins again.
    pub fn advance(&mut self, ui: &egui::Ui, speed: f64, end: f64) {
        if self.playing {
            let seconds = f64::from(ui.input(|i| i.stable_dt)).min(LONGEST_STEP);
            self.clock += seconds * speed;
            ui.ctx().request_repaint();
        }
        if self.clock > end {
            self.clock = 0.0;
        }
    }

    /// Plays or pauses.
    pub fn toggle(&mut self) {
        self.playing = !self.playing;
    }

    /// What its button does now.
    pub fn label(&self) -> &'static str {
        if self.playing { "Pause" } else { "Play" }
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
