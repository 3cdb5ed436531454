//! A drive on a test bench, by other physics and other numerics than the models that are fitted, and a
//! [`process`].
//!
//! It uses nothing of [`crate::model`] or [`crate::simulate`]: a model that explains its records does not do
//! so by construction.
//!
//! The drive's friction is a bristle (Canudas de Wit et al. 1995, "A new model for control of systems with
//! friction") with a Stribeck curve; contact in the gap is a stiff, damped spring that cannot pull
//! (Nordin & Gutman 2002); the relay runs in a sampled controller; the encoder quantises and the
//! velocity is noisy. Implicit midpoint steps of a few microseconds, the bristle and the actuator lag
//! by their exact exponentials within a step (both are stiff).

mod controller;
pub mod process;
mod proposed;
mod run;

use std::f64::consts::TAU;

pub use crate::random::Random;
pub use proposed::Proposed;
pub use run::carried_over;

/// Resolution of the encoder unless said otherwise, rad.
pub const ENCODER: f64 = TAU / 1_048_576.0;
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
        /// Mean of both levels, N m.
        gain: f64,
        /// Share by which the upper level is larger and the lower one smaller.
        asymmetry: f64,
        /// Velocity at which it switches, rad/s.
        hysteresis: f64,
        /// Time after which the asymmetry changes its sign, s.
        flip: Option<f64>,
    },
    /// Ten sines between 1 and 40 Hz with random phases, of this amplitude each, N m.
    Multisine {
        /// Of each sine, N m.
        amplitude: f64,
    },
    /// Levels of growing size and both signs up to this torque (N m), with pauses between.
    Staircase {
        /// The largest level, N m.
        top: f64,
    },
    /// What a proposed experiment asks for.
    Proposed(Proposed),
    /// A position loop closed over the encoder: moves within plus or minus `reach` rad, one in each `period` s
    /// with a dwell after it; stiffness in N m/rad and damping in N m s/rad of the controller.
    Servo {
        /// Of the moves, rad.
        reach: f64,
        /// Of a move with its dwell, s.
        period: f64,
        /// Of the controller, N m/rad.
        stiffness: f64,
        /// Of the controller, N m s/rad.
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
    /// Level at speed, N m; no friction at 0.
    pub coulomb: f64,
    /// Level at rest, N m.
    pub standing: f64,
    /// Velocity within which the level falls from the one to the other, rad/s.
    pub stribeck_velocity: f64,
    /// Displacement at which the bristle breaks away, rad.
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
}

/// A load behind a gap, a spring, or both.
#[derive(Clone, Copy, Debug)]
pub struct Load {
    /// Half gap, rad; zero for a joint without play.
    pub half_gap: f64,
    /// Of the contact or the shaft, N m/rad.
    pub stiffness: f64,
    /// Of the contact or the shaft, N m s/rad.
    pub damping: f64,
    /// kg m^2.
    pub inertia: f64,
    /// Viscous friction, N m s/rad.
    pub viscous: f64,
    /// Dry friction, N m.
    pub coulomb: f64,
}

