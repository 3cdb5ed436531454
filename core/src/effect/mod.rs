//! Which physics can be added? One file per effect, one line in [`registry`].

mod actuator_lag;
mod backlash;
mod constant_load;
mod coulomb_friction;
mod gain_asymmetry;
mod id;
mod input_delay;
mod second_lag;
mod spec;

pub use id::{EffectId, VISCOUS_FRICTION};
pub use spec::{Dimension, Motion, ParameterSpec, Range, Scales};

use crate::measurement::Kind;
use crate::model::Model;

/// A piece of physics that a user can add to a model.
pub trait Effect: Sync {
    /// Name in files, JSON and links.
    fn id(&self) -> EffectId;
    /// Name on screen, such as `Coulomb friction`.
    fn name(&self) -> &'static str;
    /// One sentence that a student understands.
    fn sentence(&self) -> &'static str;
    /// The equation as text.
    fn equation(&self) -> &'static str;
    /// Where the equation stands: author, year.
    fn source(&self) -> &'static str;
    /// The kinds of system that it makes sense for.
    fn kinds(&self) -> &'static [Kind];
    /// Its parameters, in the order in which every slice of values has them.
    fn parameters(&self) -> &'static [ParameterSpec];
    /// Values from which a fit may start, most likely first; several where the error has several valleys.
    fn starts(&self, scales: &Scales) -> Vec<Vec<f64>>;
    /// Puts the effect with these `values` into `model`.
    fn apply(&self, values: &[f64], model: &mut Model);
}

/// Every effect in the library, in the order in which equals are listed.
pub fn registry() -> &'static [&'static dyn Effect] {
    &[
        &coulomb_friction::CoulombFriction,
        &backlash::Backlash,
        &input_delay::InputDelay,
        &actuator_lag::ActuatorLag,
        &second_lag::SecondLag,
        &gain_asymmetry::GainAsymmetry,
        &constant_load::ConstantLoad,
    ]
}

/// The effect with this id.
pub fn find(id: EffectId) -> Option<&'static dyn Effect> {
    registry().iter().copied().find(|e| e.id() == id)
}

/// The effects that make sense for this kind of system.
pub fn for_kind(kind: Kind) -> impl Iterator<Item = &'static dyn Effect> {
    registry()
        .iter()
        .copied()
        .filter(move |e| e.kinds().contains(&kind))
}
