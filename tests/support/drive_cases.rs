//! What is hidden in the drives. Strengths are drawn about values that a rig owner would call clearly
//! visible: they raise the error of the baseline to a few times the noise, seldom beyond twenty times.

use super::case::{Bench, Case, Truth};
use hysteron_core::rig::Random;
use hysteron_core::rig::{
    DriveRig, Excitation, Friction, Load, Recorded, Stranger, carried_over, drifting, relay,
};

/// With two levels of input, any static map of it is a gain and an offset, and the gain goes into the
/// inertia: so asymmetry and constant torque are one class.
const OFFSET: &[&str] = &["gain_asymmetry", "constant_load"];

const MULTISINE: Excitation = Excitation::Multisine { amplitude: 0.08 };
const STAIRS: Excitation = Excitation::Staircase { top: 0.3 };

fn coulomb(c: f64) -> Truth {
    Truth::new("coulomb_friction", &["c"], c)
}
fn delay(tau: f64) -> Truth {
    Truth::new("input_delay", &["tau"], tau)
}
fn lag(time: f64) -> Truth {
    Truth::new("actuator_lag", &["T_a"], time)
}
fn asymmetry(a: f64) -> Truth {
    Truth::new("gain_asymmetry", &["a"], a)
}
fn load(torque: f64) -> Truth {
    Truth::new("constant_load", &["F0"], torque)
}
/// What a load may be under a relay of two levels of which the positive one is larger: where it pulls that one down, an
/// actuator that clips it does the same. One that it pushes up, nothing clips.
fn clipped(torque: f64) -> &'static [&'static str] {
    if torque < 0.0 { &["saturation"] } else { &[] }
}

fn cogging(amplitude: f64) -> Truth {
    Truth::new("cogging", &["A", "a", "F_c", "amplitude"], amplitude)
}
fn drag(q: f64) -> Truth {
    Truth::new("quadratic_drag", &["q", "d_q", "b"], q)
}
fn backlash(beta: f64) -> Truth {
    Truth::new("backlash", &["beta"], beta)
}
fn compliance(stiffness: f64) -> Truth {
    Truth::new("joint_compliance", &["K", "k", "K_j"], stiffness)
}
fn saturation(limit: f64) -> Truth {
    Truth::new("saturation", &["u_max", "limit", "U"], limit)
}
fn dead_zone(width: f64) -> Truth {
    Truth::new("dead_zone", &["w", "u_0", "delta"], width)
}

/// A delay that the rig's steps of 10 microseconds meet exactly.
fn whole_steps(delay: f64) -> f64 {
    (delay / 1e-5).round() * 1e-5
}

/// A load like the motor behind a gap with the contact of hardened teeth.
pub fn play(half_gap: f64, coulomb: f64) -> Load {
    Load {
        half_gap,
        stiffness: 800.0,
        damping: 0.15,
        inertia: 8.8e-4,
        viscous: 2e-3,
        coulomb,
    }
}

/// A load behind a shaft.
fn shaft(stiffness: f64, damping: f64) -> Load {
    Load {
        half_gap: 0.0,
        stiffness,
        damping,
        inertia: 8.8e-4,
        viscous: 2e-3,
        coulomb: 0.0,
    }
}

/// A drive with its own inertia and viscous friction.
pub fn bare(random: &mut Random, excitation: Excitation) -> DriveRig {
    DriveRig {
        seed: random.seed(),
        excitation,
        inertia: 8.8e-4 * random.between(0.9, 1.1),
        viscous: 2e-3 * random.between(0.8, 1.2),
        ..DriveRig::default()
    }
}

/// The same with a relay that makes the motor cross the gap.
fn crossing(rig: DriveRig, half_gap: f64, flip: f64) -> DriveRig {
    carried_over(&rig, 3.0 * half_gap, flip, |rig| DriveRig {
        samples: 8000,
        ..rig
    })
}

/// Excitations in which a clean drive must stay clean.
pub fn excitations() -> [Excitation; 4] {
    [relay(0.1), relay(0.0), MULTISINE, STAIRS]
}

