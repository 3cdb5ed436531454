//! What a person at a rig sets to carry out a proposed experiment.

use hysteron_core::diagnosis::{NextExperiment, Program};
use hysteron_core::rig::Proposed;

/// What the proposal says, as far as the rigs can do it.
pub fn of(proposal: &NextExperiment) -> Proposed {
    match &proposal.program {
        Program::Relay {
            gains,
            hold,
            hysteresis,
            ..
        } => Proposed::TwoGains {
            gains: gains.as_slice().try_into().expect("two gains"),
            hold: *hold,
            hysteresis: *hysteresis,
        },
        Program::Levels { levels, hold } => Proposed::Levels {
            levels: levels.as_slice().try_into().expect("sixteen levels"),
            hold: *hold,
        },
        Program::Multisine { .. } => panic!("no sines at these rigs: {}", proposal.text),
    }
}
