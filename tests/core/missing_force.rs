//! Where no effect of the library explains the rest, what is missing is estimated without a model.

use hysteron_core::criticism::DiagnosisJob;
use hysteron_core::diagnosis::{MissingPart, StepReport};
use hysteron_core::progress::Progress;
use hysteron_core::rig::{DriveRig, Excitation, Stranger};

/// The last model of a diagnosis that must end with `unknown`.
fn unknown(excitation: Excitation, stranger: Stranger) -> StepReport {
    let rig = DriveRig {
        excitation,
        stranger: Some(stranger),
        ..DriveRig::default()
    };
    let measurement = rig.measure();
    let mut job = DiagnosisJob::new(&measurement).unwrap();
    loop {
        if let Progress::Done(d) = job.advance() {
            assert!(d.verdict.unknown, "{}", d.verdict.text);
            return job.evidence().unwrap().1.clone();
        }
    }
}

/// The estimate that explains most, which must be a force over this axis and explain most of the rest:
/// the ends of its steps need not be those of the truth.
fn strongest(report: &StepReport, axis: &str) -> MissingPart {
    let best = &report.missing[0];
    assert_eq!((best.what.as_str(), best.axis.as_str()), ("force", axis));
    assert!(best.explained > 0.75, "{}", best.text);
    best.clone()
}

#[test]
fn a_torque_that_acts_once_is_found_in_time() {
    let (torque, from, to) = (0.1, 0.9, 1.1);
    let length = to - from;
    // To and fro, so that time and position are not the same.
    let sines = Excitation::Multisine { amplitude: 0.08 };
    let pulse = Stranger::Pulse {
        torque,
        from,
        length,
    };
    let best = strongest(&unknown(sines, pulse), "time");
    assert!(best.text.to_string().contains("depends on the time") && best.unit == "N m");
    let mut inside = 0;
    for p in &best.parts {
        if p.from > from && p.to < to {
            inside += 1;
            // Inertia and friction of the model have taken up some of it.
            assert!((p.value - torque).abs() < 0.25 * torque, "{p:?}");
        } else if p.to < from || p.from > to {
            assert!(p.value.abs() < 0.25 * torque + 2.0 * p.std_error, "{p:?}");
        }
    }
    assert!(inside >= 2);
}

#[test]
fn a_drag_at_one_speed_is_found_there() {
    let (torque, centre, width) = (0.05, 8.0, 1.5);
    let sines = Excitation::Multisine { amplitude: 0.08 };
    let bump = Stranger::SpeedBump {
        torque,
        centre,
        width,
    };
    let best = strongest(&unknown(sines, bump), "velocity");
    assert_eq!(best.axis_unit, "rad/s");
    // Against the motion at that speed to both sides, by about its size; little at other speeds.
    for side in [-1.0, 1.0] {
        let at = best
            .parts
            .iter()
            .find(|p| p.from <= side * centre && side * centre < p.to)
            .unwrap();
        assert!(-side * at.value > 0.6 * torque, "{at:?}");
        assert!(
            -side * at.value < 1.2 * torque + 2.0 * at.std_error,
            "{at:?}"
        );
    }
    for p in &best.parts {
        let off = [p.from, p.to].map(|v| (v.abs() - centre).abs());
        if off[0].min(off[1]) > 3.0 * width && p.from * p.to > 0.0 {
            // The bump must stand out: nowhere else half as much.
            assert!(p.value.abs() < 0.5 * torque, "{p:?}");
        }
    }
}
