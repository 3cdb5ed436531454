//! What a simulation of a drive writes, read again: the gap from the motor's side.

use std::fmt::Write as _;

use hysteron_core::backlash::{GapEstimate, Quality, backlash_map, estimate_gap};
use hysteron_core::drive;
use hysteron_core::measurement::{Measurement, import_csv};
use hysteron_core::scenario::AnyScenario;

/// Impacts in a drive's run, and the record of it in the columns of `hysteron simulate`.
fn record(text: &str) -> (usize, Measurement) {
    let AnyScenario::Drive(input) = AnyScenario::from_toml(text).unwrap() else {
        panic!("no drive")
    };
    let run = drive::run(&input).unwrap();
    let mut csv = String::from("t [s],u [N m],x1 [rad],v1 [rad/s],x2 [rad]\n");
    for (i, t) in run.time.iter().enumerate() {
        let (u, x1, v1, x2) = (run.input[i], run.x1[i], run.v1[i], run.x2[i]);
        writeln!(csv, "{t},{u},{x1},{v1},{x2}").unwrap();
    }
    let measurement = import_csv("simulated.csv", csv.as_bytes(), None).unwrap();
    (run.impacts(), measurement)
}

#[track_caller]
fn close(estimate: &GapEstimate, truth: f64) {
    let gap = estimate
        .gap
        .unwrap_or_else(|| panic!("none: {}", estimate.text));
    assert!((gap / truth - 1.0).abs() < 0.05, "{gap}: {}", estimate.text);
}

/// A drive of Fig. 12's kind, its relay sampled every so many seconds, or not at all.
fn drifting(sampling: Option<f64>) -> String {
    let sampled = sampling.map_or_else(String::new, |s| format!("sampling = {s}\n"));
    format!(
        "[drive]\nmotor = {{ inertia = 8.8e-4, viscous = 2e-3, coulomb = 0.03 }}\n\
         load = {{ inertia = 8.8e-4, viscous = 2e-3, coulomb = 0.15 }}\nhalf_gap = 0.0095\n\
         contact = {{ compliant = {{ stiffness = 3000.0, damping = 0.3 }} }}\n\
         [relay]\ngain = 0.5\nhysteresis = 0.5\nasymmetry = 0.3\nflip = 2.5\n{sampled}\
         [run]\nduration = 12.0\nstep = 2e-4\n"
    )
}

#[test]
fn instantaneous_torque_has_the_gap_of_its_drive() {
    let (impacts, measurement) = record(&drifting(None));
    assert!(impacts > 100);
    let estimate = estimate_gap(&measurement).unwrap();
    close(&estimate, 0.019);
    assert_eq!(estimate.quality, Quality::Good, "{}", estimate.text);
}

#[test]
fn the_shipped_drifting_drive_has_its_gap() {
    let (_, measurement) = record(include_str!("../../assets/scenarios/drive-drifting.toml"));
    close(&estimate_gap(&measurement).unwrap(), 0.019);
}

/// Its load has no dry friction, and is carried along by touches too light to be seen.
#[test]
fn the_shipped_late_and_compliant_drive_has_its_gap() {
    let (_, measurement) = record(include_str!(
        "../../assets/scenarios/drive-late-compliant.toml"
    ));
    let estimate = estimate_gap(&measurement).unwrap();
    close(&estimate, 0.012);
    let [low, high] = estimate.interval.unwrap();
    assert!(low < 0.012 && 0.012 < high, "{}", estimate.text);
}

#[test]
fn no_contact_is_claimed_where_a_sampled_relay_never_met_the_load() {
    // Switches inside the samples, on them, and in every fourth part of them.
    for sampling in [5e-5, 1.3e-4, 2e-4] {
        let (impacts, measurement) = record(&drifting(Some(sampling)));
        assert_eq!(impacts, 0, "{sampling}");
        let estimate = estimate_gap(&measurement).unwrap();
        assert_eq!(
            estimate.quality,
            Quality::NoEngagement,
            "{sampling}: {}",
            estimate.text
        );
        assert!(
            estimate.gap.is_none() && estimate.contacts.is_empty(),
            "{sampling}"
        );
        // The load moves by less than round-off of the motor's travel.
        let map = backlash_map(&measurement).unwrap();
        assert_eq!(map.gap, None, "{sampling}");
    }
}
