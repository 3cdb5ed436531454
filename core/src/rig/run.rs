//! The experiment, step by step.

use super::controller::Controller;
use super::{
    BRISTLE_DAMPING_RATIO, DriveRig, Excitation, Friction, ITERATIONS, Load, Random, Recorded,
    SAMPLING, SUBSTEPS, SUBSTEPS_CONTACT, Stranger,
};
use crate::measurement::{Channel, Kind, Measurement, Quantity};

/// Speed over which friction that grows with the load turns round, rad/s.
const BLUNT: f64 = 0.005;

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

impl Friction {
    /// Bristle after a step of `h` s at velocity `v`, and the mean friction torque in that step.
    fn advance(&self, z: f64, v: f64, h: f64, inertia: f64) -> (f64, f64) {
        if self.coulomb <= 0.0 {
            return (0.0, 0.0);
        }
        let stiffness = self.coulomb / self.displacement;
        let damping = 2.0 * BRISTLE_DAMPING_RATIO * (stiffness * inertia).sqrt();
        let level = self.coulomb
            + (self.standing - self.coulomb) * libm::exp(-(v / self.stribeck_velocity).powi(2));
        // dz/dt = v - rate z, with v held.
        let rate = stiffness * v.abs() / level;
        let x = rate * h;
        let phi1 = if x > 1e-6 {
            -libm::expm1(-x) / x
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
            let (x, v) = self.by_disc(x, v);
            let measured = stepped(
                v + self.velocity_noise * random.normal(),
                self.velocity_step,
            );
            let counted = |x: f64| (x / self.encoder).round() * self.encoder;
            let u = stepped(controller.command(t, counted(x), measured), self.input_step);
            time.push(t);
            input.push(u);
            position.push(counted(x));
            velocity.push(measured);
            load_position.push(counted(s.x2));
            acting.push(self.amplified(u, &mut memory));
            for j in 0..substeps {
                let now = i * substeps + j;
                let then = now.checked_sub(late).and_then(|n| acting.get(n / substeps));
                let u = then.copied().unwrap_or(0.0);
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

    /// Angle and speed as the disc of the encoder shows them.
    fn by_disc(&self, x: f64, v: f64) -> (f64, f64) {
        match self.stranger {
            Some(Stranger::EccentricEncoder { share, phase }) => (
                x + share * libm::sin(x + phase),
                v + share * v * libm::cos(x + phase),
            ),
            _ => (x, v),
        }
    }

    /// Torque on the motor beside friction, load and amplifier.
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
            }) => -mid.v1.signum() * torque * libm::exp(-((mid.v1.abs() - centre) / width).powi(2)),
            Some(Stranger::Spring { stiffness }) => -stiffness * mid.x1,
            Some(Stranger::Gravity { torque }) => -torque * libm::sin(mid.x1),
            Some(Stranger::HardeningSpring { stiffness }) => -stiffness * mid.x1.powi(3),
            Some(Stranger::LoadFriction { share }) => {
                -libm::tanh(mid.v1 / BLUNT) * share * drive.abs()
            }
            Some(Stranger::FlatteningFriction { level, half }) => {
                -level * mid.v1 / (mid.v1.abs() + half)
            }
            Some(Stranger::EndStops {
                stiffness,
                damping,
                upper,
                lower,
            }) => {
                let (above, below) = (mid.x1 - upper, lower - mid.x1);
                if above > 0.0 {
                    -(stiffness * above + damping * mid.v1).max(0.0)
                } else if below > 0.0 {
                    (stiffness * below - damping * mid.v1).max(0.0)
                } else {
                    0.0
                }
            }
            Some(Stranger::SecondWave { torque, phase }) => {
                torque * libm::sin(2.0 * self.cogging.1 * mid.x1 + phase)
            }
            Some(Stranger::TightEnd { slope }) => {
                // The guide is never so loose that it pushes.
                -libm::tanh(mid.v1 / BLUNT) * (slope * mid.x1).max(-self.friction.coulomb)
            }
            Some(Stranger::Ripple {
                share,
                periods,
                phase,
            }) => drive * share * libm::sin(periods * mid.x1 + phase),
            Some(Stranger::Shaking {
                torque,
                period,
                phase,
            }) => torque * libm::sin(std::f64::consts::TAU * t / period + phase),
            Some(Stranger::Warming { factor }) => {
                -self.viscous * factor * t / (self.samples as f64 * self.sampling) * mid.v1
            }
            Some(Stranger::PositionBump { torque, at, width }) => {
                -torque * libm::exp(-((mid.x1 - at) / width).powi(2))
            }
            Some(Stranger::HardSpot { torque, at, width }) => {
                -libm::tanh(mid.v1 / 0.05) * torque * libm::exp(-((mid.x1 - at) / width).powi(2))
            }
            _ => 0.0,
        }
    }

    /// One implicit midpoint step of `h` s about the time `t` with the torque command `u`.
    fn advance(&self, s: State, u: f64, t: f64, h: f64) -> State {
        let mut end = s;
        let drive = if let Some(Stranger::SlowAmplifier { rate }) = self.stranger {
            end.torque = u.clamp(s.torque - rate * h, s.torque + rate * h);
            f64::midpoint(s.torque, end.torque)
        } else if self.actuator_lag > 0.0 {
            let x = h / self.actuator_lag;
            end.torque = u + (s.torque - u) * libm::exp(-x);
            u + (s.torque - u) * -libm::expm1(-x) / x
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
                - amplitude * libm::sin(periods * mid.x1 + phase)
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

/// A drifting test on `rig`, whose relay flips every `flip` s: the first asymmetry with which the motor of
/// the `trial` rig travels more than `travel` rad, as one would try them at the bench. A sampled relay locks
/// to its clock at some inertias, and then nothing drifts.
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
        let x = record.outputs.first().map(|x| x.values.as_slice());
        let (low, high) = x
            .unwrap_or_default()
            .iter()
            .fold((0.0_f64, 0.0_f64), |(l, h), x| (l.min(*x), h.max(*x)));
        high - low > travel
    };
    tries.into_iter().find(crosses).unwrap_or(*rig)
}

fn channel(quantity: Quantity, name: &str, unit: &str, values: Vec<f64>) -> Channel {
    Channel {
        quantity,
        name: name.to_owned(),
        unit: unit.to_owned(),
        values,
    }
}

/// The nearest multiple of a step; the value itself where there is none.
fn stepped(value: f64, step: f64) -> f64 {
    if step > 0.0 {
        (value / step).round() * step
    } else {
        value
    }
}
