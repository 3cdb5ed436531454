//! What does the relay act on? Equation (1): a linear plant with dead time.
//!
//! A plant is a [`TransferFunction`], a [`StateSpace`] or a [`ZeroPoleGain`], each of which converts
//! into the others, or a [`Multivariable`] with as many inputs as outputs.

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
    #[error("a coefficient is not finite: every coefficient must be a number")]
    NotFinite,
    /// Nothing between input and output.
    #[error("the numerator is empty or zero: it must have a coefficient that is not 0")]
    NoNumerator,
    /// Order out of range.
    #[error(
        "the denominator has order {0}: it must be 1 to {MAX_ORDER}, its first coefficient not 0"
    )]
    Order(usize),
    /// Numerator of too high an order.
    #[error(
        "the numerator has order {numerator}, the denominator {denominator}: the numerator's must be lower"
    )]
    NotProper {
        /// Order of the numerator.
        numerator: usize,
        /// Order of the denominator.
        denominator: usize,
    },
    /// Negative dead time.
    #[error("dead time {0} s: must be 0 or more")]
    DeadTime(f64),
    /// Sampling time of a plant in discrete time.
    #[error("sampling time {0} s: must be above 0")]
    SamplingTime(f64),
    /// Matrices that do not fit together.
    #[error("{matrix} is {rows} x {columns}: it must be {wanted}")]
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
    #[error("the {kind} {re} {im:+}j has no conjugate: complex ones must come in pairs")]
    Conjugate {
        /// Pole or zero.
        kind: &'static str,
        /// Real part, 1/s.
        re: f64,
        /// Imaginary part, 1/s.
        im: f64,
    },
    /// Coefficients too large or too small to compute with.
    #[error("the coefficients span too wide a range: choose other units of time or signals")]
    Range,
}
