//! A model put together from mechanisms, and its motion under a measured input.
//!
//! Input path, body, dry friction, further forces, a load and the sensor are the mechanisms; an effect sets the ones
//! that it needs. The order is: static maps of the input, an actuator with a memory, dead time, lag, body, sensor.
//! Between events the motion of body and load is an exact flow; sticking and slipping are modes with guards, and so is
//! contact: where body and load come together or apart is located as an event. Smooth forces, and all that acts with
//! them or with a soft bristle between body and load, are held at their value at the middle of steps short against
//! their change (exponential midpoint rule, second order).

mod actuator;
mod bristle;
mod closed_loop;
mod contact;
mod delayed_input;
mod encoder;
mod engine;
mod excitation;
mod felt_load;
mod flight;
mod flow;
mod followed;
mod friction;
mod gear;
mod impacts;
mod joint;
mod load;
mod replay;
#[cfg(test)]
pub(crate) mod runge_kutta;
mod seen_load;
mod short;
mod slow_sensor;
mod smoothed;
mod state;
mod swing;

pub use actuator::Actuator;
pub use closed_loop::{Run, run_controlled, run_controlled_from};
pub(crate) use contact::dahl;
pub use encoder::Eccentricity;
pub use engine::Engine;
pub use excitation::{Excitation, Sensor};
pub(crate) use felt_load::slope;
pub(crate) use flight::Slowing;
pub(crate) use flow::free_body;
pub use followed::{FollowedNoise, load_torque};
pub use load::{Coupling, Load};
pub(crate) use replay::LoadBegin;
pub use replay::{FollowedLoad, Start};
pub(crate) use seen_load::{LoadState, Play, SeenContact, SeenLoad, Sharpness, Surprise, Turn};
pub(crate) use smoothed::smoothed;
pub use state::State;

/// Static map of the input or the output, applied sample by sample.
pub type StaticMap = Box<dyn Fn(f64) -> f64 + Send + Sync>;

/// A force on the body as a function of its position and velocity, added to the input.
pub type BodyForce = Box<dyn Fn(f64, f64) -> f64 + Send + Sync>;

/// Where the body is, and what acts on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instant {
    /// Position of a drive, rad or m.
    pub position: f64,
    /// Velocity of a drive, rad/s or m/s; the output of a process.
    pub velocity: f64,
    /// Input that reaches the body, after its path.
    pub input: f64,
    /// Time since the first sample, s.
    pub time: f64,
}

/// A force on the body that may depend on everything, added to the input.
pub type OwnForce = Box<dyn Fn(&Instant) -> f64 + Send + Sync>;

/// Dry friction at the body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DryFriction {
    /// Coulomb friction: the level while moving fast; at least 0.
    pub level: f64,
    /// By how much the level is higher at standstill (Stribeck 1902); at least 0.
    pub static_excess: f64,
    /// Speed at which the excess has fallen to 1/e: `level + static_excess exp(-(v / speed)^2)`.
    pub stribeck_speed: f64,
    /// By how much the level rises with the position, per rad or m.
    pub rise: f64,
    /// Displacement after a reversal, rad or m, over which dry friction builds up to its level
    /// (friction level over contact stiffness, Dahl 1968); 0 for a rigid contact.
    pub presliding: f64,
    /// Damping ratio of the sticking contact; bristle models of metal contacts use 0.1 to 1 (Canudas
    /// de Wit et al. 1995).
    pub contact_damping: f64,
}

impl DryFriction {
    /// Friction level at position `x` and velocity `v`; below 0 there is no friction.
    pub fn level_at(&self, x: f64, v: f64) -> f64 {
        let level = self.level + self.rise * x;
        if self.static_excess == 0.0 {
            return level;
        }
        let ratio = v / self.stribeck_speed;
        level + self.static_excess * libm::exp(-ratio * ratio)
    }

    /// Level at standstill.
    pub fn breakaway(&self) -> f64 {
        self.level + self.static_excess
    }
}