/// Physics that no library of the project knows.
#[derive(Clone, Copy, Debug)]
pub enum Stranger {
    /// Torque (N m) that acts once, from and for so many seconds.
    Pulse {
        /// N m.
        torque: f64,
        /// s.
        from: f64,
        /// s.
        length: f64,
    },
    /// The torque constant falls with the speed: gain `1 - (v/v0)^2`, at least 0.
    GainFallsWithSpeed {
        /// Speed without torque, rad/s.
        v0: f64,
    },
    /// The torque follows the command along a loop with memory: `share` of it passes a play of this width (N m).
    Hysteresis {
        /// 0 to 1.
        share: f64,
        /// Half width, N m.
        width: f64,
    },
    /// A drag that stands at one speed only: `torque exp(-((|v| - centre)/width)^2)`.
    SpeedBump {
        /// N m.
        torque: f64,
        /// rad/s.
        centre: f64,
        /// rad/s.
        width: f64,
    },
    /// A spring to the start, N m/rad.
    Spring {
        /// N m/rad.
        stiffness: f64,
    },
    /// An arm that hangs down at the start, N m.
    Gravity {
        /// Largest torque, N m.
        torque: f64,
    },
    /// A spring to the start that hardens, N m/rad^3.
    HardeningSpring {
        /// N m/rad^3.
        stiffness: f64,
    },
    /// Teeth that rub with a share of what the motor pushes.
    LoadFriction {
        /// 0 to 1.
        share: f64,
    },
    /// Friction that grows from 0 to its level, half of it at this speed.
    FlatteningFriction {
        /// N m.
        level: f64,
        /// rad/s.
        half: f64,
    },
    /// Stops at both ends of the way: damped springs that do not pull.
    EndStops {
        /// N m/rad.
        stiffness: f64,
        /// N m s/rad.
        damping: f64,
        /// rad.
        upper: f64,
        /// rad.
        lower: f64,
    },
    /// A second wave of the cogging, twice as fine as the first.
    SecondWave {
        /// N m.
        torque: f64,
        /// rad.
        phase: f64,
    },
    /// A guide that is tighter at one end: dry friction more by this, N m/rad.
    TightEnd {
        /// N m/rad.
        slope: f64,
    },
    /// The torque constant ripples with the angle.
    Ripple {
        /// 0 to 1.
        share: f64,
        /// 1/rad.
        periods: f64,
        /// rad.
        phase: f64,
    },
    /// The disc of the encoder is off its shaft.
    EccentricEncoder {
        /// Share of its radius.
        share: f64,
        /// rad.
        phase: f64,
    },
    /// Another machine that shakes this one.
    Shaking {
        /// N m.
        torque: f64,
        /// s.
        period: f64,
        /// rad.
        phase: f64,
    },
    /// The torque changes at this rate at most, N m/s.
    SlowAmplifier {
        /// N m/s.
        rate: f64,
    },
    /// The viscous friction grows by this factor until the end of the record.
    Warming {
        /// Of the growth.
        factor: f64,
    },
    /// One hard spot: drag of this torque (N m) within so many rad of the position.
    HardSpot {
        /// N m.
        torque: f64,
        /// rad.
        at: f64,
        /// rad.
        width: f64,
    },
    /// A torque that pushes back at one position: `-torque exp(-((x - at)/width)^2)`, N m and rad.
    PositionBump {
        /// N m.
        torque: f64,
        /// rad.
        at: f64,
        /// rad.
        width: f64,
    },
}

/// Which outputs are recorded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Recorded {
    /// Position and velocity.
    Both,
    /// The position alone.
    PositionOnly,
    /// The velocity alone.
    VelocityOnly,
}

/// One experiment and everything that is hidden in it. SI units; values are taken as they are.
#[derive(Clone, Copy, Debug)]
pub struct DriveRig {
    /// Of the noise and of the phases of the sines.
    pub seed: u64,
    /// What drives it.
    pub excitation: Excitation,
    /// Length of the record.
    pub samples: usize,
    /// Sampling time of the controller and the record, s.
    pub sampling: f64,
    /// Resolution of the encoder, rad.
    pub encoder: f64,
    /// Standard deviation of the velocity noise, rad/s.
    pub velocity_noise: f64,
    /// Step of the recorded velocity, rad/s; 0 for none.
    pub velocity_step: f64,
    /// Step of the commanded torque, N m; 0 for none.
    pub input_step: f64,
    /// Divides the steps of integration, to show that they are small enough.
    pub refine: usize,
    /// Which outputs are recorded.
    pub recorded: Recorded,
    /// Of the motor, kg m^2.
    pub inertia: f64,
    /// Viscous friction of the motor, N m s/rad.
    pub viscous: f64,
    /// Dry friction of the motor.
    pub friction: Friction,
    /// Quadratic drag, N m s^2/rad^2.
    pub quadratic_drag: f64,
    /// Amplitude in N m, periods in a turn of the coordinate (1/rad), phase in rad.
    pub cogging: (f64, f64, f64),
    /// Torque that always acts, N m.
    pub constant_load: f64,
    /// Dead time of the input, s; met to a step of integration.
    pub delay: f64,
    /// Time constant of the torque, s.
    pub actuator_lag: f64,
    /// Share by which positive torque is larger and negative torque smaller.
    pub gain_asymmetry: f64,
    /// The largest torque that the amplifier gives.
    pub saturation: f64,
    /// The command that the amplifier swallows.
    pub dead_zone: f64,
    /// Time constant of the filter on the velocity, which is made from the counts of an encoder; on the
    /// position where nothing else is recorded.
    pub sensor_lag: f64,
    /// What the motor drives.
    pub load: Option<Load>,
    /// Where the load stands at the start, rad; the motor starts at 0.
    pub load_start: f64,
    /// Whether the load's position is recorded for reference.
    pub load_recorded: bool,
    /// Physics that no library of the project knows.
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
            velocity_step: 0.0,
            input_step: 0.0,
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
