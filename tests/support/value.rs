//! How well a parameter is known.

use hysteron_core::diagnosis::Diagnosis;

use super::parameter::parameter;

/// To 5 %.
pub fn check_value(diagnosis: &Diagnosis, symbol: &str, truth: f64) {
    let p = parameter(diagnosis, symbol);
    assert!(
        (p.value / truth - 1.0).abs() < 0.05,
        "{symbol} = {} {}, truth {truth}",
        p.value,
        p.unit
    );
}
