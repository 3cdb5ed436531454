//! What could stand in the place of an effect of the best model.

use crate::effect::Effect;

/// An effect that could stand in the place of one in the best model.
#[derive(Clone)]
pub(in crate::criticism) struct Rival {
    /// Place of the one that it replaces among the effects of the best model.
    pub place: usize,
    pub effect: &'static dyn Effect,
    pub trial: usize,
}
