//! The two contact models against each other and against closed forms; sticking, pulling, chattering.

use std::f64::consts::PI;

use hysteron_core::drive::{
    Adhesion, Body, Command, Contact, Drive, DriveInput, EventKind, Mass, Side, Start,
    VelocityRelay, run,
};
use hysteron_core::relay::Relay;

const J1: f64 = 8.8e-4;
const J2: f64 = 2.3e-3;
const BETA: f64 = 0.0095;

fn body(inertia: f64, coulomb: f64) -> Body {
    Body {
        inertia,
        viscous: 0.0,
        coulomb,
    }
}

fn drive(contact: Contact) -> Drive {
    Drive {
        motor: body(J1, 0.0),
        load: body(J2, 0.0),
        half_gap: BETA,
        contact,
        adhesion: Adhesion::default(),
    }
}

/// Both masses free, the motor moving up.
fn thrown(contact: Contact, duration: f64) -> DriveInput {
    DriveInput {
        start: Start {
            v1: 1.0,
            ..Start::default()
        },
        ..DriveInput::new(drive(contact), Command::Torque(0.0), duration, None)
    }
}

/// Contact with this damping ratio.
fn compliant(stiffness: f64, ratio: f64) -> Contact {
    let mass = J1 * J2 / (J1 + J2);
    Contact::Compliant {
        stiffness,
        damping: 2.0 * ratio * (stiffness * mass).sqrt(),
    }
}

/// Damped oscillation of the relative motion until its force is zero:
/// `e = exp(-z/sqrt(1 - z^2) (pi - 2 asin z))`.
fn restitution(ratio: f64) -> f64 {
    (-ratio / (1.0 - ratio * ratio).sqrt() * (PI - 2.0 * ratio.asin())).exp()
}

#[test]
fn one_compliant_impact_is_the_damped_oscillation_in_closed_form() {
    for ratio in [0.0, 0.05, 0.3, 0.8] {
        for stiffness in [50.0, 1500.0, 1e6] {
            let done = run(&thrown(compliant(stiffness, ratio), 0.05)).unwrap();
            let touch = done.events[0];
            let part = done.events[1];
            assert_eq!(touch.kind, EventKind::Touch(Side::Upper));
            assert_eq!(part.kind, EventKind::Part(Side::Upper));
            assert!((touch.time - BETA).abs() < 1e-15);
            let omega = (stiffness * (1.0 / J1 + 1.0 / J2)).sqrt();
            let damped = omega * (1.0 - ratio * ratio).sqrt();
            let lasted = (PI - 2.0 * ratio.asin()) / damped;
            assert!(((part.time - touch.time) / lasted - 1.0).abs() < 1e-11);
            let e = part.v2 - part.v1;
            assert!((e / restitution(ratio) - 1.0).abs() < 1e-11, "{ratio}: {e}");
        }
    }
}

#[test]
fn the_compliant_contact_tends_to_the_rigid_one_as_it_gets_stiffer() {
    for ratio in [0.0, 0.1, 0.4] {
        let rigid = Contact::Rigid {
            restitution: restitution(ratio),
        };
        let after = |contact| {
            let done = run(&DriveInput {
                step: Some(0.25),
                ..thrown(contact, 0.25)
            })
            .unwrap();
            (*done.x1.last().unwrap(), *done.v1.last().unwrap())
        };
        let (x, v) = after(rigid);
        let mut last = f64::INFINITY;
        for stiffness in [1e4, 1e6, 1e8, 1e10] {
            let (x1, v1) = after(compliant(stiffness, ratio));
            let error = (x1 - x).abs();
            // The time of contact falls with the root of the stiffness, and the error with it.
            assert!(
                error < 0.2 * last,
                "{ratio} {stiffness}: {error} after {last}"
            );
            assert!((v1 - v).abs() < 1e-6, "{v1} {v}");
            last = error;
        }
        assert!(last < 1e-5);
    }
}

#[test]
fn without_restitution_motor_and_load_move_on_as_one() {
    let done = run(&thrown(Contact::Rigid { restitution: 0.0 }, 1.0)).unwrap();
    assert_eq!(done.impacts(), 1, "they touch once: {:?}", done.events);
    let last = done.events.last().unwrap();
    let common = J1 / (J1 + J2);
    assert!((last.v1 - common).abs() < 1e-15 && (last.v2 - common).abs() < 1e-15);
}

#[test]
fn bounces_that_die_out_end_in_contact() {
    // A constant push against a load; each bounce is e times the last one: all of them last
    // `2 v e/(1 - e)/a` in sum, which the run must pass.
    let e = 0.6;
    let mut input = thrown(Contact::Rigid { restitution: e }, 1.0);
    input.command = Command::Torque(0.2);
    let done = run(&input).unwrap();
    let touch = done
        .events
        .iter()
        .find(|e| matches!(e.kind, EventKind::Touch(_)))
        .expect("contact");
    let first = done.events[0];
    let EventKind::Impact(Side::Upper, speed) = first.kind else {
        panic!("{first:?}");
    };
    let sum = 2.0 * speed * e / (1.0 - e) / (0.2 / J1);
    assert!(((touch.time - first.time) / sum - 1.0).abs() < 1e-7);
    assert_eq!(done.chattering, None);
}

