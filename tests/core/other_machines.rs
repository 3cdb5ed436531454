//! Machines that record otherwise: slow or fast, the position or the velocity only, a coarse encoder, a position
//! loop instead of a relay.

use std::f64::consts::TAU;
use std::fmt::Write as _;

use crate::support::diagnosis::{classes, finish, step};
use crate::support::parameter::parameter;
use crate::support::servo::servo;
use crate::support::sparse::thinned;
use crate::support::value::check_value;
use hysteron_core::criticism::{DiagnosisJob, StepJob};
use hysteron_core::diagnosis::Diagnosis;
use hysteron_core::measurement::{Measurement, import_csv};
use hysteron_core::rig::{DriveRig, Excitation, Friction, Load, Random, Recorded, Stranger};

/// Friction and load of these machines, N m.
const FRICTION: f64 = 0.02;
const LOAD: f64 = 0.01;

/// An encoder of 5000 lines, and nothing else.
fn machine(rate: f64, samples: usize, excitation: Excitation) -> DriveRig {
    DriveRig {
        excitation,
        sampling: 1.0 / rate,
        samples,
        encoder: TAU / 20_000.0,
        velocity_noise: 0.02,
        recorded: Recorded::PositionOnly,
        ..DriveRig::default()
    }
}

fn diagnose(rig: &DriveRig) -> Diagnosis {
    finish(DiagnosisJob::new(&rig.measure()).unwrap())
}

/// Checks the effects found, each alone in its class, and the parameters to 5 %.
fn check(d: &Diagnosis, missing: &[&str], parameters: &[(&str, f64)]) {
    let mut found = classes(d);
    found.sort();
    let wanted: Vec<Vec<&str>> = missing.iter().map(|e| vec![*e]).collect();
    assert_eq!(found, wanted, "{}", d.verdict.text);
    let body = [
        ("J1", DriveRig::default().inertia),
        ("d1", DriveRig::default().viscous),
    ];
    for (symbol, truth) in body.iter().chain(parameters) {
        check_value(d, symbol, *truth);
    }
}

/// Friction and load are found and known to 5 %.
fn check_friction_and_load(machine: &DriveRig) -> Diagnosis {
    let rig = DriveRig {
        friction: Friction::dry(FRICTION),
        constant_load: LOAD,
        ..*machine
    };
    let d = diagnose(&rig);
    check(
        &d,
        &["constant_load", "coulomb_friction"],
        &[("c", FRICTION), ("F0", LOAD)],
    );
    d
}

#[test]
fn a_position_loop_at_1_khz_gives_away_friction_and_a_load() {
    let d = check_friction_and_load(&machine(1e3, 10_000, servo(6.0, 0.5, 60.0)));
    assert!(d.verdict.complete, "{}", d.verdict.text);
}

#[test]
fn so_does_one_at_100_hz() {
    let d = check_friction_and_load(&machine(100.0, 6000, servo(12.0, 1.5, 15.0)));
    // Where the body lets go is not explained to the last count, but less than a hundredth of the first error is left.
    let (first, last) = (&d.steps[0], d.steps.last().unwrap());
    assert!(last.error < 1e-2 * first.error, "{}", last.error);
}

#[test]
fn a_tachometer_at_100_hz_gives_away_friction() {
    let rig = DriveRig {
        friction: Friction::dry(FRICTION),
        recorded: Recorded::VelocityOnly,
        ..machine(100.0, 3000, servo(12.0, 1.5, 15.0))
    };
    let d = diagnose(&rig);
    check(&d, &["coulomb_friction"], &[("c", FRICTION)]);
    assert!(d.verdict.complete, "{}", d.verdict.text);
}

/// Of a velocity alone nobody knows whether the torque or the filter was late, whatever the samples begin with.
#[test]
fn a_filter_and_a_slow_amplifier_are_one_to_a_tachometer() {
    let rig = DriveRig {
        sensor_lag: 6e-3,
        excitation: Excitation::Staircase { top: 0.1 },
        velocity_noise: 2e-3,
        recorded: Recorded::VelocityOnly,
        ..machine(1000.0, 10_000, servo(0.0, 1.0, 1.0))
    };
    let d = diagnose(&rig);
    assert_eq!(
        classes(&d),
        [["actuator_lag", "sensor_lag"]],
        "{}",
        d.verdict.text
    );
    assert!(d.verdict.complete, "{}", d.verdict.text);
}

