//! The models that effects are added to: a drive with viscous friction, a first-order process about its ambient, an
//! integrator.

use super::constant_load;
use super::effect::Effect;
use super::id::{EffectId, VISCOUS_FRICTION};
use super::spec::{Dimension, Scales};
use crate::measurement::{Kind, Motion};
use crate::model::Model;

/// What a record is explained with at first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Baseline {
    /// An inertia with viscous friction.
    Drive,
    /// A first-order lag about an operating point: `T y' = K u - (y - ambient)`.
    Lag {
        /// The output is counted from the operating point, since it begins at rest there, at 0: the ambient is 0.
        from_ambient: bool,
    },
    /// A process whose output stays where the input leaves it: `y' = (K/T) u`.
    Integrator,
}

/// A parameter of a baseline: symbol, words, and what its unit follows from.
pub(crate) struct BaselineParameter {
    pub symbol: &'static str,
    pub label: &'static str,
    /// `None`: gain of a process, output unit per input unit.
    pub dimension: Option<Dimension>,
    pub effect: Option<EffectId>,
}

/// Place of the ambient in that of a process which comes to rest.
const AMBIENT_PLACE: usize = 2;

/// Symbol of the inertia of a drive.
pub(crate) const INERTIA: &str = "J1";

/// Symbol of the output of a process at rest without input.
pub(crate) const AMBIENT: &str = "ambient";

/// Symbol of how fast the output of a process that integrates moves.
pub(crate) const RATE: &str = "K/T";

/// A constant input of a process is its ambient: beside that, only one that came on with the record can be told.
const LOAD: EffectId = constant_load::ID;

const DRIVE: [BaselineParameter; 2] = [
    BaselineParameter {
        symbol: INERTIA,
        label: "motor inertia",
        dimension: Some(Dimension::Inertia),
        effect: None,
    },
    BaselineParameter {
        symbol: "d1",
        label: "viscous friction",
        dimension: Some(Dimension::ViscousFriction),
        effect: Some(VISCOUS_FRICTION),
    },
];

const LAG: [BaselineParameter; 3] = [
    BaselineParameter {
        symbol: "K",
        label: "gain",
        dimension: None,
        effect: None,
    },
    BaselineParameter {
        symbol: "T",
        label: "time constant",
        dimension: Some(Dimension::Time),
        effect: None,
    },
    BaselineParameter {
        symbol: AMBIENT,
        label: "output at rest without input",
        dimension: Some(Dimension::Compound {
            force: 0,
            position: 0,
            output: 1,
            time: 0,
        }),
        effect: None,
    },
];

const INTEGRATOR: [BaselineParameter; 1] = [BaselineParameter {
    symbol: RATE,
    label: "rate of the output per input",
    dimension: Some(Dimension::Compound {
        force: -1,
        position: 0,
        output: 1,
        time: -1,
    }),
    effect: None,
}];

/// Inertia and time constant stay within this factor of the first guess.
pub(crate) const GUESS_FACTOR: f64 = 1e4;

/// Longest time constant, in record lengths.
const LONGEST_SHARE: f64 = 1e4;

/// Standard errors by which `1/T` must differ from 0 where `T` is longer than the record, or the process integrates.
const TELLS_A_LAG: f64 = 3.0;

/// Parameters of which a user may know something before a record is seen, by kind.
pub(crate) fn known_parameters(kind: Kind) -> &'static [BaselineParameter] {
    match kind {
        Kind::Drive => &DRIVE,
        Kind::Process => &LAG,
    }
}

/// Effects that are in the baseline from the start.
pub(crate) fn effects(kind: Kind) -> &'static [EffectId] {
    match kind {
        Kind::Drive => &[VISCOUS_FRICTION],
        Kind::Process => &[],
    }
}

impl Baseline {
    /// Each of them; whether a process is counted from its ambient is in its values.
    pub const ALL: [Self; 3] = [
        Self::Drive,
        Self::Lag {
            from_ambient: false,
        },
        Self::Integrator,
    ];