/// All drive cases of one seed.
pub fn drive_cases(seed: u64) -> Vec<Case> {
    let mut random = Random::new(seed.wrapping_mul(1000));
    let mut cases = clean(&mut random);
    cases.extend(friction(&mut random));
    cases.extend(input_path(&mut random));
    cases.extend(mechanics(&mut random));
    cases.extend(pairs(&mut random));
    cases.extend(strangers(&mut random));
    cases.extend(sparse(&mut random));
    cases.push(met_again(&mut random));
    cases.extend(held(&mut random));
    cases.extend(along_the_way(&mut random));
    cases.extend(from_outside(&mut random));
    cases.push(bump(&mut random));
    cases
}

/// One place that pushes back, which no effect has.
fn bump(r: &mut Random) -> Case {
    let stranger = Stranger::PositionBump {
        torque: 0.08,
        at: 0.5,
        width: 0.2,
    };
    let rig = DriveRig {
        stranger: Some(stranger),
        ..bare(r, MULTISINE)
    };
    Case::unknown("unknown: bump at one place", Bench::Drive(rig))
}

/// What depends on where the motor is.
fn along_the_way(r: &mut Random) -> Vec<Case> {
    let (stiffness, upper) = (r.between(3.0, 8.0), r.between(0.8, 1.2));
    let stops = Stranger::EndStops {
        stiffness,
        damping: r.between(4e-3, 8e-3),
        upper,
        lower: -r.between(0.8, 1.2),
    };
    let (level, slope) = (r.between(0.04, 0.05), r.between(2e-3, 3e-3));
    let (share, off) = (r.between(0.1, 0.2), r.between(3e-3, 6e-3));
    let ripple = Stranger::Ripple {
        share,
        periods: r.between(3.0, 8.0).round(),
        phase: r.between(-3.0, 3.0),
    };
    let disc = Stranger::EccentricEncoder {
        share: off,
        phase: r.between(-3.0, 3.0),
    };
    let torque = r.between(0.02, 0.03);
    let make = |r: &mut Random, name, truths, excitation, friction, stranger| {
        let rig = DriveRig {
            stranger: Some(stranger),
            friction,
            ..bare(r, excitation)
        };
        Case::drive(name, truths, rig)
    };
    let none = Friction::dry(0.0);
    vec![
        make(
            r,
            "end stops",
            vec![Truth::new("end_stop", &["x_h"], upper)],
            MULTISINE,
            none,
            stops,
        ),
        make(
            r,
            "friction along the way",
            vec![
                coulomb(level),
                Truth::new("position_friction", &["g"], slope),
            ],
            MULTISINE,
            Friction::dry(level),
            Stranger::TightEnd { slope },
        ),
        Case::drive(
            "cogging with a harmonic",
            vec![Truth::new("cogging_harmonics", &["b"], torque)],
            DriveRig {
                cogging: (
                    r.between(0.03, 0.05),
                    r.between(3.0, 8.0).round(),
                    r.between(-3.0, 3.0),
                ),
                stranger: Some(Stranger::SecondWave {
                    torque,
                    phase: r.between(-3.0, 3.0),
                }),
                friction: none,
                ..bare(r, MULTISINE)
            },
        ),
        make(
            r,
            "torque ripple",
            vec![Truth::new("torque_ripple", &["a"], share)],
            MULTISINE,
            none,
            ripple,
        ),
        make(
            r,
            "eccentric encoder",
            vec![Truth::new("encoder_eccentricity", &["e"], off)],
            STAIRS,
            none,
            disc,
        ),
    ]
}

/// What the input path and the surroundings do.
fn from_outside(r: &mut Random) -> Vec<Case> {
    let (torque, rate) = (r.between(0.01, 0.02), r.between(8.0, 12.0));
    let shaking = Stranger::Shaking {
        torque,
        period: r.between(0.13, 0.3),
        phase: r.between(-3.0, 3.0),
    };
    let cases = [
        (
            "shaken",
            Truth::new("periodic_disturbance", &["a"], torque),
            STAIRS,
            shaking,
        ),
        (
            "slow amplifier",
            Truth::new("rate_limit", &["r"], rate),
            MULTISINE,
            Stranger::SlowAmplifier { rate },
        ),
    ];
    let hidden = |(name, truth, excitation, stranger)| {
        let rig = DriveRig {
            stranger: Some(stranger),
            ..bare(r, excitation)
        };
        Case::drive(name, vec![truth], rig)
    };
    cases.into_iter().map(hidden).collect()
}