/// A controller that runs five times as fast as the record: its output rises in five steps from a sample to the next,
/// of which the record has the first; their mean is (0 + 1 + 2 + 3 + 4)/25 of the way.
#[test]
fn a_controller_may_be_faster_than_the_record() {
    let fast = DriveRig {
        friction: Friction::dry(FRICTION),
        encoder: TAU / 4e6,
        velocity_noise: 0.05,
        recorded: Recorded::VelocityOnly,
        ..machine(2500.0, 30_000, servo(12.0, 0.5, 60.0))
    };
    let record = thinned(fast.measure(), 5);
    let d = finish(DiagnosisJob::new(&record).unwrap());
    check(&d, &["coulomb_friction"], &[("c", FRICTION), ("h", 0.4)]);
    assert!(d.verdict.complete, "{}", d.verdict.text);
    let said = "A logging effect, not the machine: Input moving between samples, share of the way to the next ";
    assert!(
        d.verdict.text.to_string().starts_with(said),
        "{}",
        d.verdict.text
    );
}

/// A force that depends on the position, where that is the integral of a noisy velocity.
#[test]
fn a_tachometer_gives_away_cogging() {
    let rig = DriveRig {
        cogging: (0.04, 6.0, 0.4),
        excitation: Excitation::Multisine { amplitude: 0.08 },
        recorded: Recorded::VelocityOnly,
        ..DriveRig::default()
    };
    let d = diagnose(&rig);
    check(&d, &["cogging"], &[("a", 0.04), ("n", 6.0)]);
    assert!(d.verdict.complete, "{}", d.verdict.text);
}

/// Pushed to and fro, and left to coast for as long after each push.
fn pushed(inertia: f64) -> DriveRig {
    DriveRig {
        inertia,
        viscous: 1.715e-3,
        excitation: Excitation::Staircase { top: 0.3 },
        seed: 2,
        ..DriveRig::default()
    }
}

#[test]
fn what_acts_only_while_a_machine_is_pushed_is_found() {
    for (inertia, drag, asymmetry) in [(9e-4, 6e-5, 0.08), (9.53e-4, 6e-5, 0.05)] {
        let rig = DriveRig {
            quadratic_drag: drag,
            gain_asymmetry: asymmetry,
            ..pushed(inertia)
        };
        let d = diagnose(&rig);
        let mut found = classes(&d);
        found.sort();
        assert_eq!(found, [["gain_asymmetry"], ["quadratic_drag"]]);
        assert!(d.verdict.complete, "{inertia}: {}", d.verdict.text);
    }
}

/// A spring to the ground is like a joint whose load is too heavy to be moved, which nobody has.
#[test]
fn a_spring_to_the_ground_is_no_joint() {
    let rig = DriveRig {
        viscous: 2.1155e-3,
        stranger: Some(Stranger::Spring { stiffness: 0.05 }),
        ..pushed(8.3548e-4)
    };
    let d = diagnose(&rig);
    assert_eq!(classes(&d), [["return_spring"]], "{}", d.verdict.text);
    assert!(d.verdict.complete, "{}", d.verdict.text);
}

/// Nor is it a gap of no width, or a wave of which less than one is ever seen.
#[test]
fn a_stiff_spring_to_the_ground_is_no_gap_and_no_wave() {
    for recorded in [Recorded::Both, Recorded::VelocityOnly] {
        let rig = DriveRig {
            stranger: Some(Stranger::Spring { stiffness: 0.3 }),
            encoder: 1e-9,
            velocity_noise: 0.02,
            recorded,
            ..machine(1e3, 6000, Excitation::Multisine { amplitude: 0.12 })
        };
        let d = diagnose(&rig);
        assert_eq!(classes(&d), [["return_spring"]], "{}", d.verdict.text);
        assert!(d.verdict.complete, "{}", d.verdict.text);
    }
}

