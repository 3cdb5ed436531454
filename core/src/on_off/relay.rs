//! The controller: two or three positions, and what keeps it from switching at once.

use serde::{Deserialize, Serialize};

use crate::message::Message;
use crate::msg;
use crate::relay::{Relay, RelayError};

/// What the controller asks of its actuator.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Position {
    /// Pushes the output up: heating.
    Up,
    /// Neither; only with a dead zone.
    Off,
    /// Pushes the output down: cooling, or off where there are two positions only.
    Down,
}

impl Position {
    /// How it is called.
    pub fn name(self) -> &'static str {
        match self {
            Self::Up => "up",
            Self::Off => "off",
            Self::Down => "down",
        }
    }

    /// That it lasts so long.
    pub fn lasting(self, time: String) -> Message {
        match self {
            Self::Up => msg!("up {}", time),
            Self::Off => msg!("off {}", time),
            Self::Down => msg!("down {}", time),
        }
    }
}

/// An on-off controller in negative feedback. It sees the distance `e = y - reference` and has
///
/// - two positions without a dead zone: down when `e` rises through `+hysteresis`, up when it falls through `-hysteresis`;
/// - three with a dead zone `d`: up or down when `e` leaves `d + hysteresis`, off when it is back within `d - hysteresis`
///   (Tsypkin 1984).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct OnOffRelay {
    /// Outputs, hysteresis and delay: up is `k (1 + a) + bias`, down `-k (1 - a) + bias`, off `bias`.
    pub relay: Relay,
    /// What the output should be, in its unit.
    pub reference: f64,
    /// Half the width of the zone in which it is off, in the unit of the output; at least 0, which has no such zone.
    pub dead_zone: f64,
    /// Shortest time for which it stays up (and down, where there are three positions), s; at least 0.
    pub min_on: f64,
    /// Shortest time for which it stays off (down, where there are two positions), s; at least 0.
    pub min_off: f64,
    /// It sees the output at multiples of this time only, s; above 0. `None`: all the time.
    pub sampling: Option<f64>,
}

impl OnOffRelay {
    /// Checks every value.
    ///
    /// # Errors
    /// The first one out of its range.
    pub fn validate(&self) -> Result<(), RelayError> {
        self.relay.validate()?;
        let check = |name, value: f64, fits: bool, range| {
            (value.is_finite() && fits)
                .then_some(())
                .ok_or(RelayError { name, value, range })
        };
        let at_least_0 = [
            ("dead zone", self.dead_zone, "0 or more"),
            ("min_on", self.min_on, "0 s or more"),
            ("min_off", self.min_off, "0 s or more"),
        ];
        check("reference", self.reference, true, "a number")?;
        for (name, value, range) in at_least_0 {
            check(name, value, value >= 0.0, range)?;
        }
        self.sampling
            .map_or(Ok(()), |t| check("sampling", t, t > 0.0, "above 0 s"))
    }

    /// Whether it has a dead zone.
    pub fn has_three_positions(&self) -> bool {
        self.dead_zone > 0.0
    }

    /// Output in a position, in the unit of the input.
    pub fn output(&self, position: Position) -> f64 {
        match position {
            Position::Up => self.relay.output(false),
            Position::Off => self.relay.bias,
            Position::Down => self.relay.output(true),
        }
    }

    /// Shortest time in a position, s.
    pub fn hold(&self, position: Position) -> f64 {
        match position {
            Position::Up => self.min_on,
            Position::Down if self.has_three_positions() => self.min_on,
            Position::Off | Position::Down => self.min_off,
        }
    }

    /// Outputs of the plant between which it stays in a position.
    pub fn guards(&self, position: Position) -> [f64; 2] {
        let (near, far) = (
            self.dead_zone - self.relay.hysteresis,
            self.dead_zone + self.relay.hysteresis,
        );
        let [low, high] = match position {
            Position::Up => [f64::NEG_INFINITY, -near],
            Position::Off => [-far, far],
            Position::Down => [near, f64::INFINITY],
        };
        [self.reference + low, self.reference + high]
    }

    /// The next position after the plant's output has left the guards upwards or downwards; `output` may be further
    /// out.
    pub fn next(&self, position: Position, upwards: bool, output: f64) -> Position {
        let outward = if upwards {
            Position::Down
        } else {
            Position::Up
        };
        if position == Position::Off || !self.has_three_positions() {
            return outward;
        }
        let [low, high] = self.guards(Position::Off);
        // At its own threshold it may lie beyond it by round-off.
        let beyond = if upwards { output > high } else { output < low };
        if beyond { outward } else { Position::Off }
    }

    /// What it wants to switch to at this output of the plant, if anything.
    pub fn wanted(&self, position: Position, output: f64) -> Option<Position> {
        let [low, high] = self.guards(position);
        let upwards = output > high;
        (upwards || output < low).then(|| self.next(position, upwards, output))
    }

    /// The position that it takes at first, as if it had been off before (down, where there are two positions).
    pub fn first(&self, output: f64) -> Position {
        let off = if self.has_three_positions() {
            Position::Off
        } else if output > self.guards(Position::Up)[1] {
            Position::Down
        } else {
            Position::Up
        };
        self.wanted(off, output).unwrap_or(off)
    }
}
