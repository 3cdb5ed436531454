//! The drive and its controller.

use serde::{Deserialize, Serialize};

use crate::message::{Message, says};
use crate::msg;

/// Dry friction that falls from its level at rest (Stribeck 1902): `coulomb + excess exp(-(v/stribeck_speed)^2)`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Friction {
    /// Level while it moves fast, N m (or N); at least 0.
    pub coulomb: f64,
    /// By how much it is higher at rest; at least 0.
    pub excess: f64,
    /// Speed at which that has fallen to 1/e, rad/s (or m/s); above 0. 0: it is there at rest only.
    pub stribeck_speed: f64,
}

/// Cogging `amplitude sin(per_rad x)` against the motion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Cogging {
    /// N m (or N); at least 0.
    pub amplitude: f64,
    /// Periods of it in one turn of 2 pi rad (or in 2 pi m); above 0.
    pub per_turn: f64,
}

/// `u = P (r - w) + I int (r - w) dt - D v`, `w` the position behind the play, `v` the velocity of the motor.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Controller {
    /// N m/rad (or N/m); above 0.
    pub proportional: f64,
    /// N m/(rad s) (or N/(m s)); at least 0.
    #[serde(default)]
    pub integral: f64,
    /// N m s/rad (or N s/m); at least 0.
    #[serde(default)]
    pub derivative: f64,
    /// Largest output in either direction, N m (or N); above 0. `None`: there is none.
    pub limit: Option<f64>,
    /// Time constant with which the integral is led back while the output is limited (back-calculation, Åström and
    /// Hägglund 2006), s; above 0. `None`: it winds up.
    pub tracking_time: Option<f64>,
}

/// `J dv/dt = u - viscous v - friction - cogging`, under a controller of the position.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Servo {
    /// Inertia `J`, kg m^2 (or kg); above 0.
    pub inertia: f64,
    /// Viscous friction, N m s/rad (or N s/m); at least 0.
    #[serde(default)]
    pub viscous: f64,
    /// Dry friction.
    #[serde(default)]
    pub friction: Friction,
    /// Cogging.
    pub cogging: Option<Cogging>,
    /// Half of the play between the motor and what is measured, rad (or m); at least 0. What is behind it has no
    /// inertia and stays where it is until it is taken along.
    #[serde(default)]
    pub half_gap: f64,
    /// The controller.
    pub controller: Controller,
    /// Where it shall be, rad (or m), from a start at rest at 0.
    pub reference: f64,
}

/// What of a servo cannot be.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub struct ServoError {
    pub(super) name: &'static str,
    pub(super) value: f64,
    pub(super) range: &'static str,
}

impl ServoError {
    /// In words.
    pub fn message(&self) -> Message {
        msg!(
            "{} is {}: it must be {}",
            &self.name,
            &self.value,
            &self.range
        )
    }
}

says!(ServoError);

impl Friction {
    /// Level at a velocity other than 0.
    pub fn moving(&self, v: f64) -> f64 {
        if self.excess == 0.0 || self.stribeck_speed == 0.0 {
            return self.coulomb;
        }
        let ratio = v / self.stribeck_speed;
        self.coulomb + self.excess * libm::exp(-ratio * ratio)
    }

    /// Level at rest.
    pub fn breakaway(&self) -> f64 {
        self.coulomb + self.excess
    }
}

impl Servo {
    /// Checks every value.
    ///
    /// # Errors
    /// The first one out of its range.
    pub fn validate(&self) -> Result<(), ServoError> {
        let check = |name, value: f64, fits: bool, range| {
            (value.is_finite() && fits)
                .then_some(())
                .ok_or(ServoError { name, value, range })
        };
        let c = &self.controller;
        for (name, value) in [("inertia", self.inertia), ("proportional", c.proportional)] {
            check(name, value, value > 0.0, "above 0")?;
        }
        for (name, value) in [
            ("viscous", self.viscous),
            ("coulomb", self.friction.coulomb),
            ("excess", self.friction.excess),
            ("stribeck_speed", self.friction.stribeck_speed),
            ("half_gap", self.half_gap),
            ("integral", c.integral),
            ("derivative", c.derivative),
        ] {
            check(name, value, value >= 0.0, "0 or more")?;
        }
        check("reference", self.reference, true, "a number")?;
        if let Some(cogging) = self.cogging {
            check(
                "amplitude of the cogging",
                cogging.amplitude,
                cogging.amplitude >= 0.0,
                "0 or more",
            )?;
            check(
                "per_turn",
                cogging.per_turn,
                cogging.per_turn > 0.0,
                "above 0",
            )?;
        }
        for (name, value) in [("limit", c.limit), ("tracking_time", c.tracking_time)] {
            if let Some(value) = value {
                check(name, value, value > 0.0, "above 0")?;
            }
        }
        Ok(())
    }

    /// Cogging at a position.
    pub(super) fn cogging(&self, x: f64) -> f64 {
        self.cogging
            .map_or(0.0, |c| c.amplitude * libm::sin(c.per_turn * x))
    }

    /// The controller's output before its limit.
    pub(super) fn asked(&self, w: f64, v: f64, integral: f64) -> f64 {
        let c = &self.controller;
        c.proportional * (self.reference - w) + integral - c.derivative * v
    }

    /// The same within its limit.
    pub(super) fn limited(&self, u: f64) -> f64 {
        let limit = self.controller.limit.unwrap_or(f64::INFINITY);
        u.clamp(-limit, limit)
    }

    /// How the integral changes, N m/s (or N/s).
    pub(super) fn integral_rate(&self, w: f64, v: f64, integral: f64) -> f64 {
        let asked = self.asked(w, v, integral);
        let back = match self.controller.tracking_time {
            Some(time) if self.controller.integral > 0.0 => (self.limited(asked) - asked) / time,
            _ => 0.0,
        };
        self.controller.integral * (self.reference - w) + back
    }

    /// A time in which it moves, s: of the loop without friction, play and limit.
    pub(super) fn typical_time(&self) -> f64 {
        let c = &self.controller;
        (self.inertia / c.proportional).sqrt()
    }
}