/// A load that does not rub has a dry friction of 0, which is no reason not to offer it.
#[test]
fn a_load_behind_a_shaft_is_offered_at_once() {
    let load = Load {
        half_gap: 0.0,
        stiffness: 18.0,
        damping: 4e-3,
        inertia: 8.8e-4,
        viscous: 2e-3,
        coulomb: 0.0,
    };
    let rig = DriveRig {
        load: Some(load),
        recorded: Recorded::Both,
        ..machine(5e3, 6000, Excitation::Multisine { amplitude: 0.12 })
    };
    let report = step(StepJob::new(&rig.measure(), &[]).unwrap());
    assert!(report.verdict.is_none(), "{:?}", report.verdict);
    let best = &report.step.candidates[0];
    assert_eq!(best.effects[0].as_str(), "joint_compliance");
}

/// It hardly ever turns round, so that its encoder may never be seen on two neighbouring counts.
#[test]
fn what_a_machine_runs_away_from_is_found() {
    for (inertia, load) in [(9e-4, 0.025), (9.53e-4, 0.0168)] {
        let rig = DriveRig {
            constant_load: load,
            ..pushed(inertia)
        };
        let d = diagnose(&rig);
        assert_eq!(classes(&d), [["constant_load"]]);
        assert!(d.verdict.complete, "{inertia}: {}", d.verdict.text);
    }
}

/// What it drives sticks, now and then, and then the motor winds up the shaft alone.
#[test]
fn a_load_that_rubs_is_found_behind_its_shaft() {
    let load = Load {
        half_gap: 0.0,
        stiffness: 20.0,
        damping: 4e-3,
        inertia: 6e-4,
        viscous: 2e-3,
        coulomb: 0.1,
    };
    let rig = DriveRig {
        load: Some(load),
        recorded: Recorded::Both,
        ..machine(5e3, 10_000, Excitation::Multisine { amplitude: 0.12 })
    };
    let d = diagnose(&rig);
    assert_eq!(classes(&d), [["joint_compliance"]], "{}", d.verdict.text);
    let last = d.steps.last().unwrap();
    assert!(last.error < 1.2, "{}", d.verdict.text);
    for (symbol, truth) in [
        ("J1", rig.inertia),
        ("K", load.stiffness),
        ("J2", load.inertia),
        ("c2", load.coulomb),
    ] {
        let p = parameter(&d, symbol);
        assert!(
            (p.value / truth - 1.0).abs() < 0.02,
            "{symbol} = {}",
            p.value
        );
    }
}

/// Nobody can simulate for long where such a load is: every contact multiplies what was wrong before it. The momentum
/// that the motor loses tells it.
#[test]
fn a_load_that_is_met_again_and_again_is_found_behind_its_gap() {
    let load = Load {
        half_gap: 0.03,
        stiffness: 800.0,
        damping: 0.15,
        inertia: 8.8e-4,
        viscous: 2e-3,
        coulomb: 0.0,
    };
    let d = diagnose(&DriveRig {
        excitation: Excitation::Multisine { amplitude: 0.08 },
        samples: 5000,
        load: Some(load),
        ..DriveRig::default()
    });
    let truth = [
        ("beta", load.half_gap),
        ("J2", load.inertia),
        ("J1", DriveRig::default().inertia),
        ("K", load.stiffness),
        ("D", load.damping),
    ];
    check(&d, &["backlash"], &truth);
    assert!(d.verdict.complete, "{}", d.verdict.text);
    assert!(d.steps.last().unwrap().error < 1.2);
}

