//! What does the relay act on? Equation (1): a linear plant with dead time.
//!
//! A plant is a [`TransferFunction`], a [`StateSpace`] or a [`ZeroPoleGain`], each of which converts
//! into the others, or a [`Multivariable`] with as many inputs as outputs.

use crate::message::{Message, says};
use crate::msg;

mod conversion;
mod parse;
mod presets;
mod roots;
mod state_space;
mod transfer_function;
mod zero_pole_gain;

pub use parse::{MAX_TEXT, ParseError, parse};
pub use presets::{Preset, presets};
pub use state_space::{Multivariable, StateSpace};
pub use transfer_function::TransferFunction;
pub use zero_pole_gain::ZeroPoleGain;

pub(crate) use roots::roots;

/// Highest order that is accepted.
pub const MAX_ORDER: usize = 12;

/// Why a plant cannot be.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PlantError {
    /// A coefficient that is no number.
    NotFinite,
    /// Nothing between input and output.
    NoNumerator,
    /// Order out of range.
    Order(usize),
    /// Numerator of too high an order.
    NotProper {
        /// Order of the numerator.
        numerator: usize,
        /// Order of the denominator.
        denominator: usize,
    },
    /// Negative dead time.
    DeadTime(f64),
    /// Sampling time of a plant in discrete time.
    SamplingTime(f64),
    /// Matrices that do not fit together.
    Shape {
        /// Which matrix.
        matrix: &'static str,
        /// Its rows.
        rows: usize,
        /// Its columns.
        columns: usize,
        /// What would be right.
        wanted: String,
    },
    /// A complex pole or zero without its conjugate.
    Conjugate {
        /// Pole or zero.
        kind: &'static str,
        /// Real part, 1/s.
        re: f64,
        /// Imaginary part, 1/s.
        im: f64,
    },
    /// Coefficients too large or too small to compute with.
    Range,
}

impl PlantError {
    /// In words.
    pub fn message(&self) -> Message {
        match self {
            Self::NotFinite => {
                "a coefficient is not finite: every coefficient must be a number".into()
            }
            Self::NoNumerator => {
                "the numerator is empty or zero: it must have a coefficient that is not 0".into()
            }
            Self::Order(given) => msg!(
                "the denominator has order {}: it must be 1 to {}, its first coefficient not 0",
                given,
                MAX_ORDER
            ),
            Self::NotProper {
                numerator,
                denominator,
            } => msg!(
                "the numerator has order {}, the denominator {}: the numerator's must be lower",
                numerator,
                denominator
            ),
            Self::DeadTime(given) => msg!("dead time {} s: must be 0 or more", given),
            Self::SamplingTime(given) => msg!("sampling time {} s: must be above 0", given),
            Self::Shape {
                matrix,
                rows,
                columns,
                wanted,
            } => msg!(
                "{} is {} x {}: it must be {}",
                matrix,
                rows,
                columns,
                Message::name(wanted.clone())
            ),
            Self::Conjugate { kind, re, im } => msg!(
                "the {} {} {}j has no conjugate: complex ones must come in pairs",
                kind,
                re,
                format!("{:+}", im)
            ),
            Self::Range => {
                "the coefficients span too wide a range: choose other units of time or signals"
                    .into()
            }
        }
    }
}

says!(PlantError);
