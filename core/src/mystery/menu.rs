//! What the bench can hide, how strongly, and which experiments show it.

use super::Experiment::{self, Relay, Sines, Stairs};
use super::{Hidden, MysteryError};
use crate::effect::{Effect, EffectId, Motion, find, name_of};
use crate::rig::{DriveRig, Friction, Load, Random};

/// A strength by name.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Strength {
    /// Above the noise by a few times.
    Small,
    /// Between both.
    #[default]
    Medium,
    /// What nobody overlooks.
    Large,
}

impl Strength {
    /// All of them, the weakest first.
    pub const ALL: [Self; 3] = [Self::Small, Self::Medium, Self::Large];
}

/// Puts an effect with its main parameter into the bench; gives its parameters as the library has them.
type Hide = fn(f64, &mut DriveRig, &mut Random) -> Vec<(&'static str, f64)>;

/// An effect that the bench can hide.
pub struct Hideable {
    /// Its name in the library.
    pub id: EffectId,
    /// Its main parameter that small, medium and large values are given of, SI.
    strengths: [f64; 3],
    /// Smallest and largest value that can be typed, SI.
    pub range: [f64; 2],
    /// Experiments in which it can be told from the others.
    pub shown_by: &'static [Experiment],
    /// Two of one family act too much alike, or in one place, to be hidden together.
    family: Family,
    hide: Hide,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Family {
    Friction,
    Drag,
    Lateness,
    Offset,
    Ripple,
    Amplifier,
    Load,
}

impl Hideable {
    /// The effect of the library.
    pub fn effect(&self) -> Option<&'static dyn Effect> {
        find(self.id)
    }

    /// Its name on screen.
    pub fn name(&self) -> &'static str {
        name_of(self.id)
    }

    /// Symbol, name and SI unit of the main parameter.
    pub fn parameter(&self) -> (&'static str, &'static str, &'static str) {
        let first = self.effect().and_then(|e| e.parameters().first());
        first.map_or(("", "", "1"), |p| {
            (p.symbol, p.label, p.dimension.unit(Motion::Rotational))
        })
    }

    /// Value of the main parameter at a strength, SI.
    pub fn value(&self, strength: Strength) -> f64 {
        let [small, medium, large] = self.strengths;
        match strength {
            Strength::Small => small,
            Strength::Medium => medium,
            Strength::Large => large,
        }
    }

    /// Any value between small and large.
    pub(super) fn draw(&self, random: &mut Random) -> f64 {
        let [small, _, large] = self.strengths;
        random.between(small, large)
    }

    /// Whether the bench can hide both.
    pub fn goes_with(&self, other: &Self) -> bool {
        self.family != other.family
    }

    /// Hides it.
    pub(super) fn hide(
        &self,
        value: f64,
        rig: &mut DriveRig,
        random: &mut Random,
    ) -> Result<Hidden, MysteryError> {
        let [least, most] = self.range;
        let (symbol, _, unit) = self.parameter();
        if !(least..=most).contains(&value.abs()) {
            return Err(MysteryError::Strength {
                effect: self.name(),
                symbol,
                least,
                most,
                unit,
            });
        }
        let parameters = (self.hide)(value, rig, random);
        Ok(Hidden {
            effect: self.id,
            parameters: parameters
                .into_iter()
                .map(|(symbol, value)| (symbol.to_owned(), value))
                .collect(),
        })
    }
}

/// Everything that can be hidden, in the order of the menu.
pub fn hideable() -> &'static [Hideable] {
    MENU
}