/// What holds the motor at a place, and friction that is none of the plain kinds.
fn held(r: &mut Random) -> Vec<Case> {
    let (torque, stiffness, hard) = (
        r.between(0.06, 0.1),
        r.between(0.04, 0.06),
        r.between(0.02, 0.04),
    );
    let (share, level, half) = (
        r.between(0.15, 0.25),
        r.between(0.03, 0.05),
        r.between(2.0, 4.0),
    );
    let cases = [
        (
            "gravity",
            MULTISINE,
            Truth::new("gravity", &["a"], torque),
            Stranger::Gravity { torque },
        ),
        (
            "spring",
            STAIRS,
            Truth::new("return_spring", &["k"], stiffness),
            Stranger::Spring { stiffness },
        ),
        (
            "hardening spring",
            STAIRS,
            Truth::new("hardening_spring", &["k3"], hard),
            Stranger::HardeningSpring { stiffness: hard },
        ),
        (
            "load-dependent friction",
            MULTISINE,
            Truth::new("load_dependent_friction", &["m"], share),
            Stranger::LoadFriction { share },
        ),
        (
            "flattening friction",
            MULTISINE,
            Truth::new("flattening_friction", &["c"], level),
            Stranger::FlatteningFriction { level, half },
        ),
    ];
    cases
        .into_iter()
        .map(|(name, excitation, truth, stranger)| {
            let rig = DriveRig {
                stranger: Some(stranger),
                ..bare(r, excitation)
            };
            Case::drive(name, vec![truth], rig)
        })
        .collect()
}

/// A gap of which no drift tells: motor and load meet again and again.
fn met_again(r: &mut Random) -> Case {
    let beta = r.between(0.01, 0.04);
    let rig = DriveRig {
        load: Some(play(beta, 0.0)),
        ..bare(r, MULTISINE)
    };
    Case::drive("backlash, multisine", vec![backlash(beta)], rig)
}

fn clean(r: &mut Random) -> Vec<Case> {
    let names = [
        "clean, relay",
        "clean, symmetric relay",
        "clean, multisine",
        "clean, staircase",
    ];
    names
        .into_iter()
        .zip(excitations())
        .map(|(name, excitation)| Case::drive(name, vec![], bare(r, excitation)))
        .collect()
}

fn friction(r: &mut Random) -> Vec<Case> {
    let mut cases = Vec::new();
    for (name, excitation, recorded) in [
        ("Coulomb, relay", relay(0.1), Recorded::Both),
        ("Coulomb, multisine", MULTISINE, Recorded::Both),
        (
            "Coulomb, staircase, position only",
            STAIRS,
            Recorded::PositionOnly,
        ),
        (
            "Coulomb, relay, velocity only",
            relay(0.1),
            Recorded::VelocityOnly,
        ),
    ] {
        let c = r.between(0.02, 0.05);
        let friction = Friction::dry(c);
        let rig = bare(r, excitation);
        cases.push(Case::drive(
            name,
            vec![coulomb(c)],
            DriveRig {
                recorded,
                friction,
                ..rig
            },
        ));
    }
    for (name, ratio, excitation) in [
        ("Stribeck, multisine", 2.0, MULTISINE),
        ("Stribeck, strong", 2.6, MULTISINE),
        ("Stribeck, staircase", 2.0, STAIRS),
    ] {
        let c = r.between(0.02, 0.035);
        let friction = Friction {
            coulomb: c,
            standing: ratio * c,
            stribeck_velocity: r.between(0.6, 1.5),
            displacement: 2e-5,
        };
        let truth = Truth::new("stribeck_friction", &["c"], c);
        let rig = bare(r, excitation);
        cases.push(Case::drive(name, vec![truth], DriveRig { friction, ..rig }));
    }
    for (name, excitation, yields) in [
        ("presliding, multisine", MULTISINE, 1.0),
        ("presliding, staircase", STAIRS, 1.0),
        ("presliding, far", MULTISINE, 20.0),
    ] {
        // The bristle yields over milliradians, as in a preloaded bearing, or over far more, as in a seal of rubber.
        let c = r.between(0.04, 0.06);
        let friction = Friction {
            displacement: yields * r.between(2e-3, 5e-3),
            ..Friction::dry(c)
        };
        let truth = Truth::new("presliding_friction", &["c", "F_c"], c);
        let rig = bare(r, excitation);
        cases.push(Case::drive(name, vec![truth], DriveRig { friction, ..rig }));
    }
    for (name, excitation) in [
        ("quadratic drag, multisine", MULTISINE),
        ("quadratic drag, staircase", STAIRS),
    ] {
        let q = r.between(4e-5, 8e-5);
        let rig = bare(r, excitation);
        cases.push(Case::drive(
            name,
            vec![drag(q)],
            DriveRig {
                quadratic_drag: q,
                ..rig
            },
        ));
    }
    cases
}

