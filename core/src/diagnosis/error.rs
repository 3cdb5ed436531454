//! Why a measurement cannot be criticised.

use crate::effect::{EffectId, FormulaError};
use crate::message::{Message, says};
use crate::msg;

/// Why a measurement cannot be criticised.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CriticismError {
    /// The input never changes, so nothing can be learnt from it.
    ConstantInput,
    /// An output never changes.
    ConstantOutput {
        /// Its name in the file.
        name: String,
    },
    /// A model of another kind of system.
    WrongKind {
        /// What the model is of.
        model: &'static str,
        /// What was measured.
        measured: &'static str,
    },
    /// A known parameter in another unit than this measurement gives it.
    WrongUnit {
        /// Symbol of the parameter.
        symbol: String,
        /// Unit in the model.
        said: String,
        /// Unit with this measurement.
        unit: String,
    },
    /// An effect of the user's own that cannot be made.
    OwnEffect {
        /// Its name.
        name: String,
        /// What is wrong with its formula.
        error: FormulaError,
    },
    /// A fitted model without the value of a parameter.
    NoValue {
        /// Symbol of the parameter.
        symbol: String,
    },
    /// A model whose error is no number.
    NotFinite,
    /// An effect that makes no sense for this kind of system.
    WrongEffect {
        /// The effect.
        effect: EffectId,
    },
}

impl CriticismError {
    /// In words.
    pub fn message(&self) -> Message {
        match self {
            Self::ConstantInput => {
                "the input is constant over the whole file: an experiment must change it; for a step from rest, add \
                 the row before the step, with the input as it was then"
                    .into()
            }
            Self::ConstantOutput { name } => msg!(
                "the column {} is constant over the whole file: there is nothing to compare the model with",
                Message::name(name.clone())
            ),
            Self::WrongKind { model, measured } => msg!(
                "the model is of a {}, the measurement of a {}",
                model,
                measured
            ),
            Self::WrongUnit { symbol, said, unit } => msg!(
                "the model gives {} in {}, but with this measurement it is in {}",
                Message::name(symbol.clone()),
                Message::name(said.clone()),
                Message::name(unit.clone())
            ),
            Self::OwnEffect { name, error } => msg!("{}, {}", Message::name(name.clone()), error),
            Self::NoValue { symbol } => msg!(
                "the fitted model has no value for {}",
                Message::name(symbol.clone())
            ),
            Self::NotFinite => {
                "the error of the model is not finite: values of the measurement or of the model are too large \
                 or too small to calculate with"
                    .into()
            }
            Self::WrongEffect { effect } => msg!(
                "{} cannot be added to this kind of system",
                Message::name(effect.as_str())
            ),
        }
    }
}

says!(CriticismError);
