//! A program as what drives an experiment sample by sample.

use std::f64::consts::TAU;

use crate::diagnosis::Program;

/// What kind of program it is: of each kind one is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Shape {
    Relay,
    AsymmetricRelay,
    ChangingRelay,
    Levels,
    TwoLevels,
    Multisine,
}

impl Program {
    pub(super) fn shape(&self) -> Shape {
        match self {
            Self::Relay { gains, .. } if gains.len() > 1 => Shape::ChangingRelay,
            Self::Relay { asymmetry, .. } if *asymmetry != 0.0 => Shape::AsymmetricRelay,
            Self::Relay { .. } => Shape::Relay,
            Self::Levels { levels, .. } if levels.iter().all(|u| u.abs() == levels[0].abs()) => {
                Shape::TwoLevels
            }
            Self::Levels { .. } => Shape::Levels,
            Self::Multisine { .. } => Shape::Multisine,
        }
    }

    /// The controller, before its first sample.
    pub fn controller(&self) -> Controller<'_> {
        Controller {
            program: self,
            high: false,
        }
    }

    /// Time after which it has shown all that it does, s; 0 where that depends on the plant.
    pub fn cycle(&self) -> f64 {
        match self {
            Self::Relay { gains, hold, .. } if gains.len() > 1 => hold * gains.len() as f64,
            Self::Relay { .. } => 0.0,
            Self::Levels { levels, hold } => hold * levels.len() as f64,
            Self::Multisine { sines } => {
                sines.iter().map(|s| 1.0 / s.frequency).fold(0.0, f64::max)
            }
        }
    }

    /// The same with every size of the input multiplied by `factor`.
    #[must_use]
    pub(super) fn scaled(&self, factor: f64) -> Self {
        let mut scaled = self.clone();
        match &mut scaled {
            Self::Relay { gains, .. } => gains.iter_mut().for_each(|k| *k *= factor),
            Self::Levels { levels, .. } => levels.iter_mut().for_each(|u| *u *= factor),
            Self::Multisine { sines } => sines.iter_mut().for_each(|s| s.amplitude *= factor),
        }
        scaled
    }
}

/// A program under way.
#[derive(Clone, Debug)]
pub struct Controller<'a> {
    program: &'a Program,
    high: bool,
}

impl Controller<'_> {
    /// Input at `time` (s) where the velocity, or the output of a process, is `seen`.
    pub fn command(&mut self, time: f64, seen: f64) -> f64 {
        // A sample on the edge of a step belongs to the new one, whatever the rounding.
        let turn = |hold: f64| (time / hold + 1e-9) as usize;
        match self.program {
            Program::Relay {
                gains,
                hold,
                hysteresis,
                asymmetry,
            } => {
                if seen > *hysteresis {
                    self.high = true;
                } else if seen < -*hysteresis {
                    self.high = false;
                }
                let gain = match gains.as_slice() {
                    [gain] => *gain,
                    [] => 0.0,
                    gains => gains[turn(*hold) % gains.len()],
                };
                if self.high {
                    -gain * (1.0 - asymmetry)
                } else {
                    gain * (1.0 + asymmetry)
                }
            }
            Program::Levels { levels, hold } => {
                if levels.is_empty() {
                    return 0.0;
                }
                levels[turn(*hold) % levels.len()]
            }
            Program::Multisine { sines } => sines
                .iter()
                .map(|s| s.amplitude * libm::sin(TAU * s.frequency * time + s.phase))
                .sum(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_relay_switches_at_its_hysteresis_and_changes_its_gain() {
        let program = Program::Relay {
            gains: vec![1.0, 0.5],
            hold: 2.0,
            hysteresis: 0.1,
            asymmetry: 0.0,
        };
        let mut relay = program.controller();
        let seen = [0.0, 0.2, 0.05, -0.2, 0.0];
        let commands: Vec<f64> = seen
            .iter()
            .enumerate()
            .map(|(i, y)| relay.command(i as f64, *y))
            .collect();
        assert_eq!(commands, [1.0, -1.0, -0.5, 0.5, 1.0]);
    }
}
