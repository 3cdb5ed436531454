//! The table of cycles in which `hysteron limit-cycle` shows what was predicted and what was simulated.

use std::fmt::Write as _;

use hysteron_core::message::Message;
use hysteron_work::language::{say, tr_number};

/// Cycles by name, with period, amplitude and whether they are stable.
#[derive(Default)]
pub struct CycleTable {
    rows: String,
}

impl CycleTable {
    /// Adds a cycle; `stable` is `None` where that is not known.
    pub fn row(&mut self, name: &'static str, period: f64, amplitude: f64, stable: Option<bool>) {
        let stable = stable.map_or("not known", |s| if s { "yes" } else { "no" });
        let [period, amplitude] = [period, amplitude].map(|v| tr_number(format!("{v:.9}")));
        let (name, stable) = (say(name), say(stable));
        let _ = writeln!(
            self.rows,
            "{name:<22} {period:>16} {amplitude:>16}   {stable}"
        );
    }

    /// Adds a line of words on cycles of this name.
    pub fn words(&mut self, name: &'static str, words: &Message) {
        let _ = writeln!(self.rows, "{:<22} {}", say(name), say(words));
    }

    /// The table with its head; `None` where nothing oscillates.
    pub fn text(&self) -> Option<String> {
        let [period, amplitude, stable, convention] = [
            "period [s]",
            "amplitude",
            "stable",
            "Amplitude: half of peak to peak.",
        ]
        .map(say);
        let (rows, none) = (&self.rows, "");
        (!rows.is_empty()).then(|| {
            let head = format!("{none:<22} {period:>16} {amplitude:>16}   {stable}");
            format!("{head}\n{rows}{convention}\n")
        })
    }
}
