//! A model put together from mechanisms, and its motion under a measured input.
//!
//! Input path, body, dry friction and play are the mechanisms; an effect sets the ones that it
//! needs. The order is: static maps of the input, dead time, lag, body. Between events the motion
//! is an exact flow; sticking, slipping and contact are modes with guards.

mod contact;
mod engine;
mod flow;
mod replay;

pub use engine::{Engine, State};
pub(crate) use flow::root;
pub use replay::{Excitation, Start};

/// Static map of the input, applied sample by sample.
pub type InputMap = Box<dyn Fn(f64) -> f64 + Send + Sync>;

/// A load behind a gap: rigid play with momentum-conserving impacts, equations (10) and (11) of the paper.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Play {
    /// Half gap beta, rad or m; at least 0.
    pub half_gap: f64,
    /// Load inertia J2, kg m^2 or kg; above 0.
    pub inertia: f64,
    /// Load viscous friction d2; at least 0.
    pub viscous: f64,
    /// Load Coulomb friction; at least 0.
    pub dry_friction: f64,
    /// Coefficient of restitution, 0 (the bodies stay together) to 1 (no energy lost).
    pub restitution: f64,
}

/// What is simulated. Values are in SI units; see each field for its range.
pub struct Model {
    /// Inertia of the body: J1 of a drive, T/K of a process (sign of K); not 0.
    pub inertia: f64,
    /// Viscous friction of the body: d1 of a drive, 1/K of a process.
    pub viscous: f64,
    /// Static maps of the input, in order.
    pub input_maps: Vec<InputMap>,
    /// Dead time of the input, s; at least 0.
    pub delay: f64,
    /// Time constant of the input lag, s; above 0.
    pub lag: Option<f64>,
    /// Constant force added to the input after its path.
    pub constant_force: f64,
    /// Level of Coulomb friction at the body; at least 0.
    pub dry_friction: f64,
    /// Displacement after a reversal, rad or m, over which dry friction builds up to its level
    /// (friction level over contact stiffness, Dahl 1968); 0 for a rigid contact.
    pub presliding: f64,
    /// Damping ratio of the sticking contact; bristle models of metal contacts use 0.1 to 1 (Canudas
    /// de Wit et al. 1995).
    pub contact_damping: f64,
    /// Load behind a gap.
    pub play: Option<Play>,
}

impl Model {
    /// Body with viscous friction alone.
    pub fn body(inertia: f64, viscous: f64) -> Self {
        Self {
            inertia,
            viscous,
            input_maps: Vec::new(),
            delay: 0.0,
            lag: None,
            constant_force: 0.0,
            dry_friction: 0.0,
            presliding: 0.0,
            contact_damping: 0.0,
            play: None,
        }
    }

    /// Input after the static maps.
    pub fn map_input(&self, u: f64) -> f64 {
        self.input_maps.iter().fold(u, |u, map| map(u))
    }
}

impl std::fmt::Debug for Model {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Model")
            .field("inertia", &self.inertia)
            .field("viscous", &self.viscous)
            .field("input_maps", &self.input_maps.len())
            .field("delay", &self.delay)
            .field("lag", &self.lag)
            .field("constant_force", &self.constant_force)
            .field("dry_friction", &self.dry_friction)
            .field("presliding", &self.presliding)
            .field("play", &self.play)
            .finish_non_exhaustive()
    }
}
