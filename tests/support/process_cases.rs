//! What is hidden in the processes.

use super::case::{Bench, Case, Truth};
use hysteron_core::rig::Random;
use hysteron_core::rig::process::{Excitation, ProcessRig, Stranger};

/// With two levels of input, a static map of it is a gain and an offset.
const OFFSET: &[&str] = &["gain_asymmetry", "constant_load"];
/// Two lags in a row are the same in either order.
const LAG: &[&str] = &["second_lag", "sensor_lag"];

const RELAY: Excitation = Excitation::Relay {
    gain: 1.0,
    hysteresis: 0.1,
};
const STAIRS: Excitation = Excitation::Staircase { top: 1.0 };
const BINARY: Excitation = Excitation::Binary { level: 1.0 };

fn delay(tau: f64) -> Truth {
    Truth::new("input_delay", &["tau"], tau)
}
fn lag(time: f64) -> Truth {
    Truth::new("second_lag", &["T2"], time).same(LAG)
}
fn asymmetry(a: f64) -> Truth {
    Truth::new("gain_asymmetry", &["a"], a)
}
fn load(d: f64) -> Truth {
    Truth::new("constant_load", &["F0"], d)
}
fn ramp(slope: f64) -> Truth {
    Truth::new("load_ramp", &["r", "slope", "rate"], slope)
}
fn saturation(limit: f64) -> Truth {
    Truth::new("saturation", &["u_max", "limit", "U"], limit)
}
fn curvature(b: f64) -> Truth {
    Truth {
        value: None,
        ..Truth::new("static_curvature", &["b"], b)
    }
}

/// A process with its own gain and time constant.
pub fn bare(random: &mut Random, excitation: Excitation) -> ProcessRig {
    ProcessRig {
        seed: random.seed(),
        excitation,
        gain: 2.0 * random.between(0.9, 1.1),
        time_constant: 30.0 * random.between(0.85, 1.15),
        ..ProcessRig::default()
    }
}

/// Excitations in which a clean process must stay clean.
pub fn excitations() -> [Excitation; 3] {
    [RELAY, STAIRS, BINARY]
}

/// All process cases of one seed.
pub fn process_cases(seed: u64) -> Vec<Case> {
    let mut random = Random::new(seed.wrapping_mul(1000) + 500);
    let mut cases = singles(&mut random);
    cases.extend(pairs(&mut random));
    cases.extend(strangers(&mut random));
    cases.extend(valve(&mut random));
    cases.push(emptying(&mut random));
    cases.extend(valves(&mut random));
    cases.extend(swinging(&mut random));
    cases
}

/// Valves that do not do as they are told.
fn valves(r: &mut Random) -> Vec<Case> {
    let (rate, width) = (r.between(0.1, 0.2), r.between(0.06, 0.12));
    let (band, share) = (r.between(0.2, 0.35), r.between(0.3, 0.6));
    let jump = share * band;
    let cases = [
        (
            "slow valve",
            Truth::new("rate_limit", &["r"], rate),
            Stranger::SlowValve { rate },
        ),
        (
            "dead band",
            Truth::new("dead_zone", &["z"], width),
            Stranger::DeadBand { width },
        ),
        (
            "slipping valve",
            Truth::new("valve_stiction", &["b"], (band - jump) / 2.0),
            Stranger::SlippingValve { band, jump },
        ),
    ];
    let hidden = |(name, truth, stranger)| {
        let stranger = Some(stranger);
        Case::process(
            name,
            vec![truth],
            ProcessRig {
                stranger,
                ..bare(r, STAIRS)
            },
        )
    };
    cases.into_iter().map(hidden).collect()
}

