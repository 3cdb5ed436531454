//! A drive on a test bench, by other physics and other numerics than the project's model.
//!
//! Friction is a bristle (Canudas de Wit et al. 1995, "A new model for control of systems with
//! friction") with a Stribeck curve; contact in the gap is a stiff, damped spring that cannot pull
//! (Nordin & Gutman 2002); the relay runs in a sampled controller; the encoder quantises and the
//! velocity is noisy. Implicit midpoint steps of a few microseconds, the bristle and the actuator lag
//! by their exact exponentials within a step (both are stiff).

use std::f64::consts::TAU;

use hysteron_core::measurement::{Channel, Kind, Measurement, Quantity};

use super::proposed::Proposed;
use super::random::Random;

/// Resolution of the encoder unless said otherwise, rad.
const ENCODER: f64 = TAU / 1_048_576.0;
/// Standard deviation of the velocity noise, rad/s.
const VELOCITY_NOISE: f64 = 2e-3;
/// Sampling time of the controller and the record unless said otherwise, s.
pub const SAMPLING: f64 = 2e-4;
/// Steps of integration in that time; stiff contact needs the finer one.
const SUBSTEPS: usize = 20;
const SUBSTEPS_CONTACT: usize = 200;
/// Fixed-point iterations of the implicit midpoint rule; each gains two digits or more here.
const ITERATIONS: usize = 3;
/// Damping ratio of the stuck bristle.
const BRISTLE_DAMPING_RATIO: f64 = 0.1;

/// What drives the rig.
#[derive(Clone, Copy, Debug)]
pub enum Excitation {
    /// Relay on the measured velocity: levels `gain (1 +- asymmetry)` in N m, hysteresis in rad/s;
    /// `flip`: the asymmetry changes its sign every so many seconds, so that the cycle drifts to and fro.
    Relay {
        gain: f64,
        asymmetry: f64,
        hysteresis: f64,
        flip: Option<f64>,
    },
    /// Ten sines between 1 and 40 Hz with random phases, of this amplitude each, N m.
    Multisine { amplitude: f64 },
    /// Levels of growing size and both signs up to this torque (N m), with pauses between.
    Staircase { top: f64 },
    /// What a proposed experiment asks for.
    Proposed(Proposed),
    /// A position loop closed over the encoder: moves within plus or minus `reach` rad, one in each `period` s
    /// with a dwell after it; stiffness in N m/rad and damping in N m s/rad of the controller.
    Servo {
        reach: f64,
        period: f64,
        stiffness: f64,
        damping: f64,
    },
}

/// Relay with the paper's default levels.
pub const fn relay(asymmetry: f64) -> Excitation {
    Excitation::Relay {
        gain: 0.5,
        asymmetry,
        hysteresis: 0.5,
        flip: None,
    }
}

/// Relay whose drift turns round.
pub const fn drifting(flip: f64) -> Excitation {
    Excitation::Relay {
        gain: 0.5,
        asymmetry: 0.15,
        hysteresis: 0.5,
        flip: Some(flip),
    }
}

/// Bristle friction: levels in N m, Stribeck velocity in rad/s, break-away displacement in rad.
#[derive(Clone, Copy, Debug)]
pub struct Friction {
    pub coulomb: f64,
    pub standing: f64,
    pub stribeck_velocity: f64,
    pub displacement: f64,
}

impl Friction {
    /// Friction that is as good as dry: it breaks away after 10 microradians, two encoder counts.
    pub const fn dry(coulomb: f64) -> Self {
        Self {
            coulomb,
            standing: coulomb,
            stribeck_velocity: 1.0,
            displacement: 1e-5,
        }
    }

    /// Bristle after a step of `h` s at velocity `v`, and the mean friction torque in that step.
    fn advance(&self, z: f64, v: f64, h: f64, inertia: f64) -> (f64, f64) {
        if self.coulomb <= 0.0 {
            return (0.0, 0.0);
        }
        let stiffness = self.coulomb / self.displacement;
        let damping = 2.0 * BRISTLE_DAMPING_RATIO * (stiffness * inertia).sqrt();
        let level = self.coulomb
            + (self.standing - self.coulomb) * (-(v / self.stribeck_velocity).powi(2)).exp();
        // dz/dt = v - rate z, with v held.
        let rate = stiffness * v.abs() / level;
        let x = rate * h;
        let phi1 = if x > 1e-6 {
            -(-x).exp_m1() / x
        } else {
            1.0 - x / 2.0
        };
        let phi2 = if x > 1e-4 {
            (1.0 - phi1) / x
        } else {
            0.5 - x / 6.0
        };
        let slope = v - rate * z;
        let end = z + slope * h * phi1;
        let mean = z + slope * h * phi2;
        (end, stiffness * mean + damping * (end - z) / h)
    }
}

