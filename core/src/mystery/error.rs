//! What can be wrong with a mystery.

use crate::message::{Message, says};
use crate::msg;

/// Fewest characters of a word.
pub const SHORTEST_WORD: usize = 6;

/// Why a mystery cannot be made, read or revealed; each is one sentence.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MysteryError {
    /// A word that anybody could guess.
    ShortWord {
        /// Its length in characters.
        found: usize,
    },
    /// The word is another one, or the seal was changed.
    WrongWord,
    /// A seal that is not one.
    BadSeal,
    /// A text that stands for no mystery.
    BadLink(&'static str),
    /// An effect that the bench cannot hide.
    UnknownEffect(String),
    /// A strength that the bench cannot have.
    Strength {
        /// Name of the effect.
        effect: &'static str,
        /// Its main parameter.
        symbol: &'static str,
        /// Smallest value in `unit`.
        least: f64,
        /// Largest value in `unit`.
        most: f64,
        /// SI unit.
        unit: &'static str,
    },
    /// Effects that the bench cannot have together.
    Together(&'static str, &'static str),
    /// More than a diagnosis can be asked to find.
    TooMany(usize),
    /// The cipher refused, which it does for texts beyond all size only.
    Cipher,
}

impl MysteryError {
    /// In words.
    pub fn message(&self) -> Message {
        match self {
            Self::ShortWord { found } => msg!(
                "The password is too short ({}): it needs at least {} characters.",
                found,
                SHORTEST_WORD
            ),
            Self::WrongWord => "This password does not open the seal.".into(),
            Self::BadSeal => "The sealed truth of this file is damaged.".into(),
            Self::BadLink(given) => msg!("This link holds no mystery: {}.", given),
            Self::UnknownEffect(given) => {
                msg!("The bench cannot hide {}.", Message::name(given.clone()))
            }
            Self::Strength {
                effect,
                symbol,
                least,
                most,
                unit,
            } => msg!(
                "{}: {} must be from {} to {} {}.",
                effect,
                symbol,
                least,
                most,
                unit
            ),
            Self::Together(first, second) => {
                msg!("{} and {} cannot be hidden together.", first, second)
            }
            Self::TooMany(given) => msg!("At most {} effects can be hidden.", given),
            Self::Cipher => "The truth cannot be sealed.".into(),
        }
    }
}

says!(MysteryError);
