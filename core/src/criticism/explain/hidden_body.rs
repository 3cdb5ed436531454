//! Effects that bring a second body, whose motion is not measured.

use crate::effect::{Dimension, Effect};

/// The place of the inertia of a second body, whose motion is not measured, among the values of an effect that brings
/// one.
pub(super) fn hidden_inertia(effect: &dyn Effect) -> Option<usize> {
    let mut parameters = effect.parameters().iter();
    parameters.position(|p| p.dimension == Dimension::Inertia)
}

/// Whether an effect brings a second body.
pub(super) fn is_hidden_body(effect: &dyn Effect) -> bool {
    hidden_inertia(effect).is_some()
}
