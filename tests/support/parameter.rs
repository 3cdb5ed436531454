//! What was found of a parameter.

use hysteron_core::diagnosis::{Diagnosis, Parameter};

/// A parameter of the last model.
pub fn parameter<'d>(diagnosis: &'d Diagnosis, symbol: &str) -> &'d Parameter {
    let all = &diagnosis.steps.last().unwrap().parameters;
    all.iter().find(|p| p.name == symbol).unwrap()
}