    pub fn parameters(self) -> &'static [BaselineParameter] {
        match self {
            Self::Drive => &DRIVE,
            Self::Lag { .. } => &LAG,
            Self::Integrator => &INTEGRATOR,
        }
    }

    pub fn kind(self) -> Kind {
        match self {
            Self::Drive => Kind::Drive,
            Self::Lag { .. } | Self::Integrator => Kind::Process,
        }
    }

    /// Inertia and viscous friction of the body with these values.
    ///
    /// A process `T y' + y = K u` is the body `(T/K) y' = u - y/K`.
    pub fn body(self, values: &[f64]) -> (f64, f64) {
        match self {
            Self::Drive => (values[0], values[1]),
            Self::Lag { .. } => (values[1] / values[0], 1.0 / values[0]),
            Self::Integrator => (1.0 / values[0], 0.0),
        }
    }

    /// The transfer function from the input to the velocity, or to the output of a process: numerator, and denominator
    /// with the highest power first.
    pub fn fraction(self, values: &[f64]) -> (f64, Vec<f64>) {
        match self {
            Self::Drive => (1.0, vec![values[0], values[1]]),
            Self::Lag { .. } => (values[0], vec![values[1], 1.0]),
            Self::Integrator => (values[0], vec![1.0, 0.0]),
        }
    }

    /// The model with these values.
    pub fn model(self, values: &[f64]) -> Model {
        let (inertia, viscous) = self.body(values);
        let mut model = Model::body(inertia, viscous);
        if matches!(self, Self::Lag { .. }) {
            model.constant_force = values[AMBIENT_PLACE] * viscous;
        }
        model
    }

    /// One that passes the input on as it is.
    pub fn plain() -> Model {
        Model::body(1.0, 1.0)
    }

    /// Values to begin with where nothing is known.
    pub fn unknown(self) -> Vec<f64> {
        match self {
            Self::Drive => vec![1.0, 1.0],
            Self::Lag { .. } => vec![1.0, 1.0, 0.0],
            Self::Integrator => vec![1.0],
        }
    }

    /// The value of a place that is never changed beside these effects.
    pub fn fixed(self, effects: &[&'static dyn Effect]) -> Option<(usize, f64)> {
        let Self::Lag { from_ambient } = self else {
            return None;
        };
        let fixed = from_ambient || effects.iter().any(|e| e.id() == LOAD);
        fixed.then_some((AMBIENT_PLACE, 0.0))
    }

    /// Whether it says already what an effect says.
    pub fn has(self, effect: EffectId) -> bool {
        effect == LOAD
            && self
                == (Self::Lag {
                    from_ambient: false,
                })
    }

    /// Values that say what the body is: inertia, or gain and time constant.
    pub fn essential(self) -> usize {
        match self {
            Self::Drive | Self::Integrator => 1,
            Self::Lag { .. } => 2,
        }
    }

    /// Place of the value that goes with the inverse of the rate at which the output moves.
    pub fn size(self) -> usize {
        match self {
            Self::Drive | Self::Integrator => 0,
            Self::Lag { .. } => 1,
        }
    }

    /// What the ambient of a process becomes where that integrates: an effect that lets its output drift.
    pub fn drift() -> EffectId {
        LOAD
    }

    /// Whether a record of this length, s, does not tell a lag with these values and standard errors from an
    /// integrator.
    pub fn may_integrate(self, values: &[f64], errors: &[f64], duration: f64) -> bool {
        let Self::Lag { .. } = self else {
            return false;
        };
        let (time, error) = (values[1], errors[1]);
        time > duration && time < TELLS_A_LAG * error
    }

    /// Values moved into what is physically possible.
    pub fn clamp(self, values: &mut [f64], scales: &Scales) {
        match self {
            Self::Drive => {
                let guess = scales.inertia.abs();
                values[0] =
                    values[0].clamp(guess / scales.inertia_factor, guess * scales.inertia_factor);
                values[1] = values[1].max(0.0);
            }
            Self::Lag { .. } => {
                values[1] =
                    values[1].clamp(scales.step / GUESS_FACTOR, scales.duration * LONGEST_SHARE);
            }
            Self::Integrator => {}
        }
    }
}

/// Unit of a gain from input to output.
pub(crate) fn gain_unit(input: &str, output: &str) -> String {
    match (output, input) {
        (o, i) if o == i => "1".to_owned(),
        (o, "1") => o.to_owned(),
        (o, i) => format!("{o}/{i}"),
    }
}

/// Unit of a parameter of this dimension in a measurement with this motion and input unit.
pub(crate) fn unit(dimension: Dimension, motion: Motion, input_unit: &str) -> String {
    match (dimension, motion) {
        (Dimension::Force, Motion::None) => input_unit.to_owned(),
        _ => dimension.unit(motion).to_owned(),
    }
}