/// A load behind a gap, a spring, or both.
#[derive(Clone, Copy, Debug)]
pub struct Load {
    /// Half gap, rad; zero for a joint without play.
    pub half_gap: f64,
    /// N m/rad and N m s/rad.
    pub stiffness: f64,
    pub damping: f64,
    /// kg m^2, N m s/rad, N m.
    pub inertia: f64,
    pub viscous: f64,
    pub coulomb: f64,
}

impl Load {
    /// Torque on the load.
    fn torque(&self, deflection: f64, rate: f64) -> f64 {
        let spring = |depth: f64| self.stiffness * depth + self.damping * rate;
        if self.half_gap == 0.0 {
            spring(deflection)
        } else if deflection > self.half_gap {
            spring(deflection - self.half_gap).max(0.0)
        } else if deflection < -self.half_gap {
            spring(deflection + self.half_gap).min(0.0)
        } else {
            0.0
        }
    }
}

/// Physics that no library of the project knows.
#[derive(Clone, Copy, Debug)]
pub enum Stranger {
    /// Torque (N m) that acts once, from and for so many seconds.
    Pulse { torque: f64, from: f64, length: f64 },
    /// The torque constant falls with the speed: gain `1 - (v/v0)^2`, at least 0.
    GainFallsWithSpeed { v0: f64 },
    /// The torque follows the command along a loop with memory: `share` of it passes a play of this width (N m).
    Hysteresis { share: f64, width: f64 },
    /// A drag that stands at one speed only: `torque exp(-((|v| - centre)/width)^2)`.
    SpeedBump {
        torque: f64,
        centre: f64,
        width: f64,
    },
    /// A spring to the start, N m/rad.
    Spring { stiffness: f64 },
    /// The viscous friction grows by this factor until the end of the record.
    Warming { factor: f64 },
    /// One hard spot: drag of this torque (N m) within so many rad of the position.
    HardSpot { torque: f64, at: f64, width: f64 },
    /// A torque that pushes back at one position: `-torque exp(-((x - at)/width)^2)`, N m and rad.
    #[allow(dead_code, reason = "not every test hides it")]
    PositionBump { torque: f64, at: f64, width: f64 },
}

/// Which outputs are recorded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Recorded {
    Both,
    PositionOnly,
    VelocityOnly,
}

/// One experiment and everything that is hidden in it. SI units.
#[derive(Clone, Copy, Debug)]
pub struct DriveRig {
    pub seed: u64,
    pub excitation: Excitation,
    pub samples: usize,
    /// Sampling time of the controller and the record, s.
    pub sampling: f64,
    /// Resolution of the encoder, rad.
    pub encoder: f64,
    /// Standard deviation of the velocity noise, rad/s.
    pub velocity_noise: f64,
    /// Divides the steps of integration, to show that they are small enough.
    pub refine: usize,
    pub recorded: Recorded,
    pub inertia: f64,
    pub viscous: f64,
    pub friction: Friction,
    /// N m s^2/rad^2.
    pub quadratic_drag: f64,
    /// Amplitude in N m, periods in a turn of the coordinate (1/rad), phase in rad.
    pub cogging: (f64, f64, f64),
    pub constant_load: f64,
    pub delay: f64,
    pub actuator_lag: f64,
    pub gain_asymmetry: f64,
    /// The largest torque that the amplifier gives.
    pub saturation: f64,
    /// The command that the amplifier swallows.
    pub dead_zone: f64,
    /// Time constant of the filter on the velocity, which is made from the counts of an encoder; on the
    /// position where nothing else is recorded.
    pub sensor_lag: f64,
    pub load: Option<Load>,
    /// Where the load stands at the start, rad; the motor starts at 0.
    pub load_start: f64,
    /// Whether the load's position is recorded for reference.
    pub load_recorded: bool,
    pub stranger: Option<Stranger>,
}

