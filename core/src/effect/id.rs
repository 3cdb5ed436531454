//! Names of effects.

use std::fmt;

use serde::{Deserialize, Deserializer, Serialize, Serializer, de};

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

    /// Names that an effect of one's own may have.
    pub const OWN_NAMES: &'static str =
        "small letters, digits and _, at most 24, a letter first, and not a name of the library";

    /// The id of a user's own effect: small letters, digits and `_`, at most 24, a letter first, and not the
    /// name of an effect of the library. The name is kept as long as the program runs.
    pub fn own(name: &str) -> Option<Self> {
        let good = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
        let fits = (1..=24).contains(&name.len())
            && name.starts_with(|c: char| c.is_ascii_lowercase())
            && name.chars().all(good);
        (fits && Self::parse(name).is_none()).then(|| Self(name.to_owned().leak()))
    }

    /// The registered id with this text.
    pub fn parse(text: &str) -> Option<Self> {
        if text == VISCOUS_FRICTION.0 {
            return Some(VISCOUS_FRICTION);
        }
        super::library().map(|e| e.id()).find(|id| id.0 == text)
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

impl<'de> Deserialize<'de> for EffectId {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = String::deserialize(deserializer)?;
        Self::parse(&text)
            .or_else(|| Self::own(&text))
            .ok_or_else(|| de::Error::custom(format!("no effect is called '{text}'")))
    }
}
