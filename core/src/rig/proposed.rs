//! Inputs as a person at a bench sets them for a proposed experiment.

/// What is set.
#[derive(Clone, Copy, Debug)]
pub enum Proposed {
    /// Relay without asymmetry whose gain changes to and fro.
    TwoGains {
        /// Of the relay, in the unit of the input.
        gains: [f64; 2],
        /// Time for which each holds, s.
        hold: f64,
        /// In the unit of what is seen.
        hysteresis: f64,
    },
    /// Levels in turn, over and over.
    Levels {
        /// In the unit of the input.
        levels: [f64; 16],
        /// Time for which each holds, s.
        hold: f64,
    },
}

impl Proposed {
    /// The input at time `t`; `high` is the relay's state, which follows what is `seen`.
    pub fn input(self, t: f64, seen: f64, high: &mut bool) -> f64 {
        match self {
            Self::TwoGains {
                gains,
                hold,
                hysteresis,
            } => {
                if seen.abs() > hysteresis {
                    *high = seen > 0.0;
                }
                let gain = if (t + 1e-9) % (2.0 * hold) >= hold {
                    gains[1]
                } else {
                    gains[0]
                };
                if *high { -gain } else { gain }
            }
            Self::Levels { levels, hold } => {
                let index = ((t + 1e-9) / hold) as usize % levels.len();
                levels.get(index).copied().unwrap_or(0.0)
            }
        }
    }
}