/// A gap is not among them: a diagnosis does not find every one, and it takes long.
const MENU: &[Hideable] = &[
    Hideable {
        id: EffectId::new("coulomb_friction"),
        strengths: [0.02, 0.035, 0.05],
        range: [5e-3, 0.12],
        // Under a relay the drive runs at one speed: dry and viscous friction are the same there.
        shown_by: &[Sines, Stairs],
        family: Family::Friction,
        hide: |c, rig, _| {
            rig.friction = Friction::dry(c);
            vec![("c", c)]
        },
    },
    Hideable {
        id: EffectId::new("stribeck_friction"),
        strengths: [0.02, 0.027, 0.035],
        range: [0.01, 0.06],
        shown_by: &[Sines],
        family: Family::Friction,
        hide: |c, rig, random| {
            rig.friction = Friction {
                coulomb: c,
                standing: random.between(2.0, 2.6) * c,
                stribeck_velocity: random.between(0.6, 1.5),
                displacement: 2e-5,
            };
            let Friction {
                standing,
                stribeck_velocity,
                ..
            } = rig.friction;
            vec![("c", c), ("dc", standing - c), ("v_s", stribeck_velocity)]
        },
    },
    Hideable {
        id: EffectId::new("presliding_friction"),
        strengths: [0.04, 0.05, 0.06],
        range: [0.02, 0.1],
        shown_by: &[Sines, Stairs],
        family: Family::Friction,
        hide: |c, rig, random| {
            // The bristle yields over milliradians, as in a preloaded bearing.
            let displacement = random.between(2e-3, 5e-3);
            rig.friction = Friction {
                displacement,
                ..Friction::dry(c)
            };
            vec![("c", c), ("s", displacement)]
        },
    },
    Hideable {
        id: EffectId::new("quadratic_drag"),
        strengths: [4e-5, 6e-5, 8e-5],
        range: [1e-5, 3e-4],
        shown_by: &[Sines, Stairs],
        family: Family::Drag,
        hide: |q, rig, _| {
            rig.quadratic_drag = q;
            vec![("q", q)]
        },
    },
    Hideable {
        id: EffectId::new("joint_compliance"),
        strengths: [30.0, 20.0, 10.0],
        range: [5.0, 60.0],
        shown_by: &[Sines],
        family: Family::Load,
        hide: |stiffness, rig, random| {
            // A load like the motor.
            let load = Load {
                half_gap: 0.0,
                stiffness,
                damping: random.between(0.0, 2e-3),
                inertia: 8.8e-4,
                viscous: 2e-3,
                coulomb: 0.0,
            };
            rig.load = Some(load);
            vec![("K", stiffness), ("J2", load.inertia)]
        },
    },
    Hideable {
        id: EffectId::new("input_delay"),
        strengths: [4e-4, 7.5e-4, 1.1e-3],
        range: [2e-4, 3e-3],
        shown_by: &[Relay, Sines],
        family: Family::Lateness,
        hide: |tau, rig, _| {
            // In whole steps of the bench, so that it is met exactly.
            rig.delay = (tau / 1e-5).round() * 1e-5;
            vec![("tau", rig.delay)]
        },
    },
    Hideable {
        id: EffectId::new("actuator_lag"),
        strengths: [5e-4, 8.5e-4, 1.2e-3],
        range: [3e-4, 4e-3],
        shown_by: &[Relay, Stairs],
        family: Family::Lateness,
        hide: |time, rig, _| {
            rig.actuator_lag = time;
            vec![("T_a", time)]
        },
    },
    Hideable {
        id: EffectId::new("sensor_lag"),
        strengths: [5e-4, 8e-4, 1.1e-3],
        range: [3e-4, 4e-3],
        shown_by: &[Sines],
        family: Family::Lateness,
        hide: |time, rig, _| {
            rig.sensor_lag = time;
            vec![("T_s", time)]
        },
    },
    Hideable {
        id: EffectId::new("gain_asymmetry"),
        strengths: [0.03, 0.055, 0.08],
        range: [0.01, 0.3],
        shown_by: &[Stairs, Relay],
        family: Family::Offset,
        hide: |a, rig, _| {
            rig.gain_asymmetry = a;
            vec![("a", a)]
        },
    },
    Hideable {
        id: EffectId::new("constant_load"),
        strengths: [0.01, 0.02, 0.03],
        range: [5e-3, 0.06],
        shown_by: &[Stairs, Sines, Relay],
        family: Family::Offset,
        hide: |torque, rig, _| {
            rig.constant_load = torque;
            vec![("F0", torque)]
        },
    },
    Hideable {
        id: EffectId::new("cogging"),
        strengths: [0.02, 0.035, 0.05],
        range: [0.01, 0.1],
        shown_by: &[Sines, Stairs],
        family: Family::Ripple,
        hide: |amplitude, rig, random| {
            let periods = random.between(3.0, 12.0).round();
            rig.cogging = (amplitude, periods, random.between(-3.0, 3.0));
            vec![("a", amplitude), ("n", periods)]
        },
    },
    Hideable {
        id: EffectId::new("saturation"),
        strengths: [0.4, 0.35, 0.3],
        range: [0.2, 0.6],
        shown_by: &[Sines],
        family: Family::Amplifier,
        hide: |limit, rig, _| {
            rig.saturation = limit;
            vec![("M", limit)]
        },
    },
    Hideable {
        id: EffectId::new("dead_zone"),
        strengths: [0.015, 0.022, 0.03],
        range: [8e-3, 0.08],
        shown_by: &[Sines, Stairs],
        family: Family::Amplifier,
        hide: |width, rig, _| {
            rig.dead_zone = width;
            vec![("z", width)]
        },
    },
];
