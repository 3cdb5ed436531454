//! The loop as a second judge: where a relay made the input from the output, a model must make the same cycle in its
//! place.
//!
//! A window of a record is restarted from measured states, so that what changes the motion little within it hardly
//! shows. In the loop each half cycle begins where the one before ended, and such an error adds up to another period
//! and amplitude.

mod rule;
mod run;
mod tuning;

use super::data::Data;
use crate::diagnosis::LoopError;
use crate::model::{Model, Sensor};
use rule::Rule;
use run::{Begin, Cycle, Sight, run};
use tuning::{MAKES, MOST_SAMPLES};

/// A relay loop that was measured.
#[derive(Clone, Copy, Debug)]
pub(super) struct RelayLoop {
    rule: Rule,
    begin: Begin,
    cycle: Cycle,
}

impl RelayLoop {
    /// The loop in which a record was made; `None` where it was another one, or open.
    pub fn of(data: &Data) -> Option<Self> {
        if data.pauses > 0 {
            return None;
        }
        let samples = data.len().min(MOST_SAMPLES);
        let input = &data.input[..samples];
        let signals: Vec<&[f64]> = data.outputs.iter().map(|o| &o.values[..samples]).collect();
        let (rule, place) = Rule::read(input, &signals)?;
        let start = *data.guessed_starts().first()?;
        let has_velocity = data.outputs.iter().any(|o| o.is_velocity);
        Some(Self {
            rule,
            begin: Begin {
                step: data.excitation.mean_step(),
                samples,
                position: start.position,
                velocity: start.velocity,
                input: input[0],
                sees_velocity: data.outputs[place].is_velocity,
                sight: Sight::of(&data.outputs[place]),
                sensor: if has_velocity {
                    Sensor::Velocity
                } else {
                    Sensor::Position
                },
            },
            cycle: Cycle::of(input, signals[place])?,
        })
    }

    /// By how much the cycle of a model in this loop is off.
    pub fn error_of(&self, model: &Model) -> LoopError {
        let (input, signal) = run(model, &self.rule, &self.begin);
        let ratio = |own: f64, measured: f64| own / measured - 1.0;
        match Cycle::of(&input, &signal) {
            Some(cycle) => LoopError {
                period: Some(ratio(cycle.period, self.cycle.period)),
                amplitude: Some(ratio(cycle.amplitude, self.cycle.amplitude)),
            },
            None => LoopError::default(),
        }
    }
}

/// Whether a model with this error makes the cycle that was measured.
pub(super) fn makes_cycle(error: LoopError) -> bool {
    let small = |share: Option<f64>| share.is_some_and(|share| share.abs() <= MAKES);
    small(error.period) && small(error.amplitude)
}