/// Whether a pull parts masses that have met, with a contact that holds on with this force.
fn parts(contact: Contact, speed: f64, hold: f64, pull: f64) -> bool {
    let mut input = thrown(contact, 0.012 / speed);
    input.start.v1 = speed;
    input.drive.adhesion.upper = hold;
    input.command = Command::Torque(-pull);
    let done = run(&input).unwrap();
    let met = |k: &EventKind| matches!(k, EventKind::Touch(Side::Upper));
    assert!(
        done.events.iter().any(|e| met(&e.kind)),
        "{:?}",
        done.events
    );
    assert!(
        done.energy.residual().abs() < 1e-10 * done.energy.initial,
        "{contact:?} {hold} {pull} {:?} {:e}",
        done.energy,
        done.energy.residual()
    );
    done.events
        .iter()
        .any(|e| matches!(e.kind, EventKind::Part(Side::Upper)))
}

#[test]
fn a_contact_does_not_pull_and_an_adhesive_one_only_so_far() {
    let rigid = Contact::Rigid { restitution: 0.0 };
    // Pulled by u, the load follows with the force u J2/(J1 + J2).
    let hold = 0.001;
    let most = hold * (J1 + J2) / J2;
    assert!(parts(rigid, 1.0, 0.0, 1e-6));
    assert!(!parts(rigid, 1.0, hold, 0.99 * most));
    assert!(parts(rigid, 1.0, hold, 1.01 * most));
    // The spring's own rebound, some sqrt(K m) v = 8e-4 N m less its damping, is held or not.
    let soft = compliant(1000.0, 0.7);
    assert!(parts(soft, 1e-3, 0.0, 0.0));
    assert!(!parts(soft, 1e-3, hold, 0.0));
    assert!(parts(soft, 1e-3, 1e-5, 0.0));
}

#[test]
fn dry_friction_holds_and_lets_go_in_either_contact() {
    // Below its friction the motor does not move; above it, it moves as if pushed by the rest.
    let mut input = DriveInput::new(
        Drive {
            motor: body(J1, 0.05),
            load: body(J2, 0.02),
            ..drive(Contact::Rigid { restitution: 0.0 })
        },
        Command::Torque(0.049),
        0.1,
        Some(0.1),
    );
    let held = run(&input).unwrap();
    assert_eq!(held.x1.last(), Some(&0.0));
    input.command = Command::Torque(0.06);
    let moves = run(&input).unwrap();
    let first = moves.events[0];
    let time = (2.0 * BETA * J1 / 0.01).sqrt();
    assert!(((first.time) / time - 1.0).abs() < 1e-12, "{first:?}");
    // With the load its friction is too much: both come to rest together.
    let stuck = moves.events.last().unwrap();
    assert_eq!(stuck.kind, EventKind::Stick(Mass::Load));
    let common = 0.01 / J1 * time * J1 / (J1 + J2);
    let runs_on = 0.5 * common * common * (J1 + J2) / (0.07 - 0.06);
    assert!(((stuck.x2) / runs_on - 1.0).abs() < 1e-12, "{stuck:?}");
}

#[test]
fn a_relay_that_switches_without_end_is_cut_and_said_so() {
    let relay = VelocityRelay {
        relay: Relay {
            gain: 0.5,
            hysteresis: 0.0,
            ..Relay::default()
        },
        flip: None,
        sampling: None,
    };
    let input = DriveInput::new(
        drive(Contact::Rigid { restitution: 1.0 }),
        Command::Relay(relay),
        1.0,
        None,
    );
    assert!(run(&input).unwrap().chattering.is_some());
}

#[test]
fn no_gap_at_all_is_a_drive_of_one_mass() {
    let relay = VelocityRelay {
        relay: Relay {
            gain: 0.5,
            hysteresis: 0.5,
            ..Relay::default()
        },
        flip: None,
        sampling: None,
    };
    let mut input = DriveInput::new(
        drive(Contact::Rigid { restitution: 0.0 }),
        Command::Relay(relay),
        0.2,
        None,
    );
    input.drive.half_gap = 0.0;
    let done = run(&input).unwrap();
    assert_eq!(done.chattering, None);
    let ups: Vec<f64> = done
        .events
        .iter()
        .filter(|e| e.kind == EventKind::SwitchUp)
        .map(|e| e.time)
        .collect();
    // m eps/k from crest to zero, four times.
    let period = 4.0 * (J1 + J2) * 0.5 / 0.5;
    assert!(((ups[3] - ups[2]) / period - 1.0).abs() < 1e-9, "{ups:?}");
}

#[test]
fn what_cannot_be_is_refused_with_its_range() {
    let good = thrown(Contact::Rigid { restitution: 1.0 }, 1.0);
    let refused = |change: fn(&mut DriveInput), part: &str| {
        let mut input = good;
        change(&mut input);
        let said = run(&input).unwrap_err().to_string();
        assert!(said.contains(part), "{said}");
    };
    refused(
        |i| i.drive.motor.inertia = 0.0,
        "motor inertia is 0: it must be above 0",
    );
    refused(|i| i.drive.load.coulomb = f64::NAN, "load coulomb");
    refused(|i| i.drive.half_gap = -1.0, "half gap");
    refused(
        |i| i.drive.contact = Contact::Rigid { restitution: 1.5 },
        "restitution is 1.5",
    );
    refused(|i| i.duration = 0.0, "duration");
    refused(|i| i.step = Some(1e-9), "number of samples");
    refused(|i| i.start.x1 = 1.0, "start x1 - x2");
}
