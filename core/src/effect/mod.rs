//! Which physics can be added? One file per effect, one line in [`registry`].

mod id;
mod spec;

pub use id::EffectId;
pub use spec::{Dimension, Motion, ParameterSpec};

use crate::measurement::Kind;

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
}

/// Every effect in the library.
pub fn registry() -> &'static [&'static dyn Effect] {
    &[]
}

/// The effect with this id.
pub fn find(id: EffectId) -> Option<&'static dyn Effect> {
    registry().iter().copied().find(|e| e.id() == id)
}