/// In a position loop the load is carried along most of the time, and body and load look like one heavier body.
#[test]
fn a_load_that_is_soon_slow_is_found_behind_its_gap() {
    let load = Load {
        half_gap: 0.02,
        stiffness: 300.0,
        damping: 0.15,
        inertia: 4e-4,
        viscous: 8e-3,
        coulomb: 0.0,
    };
    let rig = DriveRig {
        load: Some(load),
        velocity_noise: 5e-3,
        recorded: Recorded::Both,
        ..machine(1e3, 5_000, servo(1.2, 0.625, 30.0))
    };
    let d = diagnose(&rig);
    assert_eq!(classes(&d), [["backlash"]], "{}", d.verdict.text);
    let last = d.steps.last().unwrap();
    check_value(&d, "beta", load.half_gap);
    // How the contact gives way is hardly told; what it leaves must be said.
    assert_eq!(d.verdict.complete, last.error < 1.2, "{}", d.verdict.text);
}

/// A belt that gives way over a tenth of a move: what that takes looks like viscous friction at first.
#[test]
fn friction_that_builds_up_over_a_long_way_is_found() {
    let (level, displacement) = (0.03, 0.05);
    let rig = DriveRig {
        friction: Friction {
            displacement,
            ..Friction::dry(level)
        },
        velocity_noise: 2e-3,
        recorded: Recorded::Both,
        ..machine(500.0, 10_000, servo(0.5, 0.8, 30.0))
    };
    let d = diagnose(&rig);
    check(
        &d,
        &["presliding_friction"],
        &[("c", level), ("s", displacement)],
    );
    assert!(d.verdict.complete, "{}", d.verdict.text);
}

/// Twelve hundred poles go by: a wave that is met nowhere on a coarse grid of frequencies.
#[test]
fn cogging_of_a_long_axis_is_found() {
    let rig = DriveRig {
        cogging: (0.01, 97.3, 0.4),
        velocity_noise: 2e-3,
        recorded: Recorded::Both,
        ..machine(2e3, 20_000, servo(40.0, 5.0, 40.0))
    };
    let d = diagnose(&rig);
    check(&d, &["cogging"], &[("a", 0.01), ("n", 97.3)]);
    assert!(d.verdict.complete, "{}", d.verdict.text);
}

/// A loop too soft to carry the body over a tooth at every move: it lies in the troughs, and a model without them takes
/// it for another body altogether.
#[test]
fn cogging_that_holds_the_body_is_found() {
    let (amplitude, teeth) = (0.03, 12.0);
    let rig = DriveRig {
        cogging: (amplitude, teeth, 0.4),
        ..machine(200.0, 12_000, servo(1.2, 1.25, 8.0))
    };
    let d = diagnose(&rig);
    check(&d, &["cogging"], &[("a", amplitude), ("n", teeth)]);
    assert!(d.verdict.complete, "{}", d.verdict.text);
}

/// A body of `drive` far off what a controller wants of it: only on its way there does the amplifier reach its `limit`,
/// N m.
fn starting_far_off(drive: &DriveRig, limit: f64, samples: usize) -> Measurement {
    const SUBSTEPS: usize = 50;
    let step = drive.sampling / SUBSTEPS as f64;
    let (stiffness, damping) = (16.0 * drive.inertia, 6.0 * drive.inertia);
    let (mut x, mut v) = (6.5, 0.0);
    let mut csv = "t [s],u [N m],x1 [rad]\n".to_owned();
    for k in 0..samples {
        let time = k as f64 * drive.sampling;
        let counted = (x / drive.encoder).round() * drive.encoder;
        let command = stiffness * (2.0 * (3.0 * time).sin() - counted) - damping * v;
        writeln!(csv, "{time},{command},{counted}").unwrap();
        for _ in 0..SUBSTEPS {
            v += step * (command.clamp(-limit, limit) - drive.viscous * v) / drive.inertia;
            x += step * v;
        }
    }
    import_csv("far", csv.as_bytes(), None).unwrap()
}

#[test]
fn a_limit_that_is_reached_once_is_found() {
    let rig = machine(100.0, 0, Excitation::Staircase { top: 0.0 });
    let limit = 0.04;
    let record = starting_far_off(&rig, limit, 6000);
    let d = finish(DiagnosisJob::new(&record).unwrap());
    check(&d, &["saturation"], &[("M", limit)]);
    assert!(d.verdict.complete, "{}", d.verdict.text);
}

