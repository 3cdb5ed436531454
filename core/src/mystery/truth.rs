//! What is hidden, as a value and as the text that is sealed.

use std::fmt::Write as _;

use serde::{Deserialize, Serialize};

use super::MysteryError;
use crate::effect::EffectId;
use crate::measurement::Kind;

/// First line of a sealed text.
const DRIVE: &str = "truth";
const PROCESS: &str = "truth:process";

/// One hidden effect.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Hidden {
    /// Which.
    pub effect: EffectId,
    /// Its parameters as the library's effect has them: symbol and value in SI. Only those that a fit can
    /// be held to.
    pub parameters: Vec<(String, f64)>,
}

/// All that is true of a record.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Truth {
    /// What was measured.
    pub kind: Kind,
    /// The hidden effects; none where nothing is missing.
    pub hidden: Vec<Hidden>,
    /// Parameters of the simplest model: symbol and value in SI.
    pub baseline: Vec<(String, f64)>,
}

impl Truth {
    /// One line a group: a name, then symbols and values in turn.
    pub(super) fn text(&self) -> String {
        let begin = match self.kind {
            Kind::Drive => DRIVE,
            Kind::Process => PROCESS,
        };
        let mut text = begin.to_owned();
        let baseline = std::iter::once(("baseline", &self.baseline));
        let hidden = self.hidden.iter();
        for (name, parameters) in baseline.chain(hidden.map(|h| (h.effect.as_str(), &h.parameters)))
        {
            // Writing into a string cannot fail.
            let _ = write!(text, "\n{name}");
            for (symbol, value) in parameters {
                let _ = write!(text, " {symbol} {value:e}");
            }
        }
        text
    }

    /// Reads what [`Self::text`] has written.
    pub(super) fn read(text: &str) -> Result<Self, MysteryError> {
        let mut lines = text.lines();
        let kind = match lines.next().map(str::trim) {
            Some(DRIVE) => Kind::Drive,
            Some(PROCESS) => Kind::Process,
            _ => return Err(MysteryError::BadSeal),
        };
        let (hidden, baseline) = (Vec::new(), Vec::new());
        let mut truth = Self {
            kind,
            hidden,
            baseline,
        };
        for line in lines {
            let mut words = line.split_whitespace();
            let Some(name) = words.next() else {
                continue;
            };
            let mut parameters = Vec::new();
            while let Some(symbol) = words.next() {
                let value = words.next().and_then(|v| v.parse().ok());
                parameters.push((symbol.to_owned(), value.ok_or(MysteryError::BadSeal)?));
            }
            if name == "baseline" {
                truth.baseline = parameters;
            } else {
                let effect = EffectId::parse(name);
                let effect = effect.ok_or_else(|| MysteryError::UnknownEffect(name.to_owned()))?;
                truth.hidden.push(Hidden { effect, parameters });
            }
        }
        Ok(truth)
    }
}