/// What swings before it settles, damped by 0.15 to 0.6 of what would stop that.
fn swinging(r: &mut Random) -> Vec<Case> {
    let mut make = |name, late: bool, slow: bool, excitation| {
        let period = r.between(15.0, 30.0);
        let damping = r.between(0.15, 0.6);
        let dead_time = if late { r.between(2.0, 4.0) } else { 0.0 };
        let sensor_lag = if slow { r.between(2.0, 4.0) } else { 0.0 };
        let rig = ProcessRig {
            swing_period: period,
            sensor_lag,
            time_constant: damping * period / std::f64::consts::PI,
            dead_time,
            ..bare(r, excitation)
        };
        let mut truth = vec![Truth::new("underdamped", &["P"], period)];
        truth.extend(late.then(|| delay(dead_time)));
        truth.extend(slow.then(|| Truth::new("sensor_lag", &["T_s"], sensor_lag).same(LAG)));
        Case::process(name, truth, rig)
    };
    vec![
        make("swinging, staircase", false, false, STAIRS),
        make("swinging, binary", false, false, BINARY),
        make("swinging and dead time", true, false, BINARY),
        make("swinging and sensor lag", false, true, BINARY),
    ]
}

/// A tank that empties through a hole.
fn emptying(r: &mut Random) -> Case {
    let flow = r.between(0.3, 0.5);
    let rig = ProcessRig {
        stranger: Some(Stranger::Outflow { flow }),
        ..bare(r, STAIRS)
    };
    Case::process("outflow", vec![Truth::new("outflow", &["a"], flow)], rig)
}

/// The valve opens more on one side than on the other.
fn valve(r: &mut Random) -> Vec<Case> {
    let b = r.sign() * r.between(0.05, 0.15);
    let rig = ProcessRig {
        valve_curvature: b,
        ..bare(r, STAIRS)
    };
    let case = Case::process("curved valve, staircase", vec![curvature(b)], rig);
    vec![case]
}

fn singles(r: &mut Random) -> Vec<Case> {
    let mut cases = Vec::new();
    let clean = [
        "clean process, relay",
        "clean process, staircase",
        "clean process, binary",
    ];
    for (name, excitation) in clean.into_iter().zip(excitations()) {
        cases.push(Case::process(name, vec![], bare(r, excitation)));
    }
    for (name, excitation) in [("dead time, relay", RELAY), ("dead time, binary", BINARY)] {
        let tau = r.between(3.0, 8.0);
        let rig = ProcessRig {
            dead_time: tau,
            ..bare(r, excitation)
        };
        cases.push(Case::process(name, vec![delay(tau)], rig));
    }
    for (name, excitation) in [("second lag, relay", RELAY), ("second lag, binary", BINARY)] {
        let time = r.between(4.0, 8.0);
        let rig = ProcessRig {
            second_lag: time,
            ..bare(r, excitation)
        };
        cases.push(Case::process(name, vec![lag(time)], rig));
    }
    let a = r.between(0.08, 0.16);
    let rig = ProcessRig {
        gain_asymmetry: a,
        ..bare(r, STAIRS)
    };
    cases.push(Case::process(
        "asymmetry, staircase",
        vec![asymmetry(a)],
        rig,
    ));
    let rig = ProcessRig {
        gain_asymmetry: a,
        ..bare(r, BINARY)
    };
    cases.push(Case::process(
        "asymmetry, binary",
        vec![asymmetry(a).same(OFFSET)],
        rig,
    ));
    let d = r.sign() * r.between(0.05, 0.12);
    let rig = ProcessRig {
        constant_load: d,
        ..bare(r, STAIRS)
    };
    cases.push(Case::process("load, staircase", vec![load(d)], rig));
    let slope = r.sign() * r.between(3e-4, 8e-4);
    for (name, excitation) in [("ramp, relay", RELAY), ("ramp, staircase", STAIRS)] {
        let rig = ProcessRig {
            load_ramp: slope,
            ..bare(r, excitation)
        };
        cases.push(Case::process(name, vec![ramp(slope)], rig));
    }
    let limit = r.between(0.6, 0.72);
    let rig = ProcessRig {
        saturation: limit,
        ..bare(r, STAIRS)
    };
    cases.push(Case::process(
        "saturation, staircase",
        vec![saturation(limit)],
        rig,
    ));
    let b = r.sign() * r.between(0.04, 0.08);
    let rig = ProcessRig {
        curvature: b,
        ..bare(r, STAIRS)
    };
    cases.push(Case::process(
        "curvature, staircase",
        vec![curvature(b)],
        rig,
    ));
    let time = r.between(3.0, 6.0);
    let truth = Truth::new("sensor_lag", &["T_s", "T_m"], time).same(LAG);
    let rig = ProcessRig {
        sensor_lag: time,
        ..bare(r, BINARY)
    };
    cases.push(Case::process("sensor lag, binary", vec![truth], rig));
    cases
}

