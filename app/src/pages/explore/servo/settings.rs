//! What is set of a drive and the controller of its position.

use hysteron_core::hunting::{Cogging, Controller, Friction, Servo};
use hysteron_core::message::Message;
use hysteron_core::msg;
use serde::{Deserialize, Serialize};

/// Degrees in a radian: values are kept in rad, and shown so.
pub const DEGREES: f64 = 180.0 / std::f64::consts::PI;

/// What is set, in SI units; 0 where there is none. See [`Servo`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Settings {
    pub inertia: f64,
    pub viscous: f64,
    pub coulomb: f64,
    pub excess: f64,
    pub stribeck_speed: f64,
    pub cogging: f64,
    pub per_turn: f64,
    pub half_gap: f64,
    pub proportional: f64,
    pub integral: f64,
    pub derivative: f64,
    pub limit: f64,
    pub tracking_time: f64,
    pub reference: f64,
}

/// A servo that hunts.
impl Default for Settings {
    fn default() -> Self {
        Self {
            inertia: 1e-3,
            viscous: 0.0,
            coulomb: 0.04,
            excess: 0.12,
            stribeck_speed: 0.4,
            cogging: 0.0,
            per_turn: 12.0,
            half_gap: 0.0,
            proportional: 1.6,
            integral: 8.0,
            derivative: 0.014,
            limit: 1.0,
            tracking_time: 0.2,
            reference: 0.5,
        }
    }
}

impl Settings {
    /// The servo that is set.
    pub fn servo(&self) -> Servo {
        let given = |value: f64| (value > 0.0).then_some(value);
        Servo {
            inertia: self.inertia,
            viscous: self.viscous,
            friction: Friction {
                coulomb: self.coulomb,
                excess: self.excess,
                stribeck_speed: self.stribeck_speed,
            },
            cogging: given(self.cogging).map(|amplitude| Cogging {
                amplitude,
                per_turn: self.per_turn,
            }),
            half_gap: self.half_gap,
            controller: Controller {
                proportional: self.proportional,
                integral: self.integral,
                derivative: self.derivative,
                limit: given(self.limit),
                tracking_time: given(self.tracking_time),
            },
            reference: self.reference,
        }
    }

    /// What stands for a servo.
    pub fn of(servo: &Servo) -> Self {
        let c = &servo.controller;
        Self {
            inertia: servo.inertia,
            viscous: servo.viscous,
            coulomb: servo.friction.coulomb,
            excess: servo.friction.excess,
            stribeck_speed: servo.friction.stribeck_speed,
            cogging: servo.cogging.map_or(0.0, |c| c.amplitude),
            per_turn: servo
                .cogging
                .map_or_else(|| Self::default().per_turn, |c| c.per_turn),
            half_gap: servo.half_gap,
            proportional: c.proportional,
            integral: c.integral,
            derivative: c.derivative,
            limit: c.limit.unwrap_or(0.0),
            tracking_time: c.tracking_time.unwrap_or(0.0),
            reference: servo.reference,
        }
    }

    /// Checks it.
    ///
    /// # Errors
    /// One sentence.
    pub fn check(&self) -> Result<(), Message> {
        let optional = [self.cogging, self.per_turn, self.limit, self.tracking_time];
        if optional.iter().any(|v| !v.is_finite() || *v < 0.0) {
            return Err("This servo is not possible: a value is below 0.".into());
        }
        let checked = self.servo().validate();
        checked.map_err(|e| msg!("This servo is not possible: {}.", e))
    }
}