impl Default for DriveRig {
    fn default() -> Self {
        Self {
            seed: 1,
            excitation: relay(0.1),
            samples: 10_000,
            sampling: SAMPLING,
            encoder: ENCODER,
            velocity_noise: VELOCITY_NOISE,
            refine: 1,
            recorded: Recorded::Both,
            inertia: 8.8e-4,
            viscous: 2e-3,
            friction: Friction::dry(0.0),
            quadratic_drag: 0.0,
            cogging: (0.0, 6.0, 0.0),
            constant_load: 0.0,
            delay: 0.0,
            actuator_lag: 0.0,
            gain_asymmetry: 0.0,
            saturation: f64::INFINITY,
            dead_zone: 0.0,
            sensor_lag: 0.0,
            load: None,
            load_start: 0.0,
            load_recorded: false,
            stranger: None,
        }
    }
}

/// Everything that moves.
#[derive(Clone, Copy, Default)]
struct State {
    x1: f64,
    v1: f64,
    x2: f64,
    v2: f64,
    bristle: f64,
    load_bristle: f64,
    torque: f64,
    seen_x: f64,
    seen_v: f64,
}

/// A drifting test on `rig`, whose relay flips every `flip` s: the first asymmetry with which the motor of
/// the `trial` rig travels more than `travel` rad, as one would try them at the bench. A sampled relay locks
/// to its clock at some inertias, and then nothing drifts.
#[allow(dead_code, reason = "not every test needs one")]
pub fn carried_over(
    rig: &DriveRig,
    travel: f64,
    flip: f64,
    trial: impl Fn(DriveRig) -> DriveRig,
) -> DriveRig {
    let tries = [0.15, 0.2, 0.25, 0.3, 0.35, 0.4].map(|asymmetry| DriveRig {
        excitation: Excitation::Relay {
            gain: 0.5,
            asymmetry,
            hysteresis: 0.5,
            flip: Some(flip),
        },
        ..*rig
    });
    let crosses = |rig: &DriveRig| {
        let record = trial(*rig).measure();
        let x = &record.outputs[0].values;
        let (low, high) = x
            .iter()
            .fold((0.0_f64, 0.0_f64), |(l, h), x| (l.min(*x), h.max(*x)));
        high - low > travel
    };
    tries.into_iter().find(crosses).unwrap_or(*rig)
}

impl DriveRig {
    /// Runs the experiment.
    pub fn measure(&self) -> Measurement {
        let mut random = Random::new(self.seed);
        let mut controller = Controller::new(self.excitation, self.sampling, &mut random);
        let stiff = self.load.is_some_and(|l| l.half_gap > 0.0);
        let substeps = self.refine * if stiff { SUBSTEPS_CONTACT } else { SUBSTEPS };
        let substeps = ((substeps as f64 * self.sampling / SAMPLING).round() as usize).max(1);
        let h = self.sampling / substeps as f64;
        let late = (self.delay / h).round() as usize;
        let mut s = State {
            x2: self.load_start,
            ..State::default()
        };
        let mut acting: Vec<f64> = Vec::with_capacity(self.samples);
        let mut memory = 0.0;
        let (mut time, mut input, mut position, mut velocity) = (vec![], vec![], vec![], vec![]);
        let mut load_position = vec![];
        for i in 0..self.samples {
            let t = i as f64 * self.sampling;
            let lags = self.sensor_lag > 0.0;
            let v = if lags { s.seen_v } else { s.v1 };
            let x = if lags && self.recorded == Recorded::PositionOnly {
                s.seen_x
            } else {
                s.x1
            };
            let measured = v + self.velocity_noise * random.normal();
            let counted = |x: f64| (x / self.encoder).round() * self.encoder;
            let u = controller.command(t, counted(x), measured);
            time.push(t);
            input.push(u);
            position.push(counted(x));
            velocity.push(measured);
            load_position.push(counted(s.x2));
            acting.push(self.amplified(u, &mut memory));
            for j in 0..substeps {
                let now = i * substeps + j;
                let u = now.checked_sub(late).map_or(0.0, |n| acting[n / substeps]);
                s = self.advance(s, u, t + (j as f64 + 0.5) * h, h);
            }
        }
        let mut record = self.record(time, input, position, velocity);
        if self.load_recorded {
            record
                .reference
                .push(channel(Quantity::LoadPosition, "x2", "rad", load_position));
        }
        record
    }

