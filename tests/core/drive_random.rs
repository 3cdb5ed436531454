//! Any drive that is allowed runs to its end, keeps its books, and stays within its gap.

use hysteron_core::drive::{
    Adhesion, Body, Command, Contact, Drive, DriveInput, EventKind, Start, VelocityRelay, run,
};
use hysteron_core::relay::Relay;
use proptest::prelude::*;

fn body() -> impl Strategy<Value = Body> {
    (
        -4.5..-2.0_f64,
        prop_oneof![Just(0.0), 0.0..0.02_f64],
        prop_oneof![Just(0.0), 0.0..0.3_f64],
    )
        .prop_map(|(inertia, viscous, coulomb)| Body {
            inertia: 10_f64.powf(inertia),
            viscous,
            coulomb,
        })
}

fn contact() -> impl Strategy<Value = Contact> {
    prop_oneof![
        prop_oneof![Just(0.0), Just(1.0), 0.0..0.95_f64]
            .prop_map(|restitution| Contact::Rigid { restitution }),
        (1.0..4.5_f64, prop_oneof![Just(0.0), 0.0..1.0_f64]).prop_map(|(stiffness, damping)| {
            Contact::Compliant {
                stiffness: 10_f64.powf(stiffness),
                damping,
            }
        }),
    ]
}

fn relay() -> impl Strategy<Value = VelocityRelay> {
    (
        0.05..1.0_f64,
        0.05..3.0_f64,
        -0.5..0.5_f64,
        prop_oneof![Just(0.0), 0.0..2e-3_f64],
        prop_oneof![Just(None), (0.02..0.2_f64).prop_map(Some)],
        prop_oneof![Just(None), (1e-4..1e-3_f64).prop_map(Some)],
    )
        .prop_map(
            |(gain, hysteresis, asymmetry, delay, flip, sampling)| VelocityRelay {
                relay: Relay {
                    gain,
                    hysteresis,
                    asymmetry,
                    delay,
                    ..Relay::default()
                },
                flip,
                sampling,
            },
        )
}

fn input() -> impl Strategy<Value = DriveInput> {
    let pull = || prop_oneof![Just(0.0), 0.0..0.05_f64];
    (
        (body(), body(), contact(), relay()),
        (
            prop_oneof![Just(0.0), 1e-4..0.02_f64],
            pull(),
            pull(),
            -1.0..1.0_f64,
            -1.0..1.0_f64,
            -1.0..1.0_f64,
        ),
    )
        .prop_map(
            |((motor, load, contact, relay), (half_gap, upper, lower, x, v1, v2))| {
                let drive = Drive {
                    motor,
                    load,
                    half_gap,
                    contact,
                    adhesion: Adhesion { upper, lower },
                };
                DriveInput {
                    start: Start {
                        x1: x * half_gap,
                        v1,
                        x2: 0.0,
                        v2,
                    },
                    ..DriveInput::new(drive, Command::Relay(relay), 0.3, Some(1e-3))
                }
            },
        )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn any_drive_runs_to_its_end_and_keeps_its_books(input in input()) {
        let done = run(&input).unwrap();
        // Pressed together without any loss, masses tremble as long as the pressure lasts: that run may be
        // cut, and says so. Every other one ends.
        let lossless = input.drive.contact == Contact::Rigid { restitution: 1.0 };
        if !lossless || done.chattering.is_none() {
            prop_assert_eq!(done.chattering, None, "{} events", done.events.len());
            prop_assert_eq!(done.time.len(), 301);
        }
        let e = done.energy;
        let turned_over = e.initial + e.supplied.abs() + e.coulomb + e.viscous + e.contact.abs() + e.kinetic;
        prop_assert!(e.residual().abs() <= 1e-9 * turned_over, "{:?}: {:e}", e, e.residual());
        prop_assert!(e.coulomb >= 0.0 && e.viscous >= 0.0);
        for pair in done.events.windows(2) {
            prop_assert!(pair[0].time <= pair[1].time);
        }
        if let Contact::Rigid { restitution } = input.drive.contact {
            let beta = input.drive.half_gap;
            for (x1, x2) in done.x1.iter().zip(&done.x2) {
                prop_assert!((x1 - x2).abs() <= beta + 1e-12, "{} {}", x1 - x2, beta);
            }
            for event in &done.events {
                if let EventKind::Impact(side, approach) = event.kind {
                    let parting = -side.sign() * (event.v1 - event.v2);
                    prop_assert!((parting - restitution * approach).abs() <= 1e-12 * approach.max(1.0));
                }
            }
        }
        // The same again, in pieces: not a bit differs.
        let mut job = hysteron_core::drive::DriveJob::new(&input).unwrap();
        while !job.advance(7) {}
        prop_assert_eq!(job.finish(), done);
    }
}