#[test]
fn nothing_is_missing_where_nothing_is() {
    for (rate, samples, excitation) in [
        (100.0, 6000, servo(12.0, 1.5, 15.0)),
        (1e3, 10_000, servo(6.0, 0.5, 60.0)),
    ] {
        let d = diagnose(&machine(rate, samples, excitation));
        check(&d, &[], &[]);
        assert!(d.verdict.complete, "{rate} Hz: {}", d.verdict.text);
    }
}

/// Where it rests, all that its encoder tells is the count on which it is.
#[test]
fn a_coarse_encoder_is_no_missing_effect() {
    for counts in [5000.0, 9000.0, 14_400.0] {
        for seed in 1..5 {
            let rig = DriveRig {
                seed,
                encoder: TAU / counts,
                ..machine(1e3, 4000, servo(3.0, 0.8, 25.0))
            };
            let d = diagnose(&rig);
            assert_eq!(d.verdict.missing.len(), 0, "{counts}: {}", d.verdict.text);
            assert!(d.verdict.complete, "{counts}: {}", d.verdict.text);
        }
    }
}

#[test]
fn stribeck_friction_is_known_from_the_position_under_a_relay_that_turns_every_few_samples() {
    for gain in [0.5, 0.3] {
        let rig = DriveRig {
            recorded: Recorded::PositionOnly,
            samples: 5000,
            excitation: Excitation::Relay {
                gain,
                asymmetry: 0.05,
                hysteresis: 0.2,
                flip: None,
            },
            friction: Friction {
                coulomb: 0.1,
                standing: 0.17,
                stribeck_velocity: 0.1,
                displacement: 1e-7,
            },
            ..DriveRig::default()
        };
        let d = diagnose(&rig);
        assert_eq!(classes(&d), [["stribeck_friction"]], "{}", d.verdict.text);
        assert!(d.verdict.complete, "{}", d.verdict.text);
        check_value(&d, "J1", rig.inertia);
    }
}

#[test]
fn on_a_machine_that_never_turns_round_friction_and_a_load_are_the_same() {
    // Exact steps of a body at held torque, less what rubs: it never stops.
    let (inertia, viscous, friction, step) = (1.2e-4, 1.5e-4, 0.03, 1e-3);
    let levels = [0.09, 0.06, 0.12, 0.07, 0.11, 0.05, 0.1, 0.08];
    let decay = f64::exp(-viscous / inertia * step);
    let mut noise = Random::new(7);
    let mut text = "t [s],u [N m],v1 [rad/s]\n".to_owned();
    let mut speed = 200.0;
    for k in 0..8000 {
        let push = levels[(k / 250) % levels.len()];
        let read = speed + 0.5 * noise.normal();
        let _ = writeln!(text, "{},{push},{read}", k as f64 * step);
        let steady = (push - friction) / viscous;
        speed = steady + (speed - steady) * decay;
    }
    let measurement = import_csv("one way", text.as_bytes(), None).unwrap();
    let d = finish(DiagnosisJob::new(&measurement).unwrap());
    let found = classes(&d);
    assert_eq!(found.len(), 1, "{}", d.verdict.text);
    for effect in ["coulomb_friction", "constant_load", "dead_zone"] {
        assert!(found[0].contains(&effect), "{}", d.verdict.text);
    }
    check_value(&d, "J1", inertia);
}

#[test]
fn friction_is_found_where_a_machine_mostly_rests_and_its_tachometer_is_rough() {
    for (velocity_noise, friction) in [(0.2, 0.06), (0.5, 0.02)] {
        let rig = DriveRig {
            recorded: Recorded::Both,
            velocity_noise,
            friction: Friction::dry(friction),
            ..machine(200.0, 2500, servo(1.0, 1.0, 15.0))
        };
        let d = diagnose(&rig);
        check(&d, &["coulomb_friction"], &[("c", friction)]);
        assert!(d.verdict.complete, "{}", d.verdict.text);
    }
}