/// What is simulated. Values are in SI units; see each field for its range.
pub struct Model {
    /// Inertia of the body: J1 of a drive, T/K of a process (sign of K); not 0.
    pub inertia: f64,
    /// Viscous friction of the body: d1 of a drive, 1/K of a process.
    pub viscous: f64,
    /// What holds the body of a process that swings, 1/K: its output is then where the body is, and not how fast it
    /// moves. `None` of all others.
    pub spring: Option<f64>,
    /// Static maps of the input, in order.
    pub input_maps: Vec<StaticMap>,
    /// An actuator that remembers what it was told before, after the maps.
    pub actuator: Option<Actuator>,
    /// Share of the next sample of the input that acts from a sample to the next, 0 to 1.
    pub next_input: f64,
    /// Dead time of the input, s; at least 0.
    pub delay: f64,
    /// Time constant of the input lag, s; above 0.
    pub lag: Option<f64>,
    /// Share of the input of a process that passes by the lag, so that it acts at once; below 0, it first acts the
    /// wrong way.
    pub direct: f64,
    /// Share by which a process takes longer to fall than in the mean, and shorter to rise; -1 to 1.
    pub slow_fall: f64,
    /// Constant force added to the input after its path.
    pub constant_force: f64,
    /// Its rise per second, counted from the first sample.
    pub force_ramp: f64,
    /// Whether these two act before the lag, as a load on a process with two storages does, or after it,
    /// as a load on a drive behind its actuator.
    pub load_before_lag: bool,
    /// Dry friction at the body.
    pub friction: DryFriction,
    /// Further forces on the body.
    pub forces: Vec<BodyForce>,
    /// Forces of the user's own making.
    pub own_forces: Vec<OwnForce>,
    /// Friction of a gear, as a share of what its teeth carry; 0 to 1.
    pub gear_friction: f64,
    /// A second body behind a joint or a gap.
    pub load: Option<Load>,
    /// An encoder that is not centred on its shaft.
    pub encoder: Option<Eccentricity>,
    /// Static maps of the output (the velocity), in order.
    pub output_maps: Vec<StaticMap>,
    /// Time constant of the sensor, s; above 0. It slows the velocity signal, or the position where
    /// that is all that is measured.
    pub sensor_lag: Option<f64>,
}

impl Model {
    /// Body with viscous friction alone.
    pub fn body(inertia: f64, viscous: f64) -> Self {
        Self {
            inertia,
            viscous,
            spring: None,
            input_maps: Vec::new(),
            actuator: None,
            next_input: 0.0,
            delay: 0.0,
            lag: None,
            direct: 0.0,
            slow_fall: 0.0,
            constant_force: 0.0,
            force_ramp: 0.0,
            load_before_lag: false,
            friction: DryFriction::default(),
            forces: Vec::new(),
            own_forces: Vec::new(),
            gear_friction: 0.0,
            load: None,
            encoder: None,
            output_maps: Vec::new(),
            sensor_lag: None,
        }
    }

    /// Whether a motion that begins elsewhere is the same one there: no force and no reading depends on the place.
    pub fn is_same_everywhere(&self) -> bool {
        self.forces.is_empty()
            && self.own_forces.is_empty()
            && self.gear_friction == 0.0
            && self.encoder.is_none()
            && self.friction.rise == 0.0
    }

    /// The force that keeps the output of a process where it is, per unit of it.
    fn holding(&self) -> f64 {
        self.spring.unwrap_or(self.viscous)
    }

    /// From position and velocity of the body to what sensors see in their place, and back: the output of a process
    /// stands where a velocity does.
    fn seen(&self, [position, velocity]: [f64; 2]) -> [f64; 2] {
        match self.spring {
            None => [position, velocity],
            Some(_) => [velocity, position],
        }
    }

    /// Input after the static maps.
    pub fn map_input(&self, u: f64) -> f64 {
        self.input_maps.iter().fold(u, |u, map| map(u))
    }

    /// Constant force and ramp that the lag passes on, `t` seconds after the first sample.
    fn early_load(&self, t: f64) -> f64 {
        if self.load_before_lag {
            self.constant_force + self.force_ramp * t
        } else {
            0.0
        }
    }

    /// Constant force and its rise per second that act on the body itself.
    fn late_load(&self) -> (f64, f64) {
        if self.load_before_lag {
            (0.0, 0.0)
        } else {
            (self.constant_force, self.force_ramp)
        }
    }

    /// Whether friction may hold the body at rest.
    pub fn may_stick(&self) -> bool {
        self.friction.breakaway() > 0.0 || self.gear_friction > 0.0
    }

    /// Output after the static maps.
    pub fn map_output(&self, y: f64) -> f64 {
        self.output_maps.iter().fold(y, |y, map| map(y))
    }
}

impl std::fmt::Debug for Model {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Model")
            .field("inertia", &self.inertia)
            .field("viscous", &self.viscous)
            .field("spring", &self.spring)
            .field("input_maps", &self.input_maps.len())
            .field("actuator", &self.actuator)
            .field("next_input", &self.next_input)
            .field("delay", &self.delay)
            .field("lag", &self.lag)
            .field("direct", &self.direct)
            .field("slow_fall", &self.slow_fall)
            .field("constant_force", &self.constant_force)
            .field("force_ramp", &self.force_ramp)
            .field("load_before_lag", &self.load_before_lag)
            .field("friction", &self.friction)
            .field("forces", &self.forces.len())
            .field("own_forces", &self.own_forces.len())
            .field("gear_friction", &self.gear_friction)
            .field("load", &self.load)
            .field("encoder", &self.encoder)
            .field("output_maps", &self.output_maps.len())
            .field("sensor_lag", &self.sensor_lag)
            .finish()
    }
}
