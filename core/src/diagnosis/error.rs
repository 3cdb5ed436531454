//! Why a measurement cannot be criticised.

use crate::effect::{EffectId, FormulaError};

/// Why a measurement cannot be criticised.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CriticismError {
    /// The input never changes, so nothing can be learnt from it.
    #[error(
        "the input is constant over the whole file: an experiment must move it; of a step from rest, add the row before the step, with the input as it was then"
    )]
    ConstantInput,
    /// An output never changes.
    #[error(
        "the column {name} is constant over the whole file: there is nothing to compare the model with"
    )]
    ConstantOutput {
        /// Its name in the file.
        name: String,
    },
    /// A model of another kind of system.
    #[error("the model is of a {model}, the measurement of a {measured}")]
    WrongKind {
        /// What the model is of.
        model: &'static str,
        /// What was measured.
        measured: &'static str,
    },
    /// A known parameter in another unit than this measurement gives it.
    #[error("the model gives {symbol} in {said}, but with this measurement it is in {unit}")]
    WrongUnit {
        /// Symbol of the parameter.
        symbol: String,
        /// Unit in the model.
        said: String,
        /// Unit with this measurement.
        unit: String,
    },
    /// An effect of the user's own that cannot be made.
    #[error("{name}, {error}")]
    OwnEffect {
        /// Its name.
        name: String,
        /// What is wrong with its formula.
        error: FormulaError,
    },
    /// A fitted model without the value of a parameter.
    #[error("the fitted model has no value for {symbol}")]
    NoValue {
        /// Symbol of the parameter.
        symbol: String,
    },
    /// A model whose error is no number.
    #[error(
        "the error of the model is not finite: values of the measurement or of the model are too large or too small to calculate with"
    )]
    NotFinite,
    /// An effect that makes no sense for this kind of system.
    #[error("{effect} cannot be added to this kind of system")]
    WrongEffect {
        /// The effect.
        effect: EffectId,
    },
}