fn pairs(r: &mut Random) -> Vec<Case> {
    let tau = r.between(3.0, 6.0);
    let time = r.between(4.0, 8.0);
    let mut make = |name, truths, excitation, change: &dyn Fn(ProcessRig) -> ProcessRig| {
        Case::process(name, truths, change(bare(r, excitation)))
    };
    vec![
        make(
            "dead time and asymmetry, relay",
            vec![delay(tau), asymmetry(0.15).alike(OFFSET)],
            RELAY,
            &|rig| ProcessRig {
                dead_time: tau,
                gain_asymmetry: 0.15,
                ..rig
            },
        ),
        make(
            "dead time and second lag, binary",
            vec![delay(tau), lag(time)],
            BINARY,
            &|rig| ProcessRig {
                dead_time: tau,
                second_lag: time,
                ..rig
            },
        ),
        make(
            "dead time and ramp",
            vec![delay(tau), ramp(5e-4)],
            RELAY,
            &|rig| ProcessRig {
                dead_time: tau,
                load_ramp: 5e-4,
                ..rig
            },
        ),
        make(
            "second lag and load, staircase",
            vec![lag(time), load(0.1)],
            STAIRS,
            &|rig| ProcessRig {
                second_lag: time,
                constant_load: 0.1,
                ..rig
            },
        ),
        make(
            "saturation and dead time",
            vec![saturation(0.65), delay(tau)],
            STAIRS,
            &|rig| ProcessRig {
                saturation: 0.65,
                dead_time: tau,
                ..rig
            },
        ),
        make(
            "curvature and dead time",
            vec![curvature(0.06), delay(tau)],
            STAIRS,
            &|rig| ProcessRig {
                curvature: 0.06,
                dead_time: tau,
                ..rig
            },
        ),
        // Three lags in a row: two of them close to a dead time, and all readings fair that reach the noise.
        make("second and third lag", vec![lag(6.0)], RELAY, &|rig| {
            ProcessRig {
                second_lag: 6.0,
                third_lag: 3.0,
                ..rig
            }
        })
        .or(vec!["second_lag", "input_delay"])
        .or(vec!["second_lag", "sensor_lag"])
        .or(vec!["sensor_lag", "input_delay"])
        .or(vec!["input_delay"]),
    ]
}

fn strangers(r: &mut Random) -> Vec<Case> {
    let mut make = |name, truth: Option<Truth>, excitation, stranger, second_lag| {
        let rig = ProcessRig {
            stranger: Some(stranger),
            second_lag,
            ..bare(r, excitation)
        };
        match truth {
            Some(truth) => Case::process(name, vec![truth], rig),
            None => Case::unknown(name, Bench::Process(rig)),
        }
    };
    let (amplitude, period, width, time) = (0.08, 37.0, 0.1, 6.0);
    // Of time constants in the ratio 1.25, as shares of their mean.
    let asymmetry = 0.25 / 2.25;
    vec![
        make(
            "unknown: gain steps",
            None,
            BINARY,
            Stranger::GainSteps { factor: 0.85 },
            0.0,
        ),
        make(
            "swing",
            Some(Truth::new("periodic_disturbance", &["a"], amplitude)),
            BINARY,
            Stranger::Swing { amplitude, period },
            0.0,
        ),
        make(
            "sticky valve",
            Some(Truth::new("valve_stiction", &["b"], width)),
            STAIRS,
            Stranger::StickyValve { width },
            0.0,
        ),
        make(
            "slow fall",
            Some(Truth::new("directional_lag", &["a"], asymmetry)),
            STAIRS,
            Stranger::SlowFall { factor: 1.25 },
            0.0,
        ),
        make(
            "wrong way first",
            Some(Truth::new("inverse_response", &["T_z"], time)),
            BINARY,
            Stranger::WrongWay { time },
            4.0,
        ),
    ]
}