fn input_path(r: &mut Random) -> Vec<Case> {
    let mut cases = Vec::new();
    for (name, excitation) in [
        ("delay, relay", relay(0.1)),
        ("delay, multisine", MULTISINE),
    ] {
        let tau = whole_steps(r.between(0.4e-3, 1.1e-3));
        let rig = bare(r, excitation);
        cases.push(Case::drive(
            name,
            vec![delay(tau)],
            DriveRig { delay: tau, ..rig },
        ));
    }
    for (name, excitation) in [("lag, relay", relay(0.1)), ("lag, staircase", STAIRS)] {
        let time = r.between(0.5e-3, 1.2e-3);
        let rig = bare(r, excitation);
        let rig = DriveRig {
            actuator_lag: time,
            ..rig
        };
        cases.push(Case::drive(name, vec![lag(time)], rig));
    }
    let a = r.between(0.03, 0.08);
    let rig = DriveRig {
        gain_asymmetry: a,
        ..bare(r, STAIRS)
    };
    cases.push(Case::drive("asymmetry, staircase", vec![asymmetry(a)], rig));
    let rig = DriveRig {
        gain_asymmetry: a,
        ..bare(r, relay(0.0))
    };
    cases.push(Case::drive(
        "asymmetry, symmetric relay",
        vec![asymmetry(a).same(OFFSET)],
        rig,
    ));
    let torque = r.sign() * r.between(0.01, 0.03);
    let rig = DriveRig {
        constant_load: torque,
        ..bare(r, STAIRS)
    };
    cases.push(Case::drive("load, staircase", vec![load(torque)], rig));
    let rig = DriveRig {
        constant_load: torque,
        ..bare(r, MULTISINE)
    };
    cases.push(Case::drive("load, multisine", vec![load(torque)], rig));
    let rig = DriveRig {
        constant_load: torque,
        ..bare(r, relay(0.1))
    };
    cases.push(Case::drive(
        "load, relay",
        vec![load(torque).same(OFFSET).alike(clipped(torque))],
        rig,
    ));
    let limit = r.between(0.22, 0.27);
    let rig = DriveRig {
        saturation: limit,
        ..bare(r, STAIRS)
    };
    cases.push(Case::drive(
        "saturation, staircase",
        vec![saturation(limit)],
        rig,
    ));
    let limit = r.between(0.3, 0.4);
    let rig = DriveRig {
        saturation: limit,
        ..bare(r, MULTISINE)
    };
    cases.push(Case::drive(
        "saturation, multisine",
        vec![saturation(limit)],
        rig,
    ));
    for (name, excitation) in [
        ("dead zone, multisine", MULTISINE),
        ("dead zone, staircase", STAIRS),
    ] {
        let width = r.between(0.015, 0.03);
        let rig = DriveRig {
            dead_zone: width,
            ..bare(r, excitation)
        };
        cases.push(Case::drive(name, vec![dead_zone(width)], rig));
    }
    let time = r.between(0.5e-3, 1.1e-3);
    let truth = Truth::new("sensor_lag", &["T_s", "T_m"], time);
    let rig = DriveRig {
        sensor_lag: time,
        ..bare(r, MULTISINE)
    };
    cases.push(Case::drive(
        "sensor lag, multisine",
        vec![truth.clone()],
        rig,
    ));
    let c = r.between(0.03, 0.05);
    let friction = Friction::dry(c);
    let rig = DriveRig {
        sensor_lag: time,
        friction,
        ..bare(r, MULTISINE)
    };
    cases.push(Case::drive(
        "sensor lag and Coulomb",
        vec![truth, coulomb(c)],
        rig,
    ));
    cases
}

