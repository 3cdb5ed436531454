//! What a run of a drive leaves behind.

use serde::{Deserialize, Serialize};

/// Motor or load.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Mass {
    /// The driven side.
    Motor,
    /// The other side.
    Load,
}

/// An end of the gap.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Side {
    /// `x1 - x2 = +beta`: the motor pushes the load up.
    Upper,
    /// `x1 - x2 = -beta`: it pushes it down.
    Lower,
}

impl Side {
    /// +1 or -1.
    pub fn sign(self) -> f64 {
        match self {
            Self::Upper => 1.0,
            Self::Lower => -1.0,
        }
    }
}

/// What happens at an instant.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum EventKind {
    /// The relay's `h` becomes +1: the velocity has risen through `+eps`.
    SwitchUp,
    /// It becomes -1: the velocity has fallen through `-eps`.
    SwitchDown,
    /// The torque becomes this, N m (or N).
    Input(f64),
    /// The asymmetry changes its sign.
    Flip,
    /// A mass comes to rest and stays there.
    Stick(Mass),
    /// A mass passes through rest, or breaks away from it.
    Move(Mass),
    /// The masses hit each other with this relative speed, rad/s (or m/s), and part again.
    Impact(Side, f64),
    /// They begin to touch.
    Touch(Side),
    /// They part.
    Part(Side),
}

/// An event and the state right after it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Event {
    /// When, s.
    pub time: f64,
    /// What.
    pub kind: EventKind,
    /// Motor position, rad (or m).
    pub x1: f64,
    /// Motor velocity, rad/s (or m/s).
    pub v1: f64,
    /// Load position.
    pub x2: f64,
    /// Load velocity.
    pub v2: f64,
}

/// Where the energy of a run has gone, J.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Energy {
    /// Kinetic energy at the start.
    pub initial: f64,
    /// Work of the motor's torque.
    pub supplied: f64,
    /// Heat of Coulomb friction.
    pub coulomb: f64,
    /// Heat of viscous friction.
    pub viscous: f64,
    /// Lost in the contact: by impacts, by its damping, and by its spring when it parts.
    pub contact: f64,
    /// Kinetic energy at the end.
    pub kinetic: f64,
    /// Energy in the contact's spring at the end.
    pub elastic: f64,
}

impl Energy {
    /// What is missing from the balance: round-off.
    pub fn residual(&self) -> f64 {
        self.initial + self.supplied
            - self.coulomb
            - self.viscous
            - self.contact
            - self.kinetic
            - self.elastic
    }
}

/// A run of a drive: samples at equal steps, and every event.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct DriveRun {
    /// Times of the samples, s.
    pub time: Vec<f64>,
    /// Torque that acts from each sample on, N m (or N).
    pub input: Vec<f64>,
    /// Motor position, rad (or m).
    pub x1: Vec<f64>,
    /// Motor velocity, rad/s (or m/s).
    pub v1: Vec<f64>,
    /// Load position.
    pub x2: Vec<f64>,
    /// Load velocity.
    pub v2: Vec<f64>,
    /// Everything that happened, in order.
    pub events: Vec<Event>,
    /// Where the energy has gone.
    pub energy: Energy,
    /// When the run was cut because it switched without end, s.
    pub chattering: Option<f64>,
}

impl DriveRun {
    /// Switches of the relay.
    pub fn switches(&self) -> usize {
        let is_switch = |e: &&Event| matches!(e.kind, EventKind::SwitchUp | EventKind::SwitchDown);
        self.events.iter().filter(is_switch).count()
    }

    /// Impacts and beginnings of contact.
    pub fn impacts(&self) -> usize {
        let is_impact = |e: &&Event| matches!(e.kind, EventKind::Impact(..) | EventKind::Touch(_));
        self.events.iter().filter(is_impact).count()
    }
}
