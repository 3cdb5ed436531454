//! Names of effects.

use std::fmt;

use serde::{Serialize, Serializer};

/// Name of an effect, as used in files, JSON and links.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct EffectId(&'static str);

/// Part of every baseline drive: it is fitted from the start, never searched for.
pub const VISCOUS_FRICTION: EffectId = EffectId("viscous_friction");

impl EffectId {
    /// An id for a new effect file; must be unique in the registry.
    pub const fn new(id: &'static str) -> Self {
        Self(id)
    }

    /// The id as text, such as `coulomb_friction`.
    pub const fn as_str(self) -> &'static str {
        self.0
    }
}

impl fmt::Display for EffectId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.0)
    }
}

impl Serialize for EffectId {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.0)
    }
}