    /// What the amplifier makes of a command, before delay and lag.
    fn amplified(&self, u: f64, memory: &mut f64) -> f64 {
        let cut = u.clamp(-self.saturation, self.saturation);
        let past = cut.signum() * (cut.abs() - self.dead_zone).max(0.0);
        let sign = if past > 0.0 { 1.0 } else { -1.0 };
        let out = (1.0 + self.gain_asymmetry * sign) * past;
        if let Some(Stranger::Hysteresis { share, width }) = self.stranger {
            *memory = memory.clamp(out - width, out + width);
            return (1.0 - share) * out + share * *memory;
        }
        out
    }

    /// Torque on the motor that is in no library.
    fn strange_torque(&self, mid: &State, drive: f64, t: f64) -> f64 {
        match self.stranger {
            Some(Stranger::Pulse {
                torque,
                from,
                length,
            }) if t >= from && t < from + length => torque,
            Some(Stranger::GainFallsWithSpeed { v0 }) => -drive * (mid.v1 / v0).powi(2).min(1.0),
            Some(Stranger::SpeedBump {
                torque,
                centre,
                width,
            }) => -mid.v1.signum() * torque * (-((mid.v1.abs() - centre) / width).powi(2)).exp(),
            Some(Stranger::Spring { stiffness }) => -stiffness * mid.x1,
            Some(Stranger::Warming { factor }) => {
                -self.viscous * factor * t / (self.samples as f64 * self.sampling) * mid.v1
            }
            Some(Stranger::PositionBump { torque, at, width }) => {
                -torque * (-((mid.x1 - at) / width).powi(2)).exp()
            }
            Some(Stranger::HardSpot { torque, at, width }) => {
                -(mid.v1 / 0.05).tanh() * torque * (-((mid.x1 - at) / width).powi(2)).exp()
            }
            _ => 0.0,
        }
    }

    /// One implicit midpoint step of `h` s about the time `t` with the torque command `u`.
    fn advance(&self, s: State, u: f64, t: f64, h: f64) -> State {
        let mut end = s;
        let drive = if self.actuator_lag > 0.0 {
            let x = h / self.actuator_lag;
            end.torque = u + (s.torque - u) * (-x).exp();
            u + (s.torque - u) * -(-x).exp_m1() / x
        } else {
            u
        };
        for _ in 0..ITERATIONS {
            let mid = State {
                x1: f64::midpoint(s.x1, end.x1),
                v1: f64::midpoint(s.v1, end.v1),
                x2: f64::midpoint(s.x2, end.x2),
                v2: f64::midpoint(s.v2, end.v2),
                ..s
            };
            let (bristle, friction) = self.friction.advance(s.bristle, mid.v1, h, self.inertia);
            let (amplitude, periods, phase) = self.cogging;
            let mut torque = drive + self.constant_load
                - self.viscous * mid.v1
                - self.quadratic_drag * mid.v1.abs() * mid.v1
                - friction
                - amplitude * (periods * mid.x1 + phase).sin()
                + self.strange_torque(&mid, drive, t);
            if let Some(load) = &self.load {
                let through = load.torque(mid.x1 - mid.x2, mid.v1 - mid.v2);
                torque -= through;
                let dry = Friction::dry(load.coulomb);
                let (bristle, friction) = dry.advance(s.load_bristle, mid.v2, h, load.inertia);
                end.load_bristle = bristle;
                end.v2 = s.v2 + h * (through - load.viscous * mid.v2 - friction) / load.inertia;
                end.x2 = s.x2 + h * f64::midpoint(s.v2, end.v2);
            }
            end.bristle = bristle;
            end.v1 = s.v1 + h * torque / self.inertia;
            end.x1 = s.x1 + h * f64::midpoint(s.v1, end.v1);
        }
        if self.sensor_lag > 0.0 {
            // Implicit midpoint of a lag: ((T - h/2) seen + h true) / (T + h/2).
            let lag = |seen: f64, from: f64, to: f64| {
                ((self.sensor_lag - h / 2.0) * seen + h * f64::midpoint(from, to))
                    / (self.sensor_lag + h / 2.0)
            };
            end.seen_x = lag(s.seen_x, s.x1, end.x1);
            end.seen_v = lag(s.seen_v, s.v1, end.v1);
        }
        end
    }

