//! A real machine: what its owners found out about it is found again, and what is left is said.
//!
//! The record is not part of the project, see [`shared`].

#![allow(
    clippy::disallowed_macros,
    reason = "the core does not print; this test shows what it found"
)]

use crate::support::diagnosis::{classes, finish};
use crate::support::parameter::parameter;
use crate::support::shared::shared;
use hysteron_core::criticism::DiagnosisJob;
use hysteron_core::measurement::import_csv;

/// EMPS, a ball-screw drive of a prismatic joint in a closed position loop, position measured only:
/// Janot, Gautier and Brunot, "Data set and reference models of EMPS", 2019. They identified, by least squares
/// on the inverse model `force = M a + Fv v + Fc sgn(v) + offset`, 95.1089 kg, 203.5034 N s/m, 20.3935 N and
/// -3.1648 N. Their offset stands on the side of the motor force: ours, which acts on the body beside the
/// motor, has the opposite sign.
#[test]
fn the_positioning_system_has_dry_friction_and_an_offset() {
    let Some(bytes) = shared("real/emps.csv") else {
        return;
    };
    let measurement = import_csv("emps", &bytes, None).unwrap();
    let d = finish(DiagnosisJob::new(&measurement).unwrap());
    let found = classes(&d);
    assert_eq!(found.len(), 2, "{}", d.verdict.text);
    for effect in ["coulomb_friction", "constant_load"] {
        let named = found.iter().any(|class| class.contains(&effect));
        assert!(named, "{effect}: {}", d.verdict.text);
    }
    let last = d.steps.last().unwrap();
    for (symbol, identified, tolerance) in [
        ("J1", 95.1089, 0.05),
        ("d1", 203.5034, 0.05),
        ("c", 20.3935, 0.05),
        ("F0", 3.1648, 0.15),
    ] {
        let p = parameter(&d, symbol);
        println!("{symbol} {} +- {} {}", p.value, p.std_error, p.unit);
        assert!(
            (p.value / identified - 1.0).abs() < tolerance,
            "{symbol} = {} {}, identified {identified}",
            p.value,
            p.unit
        );
    }
    // A ripple of the screw and what else a real machine does is left: it is not passed off as noise.
    assert!(d.verdict.unknown && !d.verdict.complete);
    assert!(!last.findings.is_empty());
    assert!(
        d.verdict
            .text
            .to_string()
            .contains(&last.findings[0].text.to_string()),
        "{}",
        d.verdict.text
    );
}
