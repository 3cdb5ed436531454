//! The models that effects are added to: a drive with viscous friction, a first-order process.

use super::id::{EffectId, VISCOUS_FRICTION};
use super::spec::{Dimension, Scales};
use crate::measurement::{Kind, Motion};
use crate::model::Model;

/// A parameter of a baseline: symbol, words, and the unit by kind of motion.
pub(crate) struct BaselineParameter {
    pub symbol: &'static str,
    pub label: &'static str,
    /// `None`: gain of a process, output unit per input unit.
    pub dimension: Option<Dimension>,
    pub effect: Option<EffectId>,
}

/// Place of the viscous friction in the baseline of a drive.
pub(crate) const DAMPING: usize = 1;

/// Symbol of its inertia.
pub(crate) const INERTIA: &str = "J1";

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

const PROCESS: [BaselineParameter; 2] = [
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
];

/// Its parameters, in the order in which every slice of values has them.
pub(crate) fn parameters(kind: Kind) -> &'static [BaselineParameter] {
    match kind {
        Kind::Drive => &DRIVE,
        Kind::Process => &PROCESS,
    }
}

/// Effects that are in the baseline from the start.
pub(crate) fn effects(kind: Kind) -> &'static [EffectId] {
    match kind {
        Kind::Drive => &[VISCOUS_FRICTION],
        Kind::Process => &[],
    }
}

/// Inertia and viscous friction of the body with these baseline values.
///
/// A process `T y' + y = K u` is the body `(T/K) y' = u - y/K`.
pub(crate) fn body(kind: Kind, values: &[f64]) -> (f64, f64) {
    match kind {
        Kind::Drive => (values[0], values[1]),
        Kind::Process => (values[1] / values[0], 1.0 / values[0]),
    }
}

/// The baseline model with these values.
pub(crate) fn model(kind: Kind, values: &[f64]) -> Model {
    let (inertia, viscous) = body(kind, values);
    Model::body(inertia, viscous)
}

/// Inertia and time constant stay within this factor of the first guess.
pub(crate) const GUESS_FACTOR: f64 = 1e4;

/// Longest time constant, in record lengths: a longer one is an integrator to all intents.
const LONGEST_SHARE: f64 = 1e4;

/// Values moved into what is physically possible.
pub(crate) fn clamp(kind: Kind, values: &mut [f64], scales: &Scales) {
    match kind {
        Kind::Drive => {
            let guess = scales.inertia.abs();
            values[0] =
                values[0].clamp(guess / scales.inertia_factor, guess * scales.inertia_factor);
            values[1] = values[1].max(0.0);
        }
        Kind::Process => {
            values[1] =
                values[1].clamp(scales.step / GUESS_FACTOR, scales.duration * LONGEST_SHARE);
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
