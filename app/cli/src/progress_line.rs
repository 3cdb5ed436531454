//! How far a diagnosis is, on a terminal.

use std::io::{self, IsTerminal as _, Write as _};

use hysteron_core::message::Message;
use hysteron_work::language::say;

/// One line on stderr that is written over again and again; nothing where stderr is no terminal.
pub struct ProgressLine {
    terminal: bool,
    shown: String,
}

impl ProgressLine {
    pub fn new() -> Self {
        Self {
            terminal: io::stderr().is_terminal(),
            shown: String::new(),
        }
    }

    pub fn show(&mut self, fraction: f64, text: &Message) {
        if !self.terminal {
            return;
        }
        let line: String = format!("{:3.0} % {}", fraction * 100.0, say(text))
            .chars()
            .take(79)
            .collect();
        if line != self.shown {
            // Progress that cannot be shown is no reason to stop.
            let _ = write!(io::stderr(), "\r\x1b[K{line}");
            self.shown = line;
        }
    }

    pub fn clear(&self) {
        if !self.shown.is_empty() {
            let _ = write!(io::stderr(), "\r\x1b[K");
        }
    }
}
