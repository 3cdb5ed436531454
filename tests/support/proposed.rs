//! What a person at a rig sets to carry out a proposed experiment.

use hysteron_core::criticism::{NextExperiment, Program};

#[derive(Clone, Copy, Debug)]
pub enum Proposed {
    /// Relay without asymmetry whose gain changes to and fro, each holding so many seconds.
    TwoGains {
        gains: [f64; 2],
        hold: f64,
        hysteresis: f64,
    },
    /// These levels in turn, over and over, each for so many seconds.
    Levels { levels: [f64; 16], hold: f64 },
}

impl Proposed {
    /// What the proposal says, as far as the rigs can do it.
    pub fn of(proposal: &NextExperiment) -> Self {
        match &proposal.program {
            Program::Relay {
                gains,
                hold,
                hysteresis,
                ..
            } => Self::TwoGains {
                gains: gains.as_slice().try_into().expect("two gains"),
                hold: *hold,
                hysteresis: *hysteresis,
            },
            Program::Levels { levels, hold } => Self::Levels {
                levels: levels.as_slice().try_into().expect("sixteen levels"),
                hold: *hold,
            },
            Program::Multisine { .. } => panic!("no sines at these rigs: {}", proposal.text),
        }
    }

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
                let gain = gains[usize::from((t + 1e-9) % (2.0 * hold) >= hold)];
                if *high { -gain } else { gain }
            }
            Self::Levels { levels, hold } => levels[((t + 1e-9) / hold) as usize % levels.len()],
        }
    }
}
