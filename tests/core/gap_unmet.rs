//! Drifting tests in which the load is never met, or hangs on a shaft: no switch of the relay, no round-off and no
//! spring is taken for the end of a gap, however the torque was sampled.
//!
//! `cargo test` runs some of the development seeds; `HYSTERON_BENCH=full` runs fifty, and `HYSTERON_BENCH_SEEDS=N`
//! fifty from seed N on.

#![allow(
    clippy::disallowed_methods,
    clippy::disallowed_macros,
    reason = "the core neither prints nor starts threads nor reads the clock; its bench does"
)]

use hysteron_core::backlash::{backlash_map, estimate_gap};
use hysteron_core::drive::{
    self, Adhesion, Body, Command, Contact, Drive, DriveInput, Recorder, VelocityRelay,
};
use hysteron_core::measurement::{Measurement, Quantity};
use hysteron_core::relay::Relay;
use hysteron_core::rig::Random;

use crate::support::record::{channel, of_motor};
use crate::support::threads;

/// Records of the full bench and of `cargo test`.
const FULL: u64 = 50;
const QUICK: u64 = 6;

/// Inertia of a motor, kg m^2.
const INERTIA: f64 = 8.8e-4;

/// How the torque of a sample was written.
#[derive(Clone, Copy, Debug)]
enum Torque {
    /// At the instant of the sample.
    Instant,
    /// Held by a digital relay with the period of the record, or with one of its own in s.
    Held(Option<f64>),
    /// The mean up to the next sample.
    Mean,
}

fn log_between(random: &mut Random, low: f64, high: f64) -> f64 {
    random.between(low.ln(), high.ln()).exp()
}

/// A record of 8 s in which the motor never meets a load.
fn never_met(seed: u64) -> (String, Measurement, bool) {
    let mut random = Random::new(seed.wrapping_mul(7919).wrapping_add(17));
    let step = [5e-5, 1e-4, 2e-4, 2e-4][seed as usize % 4];
    let torque = match seed / 4 % 4 {
        0 => Torque::Instant,
        1 => Torque::Held(None),
        2 => Torque::Held(Some(log_between(&mut random, 3e-5, 4e-4))),
        _ => Torque::Mean,
    };
    let noise = [0.0, 2e-4, 2e-3][(random.uniform() * 3.0) as usize % 3];
    let motor = Body {
        inertia: INERTIA * log_between(&mut random, 0.5, 2.0),
        viscous: 2e-3 * random.between(0.5, 1.5),
        coulomb: random.between(0.0, 0.06),
    };
    let delay = if random.uniform() < 0.5 {
        0.0
    } else {
        random.between(0.0, 4e-4)
    };
    let relay = Relay {
        gain: 0.5 * random.between(0.7, 1.4),
        hysteresis: random.between(0.3, 0.8),
        asymmetry: random.between(0.08, 0.35),
        delay,
        ..Relay::default()
    };
    let sampling = match torque {
        Torque::Held(own) => Some(own.unwrap_or(step)),
        _ => None,
    };
    let name = format!("{seed}: {torque:?}, step {step}, noise {noise}, {motor:?}, {relay:?}");
    let input = DriveInput::new(
        Drive {
            motor,
            load: Body {
                inertia: INERTIA,
                viscous: 2e-3,
                coulomb: 0.05,
            },
            half_gap: 5.0,
            contact: Contact::default(),
            adhesion: Adhesion::default(),
        },
        Command::Relay(VelocityRelay {
            relay,
            flip: Some(random.between(1.5, 2.5)),
            sampling,
        }),
        8.0,
        Some(step),
    );
    let record = if matches!(torque, Torque::Mean) {
        let recorder = Recorder {
            sampling: step,
            velocity_noise: noise,
            seed,
            ..Recorder::default()
        };
        drive::record(&input, &recorder).unwrap()
    } else {
        instantaneous(&drive::run(&input).unwrap(), noise, &mut random)
    };
    (name, record, false)
}