fn mechanics(r: &mut Random) -> Vec<Case> {
    let mut cases = Vec::new();
    for (name, excitation) in [
        ("cogging, multisine", MULTISINE),
        ("cogging, staircase", STAIRS),
    ] {
        let amplitude = r.between(0.02, 0.05);
        let periods = r.between(3.0, 12.0).round();
        let force = (amplitude, periods, r.between(-3.0, 3.0));
        let rig = DriveRig {
            cogging: force,
            ..bare(r, excitation)
        };
        cases.push(Case::drive(name, vec![cogging(amplitude)], rig));
    }
    for (name, flip, friction) in [
        ("backlash, drifting relay", 1.5, 0.01),
        ("backlash, dry load", 2.0, 0.03),
    ] {
        let beta = r.between(0.002, 0.004);
        let rig = DriveRig {
            load: Some(play(beta, friction)),
            samples: 25_000,
            ..bare(r, drifting(flip))
        };
        let rig = crossing(rig, beta, flip);
        cases.push(Case::drive(name, vec![backlash(beta)], rig));
    }
    for (name, damping) in [("compliance, multisine", 0.0), ("compliance, damped", 2e-3)] {
        let stiffness = r.between(10.0, 30.0);
        let rig = DriveRig {
            load: Some(shaft(stiffness, damping)),
            ..bare(r, MULTISINE)
        };
        cases.push(Case::drive(name, vec![compliance(stiffness)], rig));
    }
    cases
}

fn pairs(r: &mut Random) -> Vec<Case> {
    let c = r.between(0.03, 0.05);
    let tau = whole_steps(r.between(0.4e-3, 0.9e-3));
    let time = r.between(0.5e-3, 1e-3);
    let friction = Friction::dry(c);
    let mut make = |name, truths, excitation, change: &dyn Fn(DriveRig) -> DriveRig| {
        Case::drive(name, truths, change(bare(r, excitation)))
    };
    vec![
        make(
            "Coulomb and delay",
            vec![coulomb(c), delay(tau)],
            relay(0.1),
            &|rig| DriveRig {
                friction,
                delay: tau,
                ..rig
            },
        ),
        make(
            "Coulomb and lag",
            vec![coulomb(c), lag(time)],
            relay(0.1),
            &|rig| DriveRig {
                friction,
                actuator_lag: time,
                ..rig
            },
        ),
        make(
            "Coulomb and load",
            vec![coulomb(c), load(0.02)],
            STAIRS,
            &|rig| DriveRig {
                friction,
                constant_load: 0.02,
                ..rig
            },
        ),
        make(
            "Coulomb and asymmetry",
            vec![coulomb(c), asymmetry(0.06)],
            STAIRS,
            &|rig| DriveRig {
                friction,
                gain_asymmetry: 0.06,
                ..rig
            },
        ),
        make(
            "delay and load, symmetric relay",
            vec![delay(tau), load(0.02).alike(OFFSET)],
            relay(0.0),
            &|rig| DriveRig {
                delay: tau,
                constant_load: 0.02,
                ..rig
            },
        ),
        make(
            "cogging and Coulomb",
            vec![cogging(0.04), coulomb(c)],
            MULTISINE,
            &|rig| DriveRig {
                cogging: (0.04, 6.0, 0.4),
                friction,
                ..rig
            },
        ),
        make(
            "cogging and load",
            vec![cogging(0.03), load(0.02)],
            MULTISINE,
            &|rig| DriveRig {
                cogging: (0.03, 8.0, 1.0),
                constant_load: 0.02,
                ..rig
            },
        ),
        make(
            "drag and Coulomb",
            vec![drag(6e-5), coulomb(c)],
            MULTISINE,
            &|rig| DriveRig {
                quadratic_drag: 6e-5,
                friction,
                ..rig
            },
        ),
        make(
            "drag and asymmetry",
            vec![drag(6e-5), asymmetry(0.05)],
            STAIRS,
            &|rig| DriveRig {
                quadratic_drag: 6e-5,
                gain_asymmetry: 0.05,
                ..rig
            },
        ),
        make(
            "compliance and delay",
            vec![compliance(18.0), delay(tau)],
            MULTISINE,
            &|rig| DriveRig {
                load: Some(shaft(18.0, 1e-3)),
                delay: tau,
                ..rig
            },
        ),
        make(
            "saturation and Coulomb",
            vec![saturation(0.32), coulomb(c)],
            MULTISINE,
            &|rig| DriveRig {
                saturation: 0.32,
                friction,
                ..rig
            },
        ),
        make(
            "dead zone and delay",
            vec![dead_zone(0.025), delay(tau)],
            MULTISINE,
            &|rig| DriveRig {
                dead_zone: 0.025,
                delay: tau,
                ..rig
            },
        ),
        make(
            "backlash and Coulomb",
            vec![backlash(0.003), coulomb(c)],
            drifting(1.5),
            &|rig| {
                let load = Some(play(0.003, 0.01));
                let rig = DriveRig {
                    load,
                    friction,
                    samples: 25_000,
                    ..rig
                };
                crossing(rig, 0.003, 1.5)
            },
        ),
        make(
            "backlash and delay",
            vec![backlash(0.003), delay(tau)],
            drifting(1.5),
            &|rig| {
                let rig = DriveRig {
                    load: Some(play(0.003, 0.01)),
                    delay: tau,
                    samples: 25_000,
                    ..rig
                };
                crossing(rig, 0.003, 1.5)
            },
        ),
    ]
}

