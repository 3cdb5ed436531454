//! What was measured: one experiment, in SI units, checked.
//!
//! A [`Measurement`] holds one input and the outputs that were recorded with it.
//! Time is strictly increasing and every value is finite: [`import_csv`]
//! refuses anything else, so that no later module has to check again.

mod advice;
mod average;
mod cell;
mod clock;
mod column;
mod controlled;
mod csv;
mod error;
mod fill;
mod found;
mod gaps;
mod guess;
#[cfg(not(target_arch = "wasm32"))]
mod hdf5;
mod header;
mod json;
mod kind;
mod log;
mod mapped;
mod mapping;
mod mat;
mod period;
mod rates;
mod record;
mod resembling;
mod series;
mod size;
mod split;
mod switched_on;
mod table;
mod text;
mod times;
mod unit;

pub use column::Role;
pub use error::{ImportError, Problem};
pub use found::FoundColumn;
pub use gaps::gaps;
pub use guess::{Guess, guess};
pub use kind::{Kind, Motion, Quantity};
pub use mapping::{ImportOptions, Mapping, MappingError, TorqueConstant};
pub use period::{Period, PeriodError};
pub use record::{Channel, MIN_SAMPLES, Measurement, less_model};
pub use table::{columns, import, import_csv};
pub use unit::{COUNTS, constant_per, needs_torque_constant, usual_units};
