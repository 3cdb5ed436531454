//! What can be wrong with a mystery.

/// Fewest characters of a word.
pub const SHORTEST_WORD: usize = 6;

/// Why a mystery cannot be made, read or revealed; each is one sentence.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MysteryError {
    /// A word that anybody could guess.
    #[error("The password has {found} letters: it needs at least {SHORTEST_WORD}.")]
    ShortWord {
        /// Its length in characters.
        found: usize,
    },
    /// The word is another one, or the seal was changed.
    #[error("This password does not open the seal.")]
    WrongWord,
    /// A seal that is not one.
    #[error("The sealed truth of this file is damaged.")]
    BadSeal,
    /// A text that stands for no mystery.
    #[error("This link holds no mystery: {0}.")]
    BadLink(&'static str),
    /// An effect that the bench cannot hide.
    #[error("The bench cannot hide {0}.")]
    UnknownEffect(String),
    /// A strength that the bench cannot have.
    #[error("{effect}: {symbol} must be from {least} to {most} {unit}.")]
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
    #[error("{0} and {1} cannot be hidden together.")]
    Together(&'static str, &'static str),
    /// More than a diagnosis can be asked to find.
    #[error("At most {0} effects can be hidden.")]
    TooMany(usize),
    /// The cipher refused, which it does for texts beyond all size only.
    #[error("The truth cannot be sealed.")]
    Cipher,
}
