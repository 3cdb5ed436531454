//! An effect that the bench can hide.

use super::bench::Bench;
use super::{Experiment, Hidden, MysteryError};
use crate::effect::{Effect, EffectId, find, name_of};
use crate::measurement::Motion;
use crate::rig::process::ProcessRig;
use crate::rig::{DriveRig, Random};

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

/// Parameters as the library has them, the main one first.
pub(super) type Parameters = Vec<(&'static str, f64)>;

/// Puts an effect with its main parameter into the bench.
#[derive(Clone, Copy)]
pub(super) enum Hide {
    Drive(fn(f64, &mut DriveRig, &mut Random) -> Parameters),
    Process(fn(f64, &mut ProcessRig, &mut Random) -> Parameters),
}

/// An effect that the bench can hide.
pub struct Hideable {
    /// Its name in the library.
    pub id: EffectId,
    /// Symbol of its main parameter.
    pub(super) main: &'static str,
    /// Small, medium and large values of that, SI.
    pub(super) strengths: [f64; 3],
    /// Smallest and largest value that can be typed, SI.
    pub range: [f64; 2],
    /// Experiments in which it can be told from the others.
    pub shown_by: &'static [Experiment],
    /// Two of one family act too much alike, or in one place, to be hidden together.
    pub(super) families: &'static [Family],
    pub(super) hide: Hide,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Family {
    Friction,
    Drag,
    Lateness,
    Offset,
    Ripple,
    Amplifier,
    Load,
    Storage,
    /// The bench holds one of them at a time.
    Stranger,
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
        let motion = match self.hide {
            Hide::Drive(_) => Motion::Rotational,
            Hide::Process(_) => Motion::None,
        };
        let all = self.effect().map(Effect::parameters).unwrap_or_default();
        let main = all.iter().find(|p| p.symbol == self.main);
        main.map_or(("", "", "1"), |p| {
            (p.symbol, p.label, p.dimension.unit(motion))
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
        let part = |a: &Self, b: &Self| a.effect().is_some_and(|e| e.has_part(b.id));
        let apart = self.families.iter().all(|f| !other.families.contains(f));
        apart && !part(self, other) && !part(other, self)
    }

    /// Hides it.
    pub(super) fn hide(
        &self,
        value: f64,
        bench: &mut Bench,
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
        let parameters = match (self.hide, bench) {
            (Hide::Drive(hide), Bench::Drive(rig)) => hide(value, rig, random),
            (Hide::Process(hide), Bench::Process(rig)) => hide(value, rig, random),
            _ => return Err(MysteryError::UnknownEffect(self.id.to_string())),
        };
        Ok(Hidden {
            effect: self.id,
            parameters: parameters
                .into_iter()
                .map(|(symbol, value)| (symbol.to_owned(), value))
                .collect(),
        })
    }
}
