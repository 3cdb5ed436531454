//! What the registry knows, by name.

use serde::{Deserialize, Deserializer, de};

use super::effect::Effect;
use super::id::{EffectId, VISCOUS_FRICTION};
use super::{library, registry};
use crate::measurement::Kind;

impl EffectId {
    /// Names that an effect of one's own may have.
    pub const OWN_NAMES: &'static str =
        "lower-case letters, digits and _, at most 24, a letter first, not a name from the library";

    /// The id of a user's own effect: small letters, digits and `_`, at most 24, a letter first, and not the
    /// name of an effect of the library. The name is kept as long as the program runs.
    pub fn own(name: &str) -> Option<Self> {
        let good = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
        let fits = (1..=24).contains(&name.len())
            && name.starts_with(|c: char| c.is_ascii_lowercase())
            && name.chars().all(good);
        (fits && Self::parse(name).is_none()).then(|| Self::new(name.to_owned().leak()))
    }

    /// The registered id with this text.
    pub fn parse(text: &str) -> Option<Self> {
        if text == VISCOUS_FRICTION.as_str() {
            return Some(VISCOUS_FRICTION);
        }
        library().map(Effect::id).find(|id| id.as_str() == text)
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

/// The effect with this id.
pub fn find(id: EffectId) -> Option<&'static dyn Effect> {
    library().find(|e| e.id() == id)
}

/// The name of the effect with this id on screen; that of an unknown one, such as a user's own, is its id.
pub fn name_of(id: EffectId) -> &'static str {
    if id == VISCOUS_FRICTION {
        return "Viscous friction";
    }
    find(id).map_or(id.as_str(), Effect::name)
}

/// Whether the effect with this id tells how the record was made ([`Effect::is_of_record`]).
pub fn is_of_record(id: EffectId) -> bool {
    find(id).is_some_and(Effect::is_of_record)
}

/// The effects that make sense for this kind of system.
pub fn for_kind(kind: Kind) -> impl Iterator<Item = &'static dyn Effect> {
    registry()
        .iter()
        .copied()
        .filter(move |e| e.kinds().contains(&kind))
}