fn free(inertia: f64) -> Body {
    Body {
        inertia,
        viscous: 0.0,
        coulomb: 0.0,
    }
}

/// Runs a drive under a relay from rest in the middle of its gap, but for the speed of its load.
fn ends(motor: Body, load: Body, half_gap: f64, contact: Contact, relay: VelocityRelay, v2: f64) {
    let drive = Drive {
        motor,
        load,
        half_gap,
        contact,
        adhesion: Adhesion::default(),
    };
    let mut input = DriveInput::new(drive, Command::Relay(relay), 0.3, Some(1e-3));
    input.start.v2 = v2;
    let done = run(&input).unwrap();
    assert_eq!(done.chattering, None, "{} events", done.events.len());
    assert_eq!(done.time.len(), 301);
}

fn plain(gain: f64, hysteresis: f64) -> VelocityRelay {
    VelocityRelay {
        relay: Relay {
            gain,
            hysteresis,
            ..Relay::default()
        },
        ..VelocityRelay::default()
    }
}

/// Round-off of the gap alone carries the force of a stiff spring back and forth over the friction.
#[test]
fn a_light_load_breaks_loose_once() {
    let load = Body {
        coulomb: 0.004_605_887_209_219_839,
        ..free(0.000_115_409_893_300_219_79)
    };
    let contact = Contact::Compliant {
        stiffness: 18_146.104_862_106_862,
        damping: 0.0,
    };
    let relay = plain(0.05, 2.563_904_253_256_864_3);
    ends(
        free(0.01),
        load,
        0.012_896_572_773_066_4,
        contact,
        relay,
        0.0,
    );
}

/// A rebound of one unit of round-off comes back as high as it was.
#[test]
fn the_lowest_bounces_die_away() {
    let motor = Body {
        viscous: 0.013_452_451_510_358_06,
        ..free(0.000_143_004_342_966_156_33)
    };
    let load = Body {
        coulomb: 0.177_292_109_719_017_2,
        ..free(0.01)
    };
    let contact = Contact::Rigid {
        restitution: 0.888_896_005_423_528_6,
    };
    let relay = plain(0.05, 2.009_822_651_213_943_4);
    let v2 = -0.847_436_137_825_567_3;
    ends(motor, load, 0.017_808_417_734_747_686, contact, relay, v2);
}

/// Without a gap one end parts where the other touches; what round-off leaves of the depth must vanish.
#[test]
fn a_spring_without_gap_changes_ends() {
    let contact = Contact::Compliant {
        stiffness: 5_809.011_761_498_098,
        damping: 0.0,
    };
    let mut relay = plain(0.306_810_716_578_412_7, 0.742_772_922_311_681_5);
    relay.relay.asymmetry = 0.096_203_297_733_132_78;
    relay.sampling = Some(0.000_416_926_638_676_877_6);
    ends(
        free(5.157_231_871_295_675_6e-5),
        free(0.01),
        0.0,
        contact,
        relay,
        0.0,
    );
}