    fn record(&self, time: Vec<f64>, input: Vec<f64>, x: Vec<f64>, v: Vec<f64>) -> Measurement {
        let mut outputs = Vec::new();
        if self.recorded != Recorded::VelocityOnly {
            outputs.push(channel(Quantity::Position, "x1", "rad", x));
        }
        if self.recorded != Recorded::PositionOnly {
            outputs.push(channel(Quantity::Velocity, "v1", "rad/s", v));
        }
        Measurement {
            name: format!("drive rig {}", self.seed),
            kind: Kind::Drive,
            time,
            input: channel(Quantity::Input, "u", "N m", input),
            outputs,
            reference: vec![],
            warnings: vec![],
        }
    }
}

fn channel(quantity: Quantity, name: &str, unit: &str, values: Vec<f64>) -> Channel {
    Channel {
        quantity,
        name: name.to_owned(),
        unit: unit.to_owned(),
        values,
    }
}

/// Where a servo shall be, from -1 to 1, after so many moves: each goes to a new place within three fifths of
/// its time, with the least jerk (Flash and Hogan 1985).
fn move_at(moves: f64) -> f64 {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let place = |k: f64| {
        if k <= 0.0 {
            0.0
        } else {
            2.0 * (k * GOLDEN).fract() - 1.0
        }
    };
    let from = moves.floor();
    let s = ((moves - from) / 0.6).min(1.0);
    let share = s.powi(3) * (10.0 - 15.0 * s + 6.0 * s * s);
    place(from) + (place(from + 1.0) - place(from)) * share
}

/// The sampled controller.
struct Controller {
    excitation: Excitation,
    high: bool,
    /// Frequency (rad/s) and phase.
    sines: Vec<(f64, f64)>,
    /// Sampling time, s.
    sampling: f64,
    /// Error of the position one sample ago, rad.
    error: Option<f64>,
}

impl Controller {
    fn new(excitation: Excitation, sampling: f64, random: &mut Random) -> Self {
        let sines = (0..10)
            .map(|i| {
                (
                    TAU * 40_f64.powf(f64::from(i) / 9.0),
                    TAU * random.uniform(),
                )
            })
            .collect();
        Self {
            excitation,
            high: false,
            sines,
            sampling,
            error: None,
        }
    }

    fn command(&mut self, t: f64, position: f64, velocity: f64) -> f64 {
        match self.excitation {
            Excitation::Relay {
                gain,
                asymmetry,
                hysteresis,
                flip,
            } => {
                if velocity > hysteresis {
                    self.high = true;
                } else if velocity < -hysteresis {
                    self.high = false;
                }
                let turned = flip.is_some_and(|period| (t / period) as u64 % 2 == 1);
                let asymmetry = if turned { -asymmetry } else { asymmetry };
                if self.high {
                    -gain * (1.0 - asymmetry)
                } else {
                    gain * (1.0 + asymmetry)
                }
            }
            Excitation::Proposed(proposed) => proposed.input(t, velocity, &mut self.high),
            Excitation::Multisine { amplitude } => self
                .sines
                .iter()
                .map(|(omega, phase)| amplitude * (omega * t + phase).sin())
                .sum(),
            Excitation::Staircase { top } => {
                const SHARES: [f64; 5] = [0.4, 0.55, 0.7, 0.85, 1.0];
                let slot = (t / 0.0625) as usize;
                let level = top * SHARES[slot / 4 % SHARES.len()];
                match slot % 4 {
                    0 => level,
                    2 => -level,
                    _ => 0.0,
                }
            }
            Excitation::Servo {
                reach,
                period,
                stiffness,
                damping,
            } => {
                let error = reach * move_at(t / period) - position;
                let rate = self.error.map_or(0.0, |e| (error - e) / self.sampling);
                self.error = Some(error);
                stiffness * error + damping * rate
            }
        }
    }
}