fn strangers(r: &mut Random) -> Vec<Case> {
    let strange = [
        (
            "unknown: one pulse",
            STAIRS,
            Stranger::Pulse {
                torque: 0.05,
                from: 0.9,
                length: 0.08,
            },
        ),
        (
            "unknown: gain falls with speed",
            MULTISINE,
            Stranger::GainFallsWithSpeed { v0: 60.0 },
        ),
        (
            "unknown: hysteresis of the torque",
            MULTISINE,
            Stranger::Hysteresis {
                share: 0.3,
                width: 0.08,
            },
        ),
        (
            "unknown: bump at one speed",
            MULTISINE,
            Stranger::SpeedBump {
                torque: 0.05,
                centre: 8.0,
                width: 1.5,
            },
        ),
        (
            "unknown: warming",
            STAIRS,
            Stranger::Warming { factor: 0.5 },
        ),
        (
            "unknown: hard spot",
            STAIRS,
            Stranger::HardSpot {
                torque: 0.06,
                at: 0.5,
                width: 0.1,
            },
        ),
    ];
    strange
        .into_iter()
        .map(|(name, excitation, stranger)| {
            let rig = DriveRig {
                stranger: Some(stranger),
                ..bare(r, excitation)
            };
            Case::unknown(name, Bench::Drive(rig))
        })
        .collect()
}

/// A record that keeps every second value of an input that moves in even steps: their mean is a quarter of the way from
/// one kept value to the next.
fn sparse(r: &mut Random) -> Vec<Case> {
    const EVERY: usize = 2;
    let c = r.between(0.03, 0.05);
    let rig = DriveRig {
        friction: Friction::dry(c),
        samples: 10_000 * EVERY,
        ..bare(r, MULTISINE)
    };
    let truths = vec![Truth::new("sampled_input", &["h"], 0.25), coulomb(c)];
    // A later value that is late besides does the same.
    let only = Truth {
        value: None,
        ..Truth::new("sampled_input", &["h"], 0.25)
    };
    let alone = DriveRig {
        friction: DriveRig::default().friction,
        ..rig
    };
    vec![
        Case::sparse("sampled and Coulomb", truths, rig, EVERY),
        Case::sparse("sampled, multisine", vec![only], alone, EVERY),
    ]
}
