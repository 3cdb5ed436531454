//! The programs that are tried: what one would do at the bench, sized by the limits and the plant.

use crate::diagnosis::{Limits, Program, Sine};
use crate::measurement::Kind;

/// Samples that are simulated at least; fewer are no experiment.
pub(super) const LEAST_SAMPLES: f64 = 200.0;

/// What the sizes of a program follow from.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sizes {
    pub kind: Kind,
    /// Root mean square of the measured velocity, or output of a process.
    pub speed: f64,
    /// Noise of what a relay sees; `None` where that is not measured.
    pub noise: Option<f64>,
    /// Inertia of a drive.
    pub inertia: f64,
    /// Time constant of a process, s.
    pub time_constant: f64,
    /// Length of the windows in which a drive is judged, s.
    pub window: f64,
    /// Length of the stretch that is simulated, s.
    pub stretch: f64,
}

/// Hysteresis against noise, at least.
const CLEAR_OF_NOISE: f64 = 6.0;

/// Hystereses of relays, in multiples of the measured root mean square.
const HYSTERESES: [f64; 2] = [0.5, 1.2];

/// Asymmetry of a relay that has one.
const ASYMMETRY: f64 = 0.3;

/// Gains in turn, as shares of the largest.
const GAINS: [&[f64]; 2] = [&[1.0, 0.5], &[1.0, 0.3]];

/// Levels of a staircase as shares of the largest: of four sizes, each to and fro and back, so that a drive
/// ends where it began.
const STAIRS: [f64; 16] = [
    0.5, -0.5, -0.5, 0.5, 1.0, -1.0, -1.0, 1.0, 0.25, -0.25, -0.25, 0.25, 0.75, -0.75, -0.75, 0.75,
];

/// Signs of a pseudo-random binary sequence (maximum length, 31), with one more for balance.
const BINARY: [i8; 32] = [
    1, 1, 1, 1, 1, -1, -1, -1, 1, 1, -1, 1, 1, 1, -1, 1, -1, 1, -1, -1, -1, -1, 1, -1, -1, 1, -1,
    1, 1, -1, -1, -1,
];

/// Sines in a sum, and the highest frequency as a share of the sampling rate.
const SINES: i32 = 10;
const HIGHEST: f64 = 0.02;

/// Share of the largest speed to which one step of a staircase brings a drive.
const STEP_SPEED: f64 = 0.4;

/// Every program, the gentlest kind first.
pub(super) fn candidates(sizes: &Sizes, limits: &Limits) -> Vec<Program> {
    let u = limits.input;
    let mut programs = Vec::new();
    // A relay or a sum of sines goes both ways.
    if let Some(noise) = sizes.noise.filter(|_| limits.side == 0) {
        for share in HYSTERESES {
            let hysteresis = round((share * sizes.speed).max(CLEAR_OF_NOISE * noise));
            let relay = |gains: Vec<f64>, hold, asymmetry| Program::Relay {
                gains: gains.into_iter().map(round).collect(),
                hold,
                hysteresis,
                asymmetry,
            };
            programs.push(relay(vec![u], 0.0, 0.0));
            programs.push(relay(vec![u / (1.0 + ASYMMETRY)], 0.0, ASYMMETRY));
            for shares in GAINS {
                let gains = shares.iter().map(|s| s * u).collect();
                programs.push(relay(gains, gain_hold(sizes), 0.0));
            }
        }
    }
    for hold in step_holds(sizes, limits) {
        let levels = STAIRS.iter().map(|s| round(limits.level(*s))).collect();
        programs.push(Program::Levels { levels, hold });
    }
    let levels = BINARY.iter().map(|s| limits.level(f64::from(*s))).collect();
    let clock = match sizes.kind {
        Kind::Drive => 0.04 * sizes.window,
        Kind::Process => (0.15 * sizes.time_constant).min(sizes.stretch / 64.0),
    };
    let hold = whole(clock, limits.step);
    programs.push(Program::Levels { levels, hold });
    if limits.side == 0 {
        programs.push(multisine(sizes, limits));
    }
    programs
}

/// Neither as long as a window nor a part of it: each window shall see another piece.
fn gain_hold(sizes: &Sizes) -> f64 {
    match sizes.kind {
        Kind::Drive => round(0.7 * sizes.window),
        Kind::Process => round(sizes.stretch / 7.0),
    }
}

fn step_holds(sizes: &Sizes, limits: &Limits) -> Vec<f64> {
    let longest = sizes.stretch / (2.0 * STAIRS.len() as f64);
    let wished = match sizes.kind {
        Kind::Drive => {
            let fast = limits.speed.map_or(f64::INFINITY, |v| {
                STEP_SPEED * v * sizes.inertia / limits.input
            });
            [fast.min(0.6 * sizes.window), 0.6 * sizes.window]
        }
        Kind::Process => [0.4 * sizes.time_constant, 1.3 * sizes.time_constant],
    };
    let mut holds: Vec<f64> = wished
        .into_iter()
        .map(|hold| whole(hold.min(longest), limits.step))
        .collect();
    holds.dedup();
    holds
}

/// Sines with phases by Schroeder (1970), so that the peaks stay low.
fn multisine(sizes: &Sizes, limits: &Limits) -> Program {
    let high = HIGHEST / limits.step;
    let low = match sizes.kind {
        Kind::Drive => 1.0 / sizes.window,
        Kind::Process => 0.05 / sizes.time_constant,
    }
    .max(2.0 / sizes.stretch)
    .min(0.5 * high);
    let ratio = libm::pow(high / low, 1.0 / f64::from(SINES - 1));
    let count = f64::from(SINES);
    let sines: Vec<Sine> = (0..SINES)
        .map(|k| Sine {
            amplitude: 1.0,
            frequency: round(low * ratio.powi(k)),
            phase: -std::f64::consts::PI * f64::from(k * k) / count,
        })
        .collect();
    let program = Program::Multisine { sines };
    let mut controller = program.controller();
    let samples = (sizes.stretch / limits.step) as usize;
    let peak = (0..samples)
        .map(|i| controller.command(i as f64 * limits.step, 0.0).abs())
        .fold(f64::MIN_POSITIVE, f64::max);
    // Rounded down: the peak must stay within the limit.
    program.scaled(0.97 * limits.input / peak)
}

/// A multiple of the sampling time, at least four.
fn whole(time: f64, step: f64) -> f64 {
    (time / step).round().max(4.0) * step
}

/// Two digits that count, towards 0: what one would set at the bench.
fn round(value: f64) -> f64 {
    if value == 0.0 || !value.is_finite() {
        return value;
    }
    let unit = libm::pow(10_f64, libm::log10(value.abs()).floor() - 1.0);
    let rounded = (value.abs() / unit + 1e-6).floor() * unit;
    rounded.copysign(value)
}