/// The record as `hysteron simulate` writes it, with noise on the velocity.
fn instantaneous(run: &drive::DriveRun, noise: f64, random: &mut Random) -> Measurement {
    let velocity = run.v1.iter().map(|v| v + noise * random.normal()).collect();
    let signals = [run.input.clone(), run.x1.clone(), velocity];
    Measurement {
        reference: vec![channel(Quantity::LoadPosition, "x2", "rad", run.x2.clone())],
        ..of_motor("simulated".to_owned(), run.time.clone(), signals)
    }
}

/// What is claimed of each record, with its name and whether its load is held by dry friction; nothing where nothing
/// is.
fn claims(
    seeds: std::ops::Range<u64>,
    of: impl Fn(u64) -> (String, Measurement, bool) + Sync,
) -> Vec<String> {
    let seeds: Vec<u64> = seeds.collect();
    let claimed = threads::each(&seeds, |seed| {
        let mut found = Vec::new();
        let (name, record, held) = of(*seed);
        let estimate = estimate_gap(&record).unwrap();
        if estimate.gap.is_some() || !estimate.contacts.is_empty() {
            found.push(format!("{name}: {}", estimate.text));
        }
        // A load that dry friction holds against a soft shaft moves as one in a gap.
        let map = backlash_map(&record).ok().and_then(|m| m.gap);
        if let Some(gap) = map.filter(|_| !held) {
            found.push(format!("{name}: a gap of {gap:e} rad by the map"));
        }
        found
    });
    claimed.concat()
}

/// Seeds of this run.
fn seeds() -> std::ops::Range<u64> {
    let full = std::env::var("HYSTERON_BENCH").is_ok_and(|v| v == "full");
    let asked = std::env::var("HYSTERON_BENCH_SEEDS").ok();
    let first = asked.and_then(|s| s.parse().ok()).unwrap_or(1);
    first..first + if full { FULL } else { QUICK }
}

#[test]
fn no_contact_is_claimed_of_a_load_that_was_never_met() {
    let claimed = claims(seeds(), never_met);
    for claim in &claimed {
        println!("{claim}");
    }
    assert_eq!(claimed, Vec::<String>::new());
}

/// A drifting test on a shaft without a gap.
fn shaft(seed: u64) -> (String, Measurement, bool) {
    let mut random = Random::new(seed.wrapping_mul(104_729).wrapping_add(3));
    let load = Body {
        inertia: INERTIA * log_between(&mut random, 0.5, 4.0),
        viscous: 2e-3,
        coulomb: [0.0, 0.02, 0.06][seed as usize % 3],
    };
    let stiffness = log_between(&mut random, 5.0, 2000.0);
    let reduced = INERTIA * load.inertia / (INERTIA + load.inertia);
    let damping = 2.0 * random.between(0.02, 0.4) * (stiffness * reduced).sqrt();
    let noise = [0.0, 2e-3][seed as usize / 3 % 2];
    let input = DriveInput::new(
        Drive {
            motor: Body {
                inertia: INERTIA,
                viscous: 2e-3,
                coulomb: random.between(0.0, 0.04),
            },
            load,
            half_gap: 0.0,
            contact: Contact::Compliant { stiffness, damping },
            adhesion: Adhesion {
                upper: 1e3,
                lower: 1e3,
            },
        },
        Command::Relay(VelocityRelay {
            relay: Relay {
                gain: 0.5,
                hysteresis: 0.5,
                asymmetry: random.between(0.1, 0.3),
                ..Relay::default()
            },
            flip: Some(2.0),
            sampling: None,
        }),
        8.0,
        Some(2e-4),
    );
    let name = format!("{seed}: K {stiffness:.0}, D {damping:.3}, {load:?}, noise {noise}");
    let run = drive::run(&input).unwrap();
    let record = instantaneous(&run, noise, &mut random);
    (name, record, load.coulomb > 0.0)
}

#[test]
fn a_shaft_has_no_gap() {
    let claimed = claims(seeds(), shaft);
    for claim in &claimed {
        println!("{claim}");
    }
    assert_eq!(claimed, Vec::<String>::new());
}
