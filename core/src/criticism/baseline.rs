//! The models that a user starts from: a drive with viscous friction, a first-order process.

use nalgebra::{Matrix3, Vector3};

use super::data::Data;
use crate::effect::{Dimension, Effect, EffectId, Motion, Scales, VISCOUS_FRICTION};
use crate::measurement::Kind;
use crate::model::Model;

/// What a record is explained with at first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Baseline {
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
pub(super) struct BaselineParameter {
    pub symbol: &'static str,
    pub label: &'static str,
    /// `None`: gain of a process, output unit per input unit.
    pub dimension: Option<Dimension>,
    pub effect: Option<EffectId>,
}

/// Place of the viscous friction in the baseline of a drive.
pub(super) const DAMPING: usize = 1;

/// Place of the ambient in that of a process which comes to rest.
const AMBIENT: usize = 2;

/// Symbol of the inertia of a drive.
pub(super) const INERTIA: &str = "J1";

/// Symbol of how fast the output of a process that integrates moves.
pub(super) const RATE: &str = "K/T";

/// A constant input of a process is its ambient: beside that, only one that came on with the record can be told.
const LOAD: EffectId = EffectId::new("constant_load");

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
        symbol: "ambient",
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
pub(super) const GUESS_FACTOR: f64 = 1e4;

/// Longest time constant, in record lengths.
const LONGEST_SHARE: f64 = 1e4;

/// Standard errors by which `1/T` must differ from 0 where `T` is longer than the record, or the process integrates.
const TELLS_A_LAG: f64 = 3.0;

/// Effects that are in the baseline from the start.
pub(super) fn effects(kind: Kind) -> &'static [EffectId] {
    match kind {
        Kind::Drive => &[VISCOUS_FRICTION],
        Kind::Process => &[],
    }
}

impl Baseline {
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

    /// The model with these values.
    pub fn model(self, values: &[f64]) -> Model {
        let (inertia, viscous) = self.body(values);
        let mut model = Model::body(inertia, viscous);
        if matches!(self, Self::Lag { .. }) {
            model.constant_force = values[AMBIENT] * viscous;
        }
        model
    }

    /// One that passes the input on as it is.
    pub fn plain(self) -> Model {
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
        fixed.then_some((AMBIENT, 0.0))
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

    /// Whether a record of this length, s, does not tell a lag with these values and standard errors from an integrator.
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
pub(super) fn gain_unit(input: &str, output: &str) -> String {
    match (output, input) {
        (o, i) if o == i => "1".to_owned(),
        (o, "1") => o.to_owned(),
        (o, i) => format!("{o}/{i}"),
    }
}

/// Unit of a parameter of this dimension in a measurement with this motion and input unit.
pub(super) fn unit(dimension: Dimension, motion: Motion, input_unit: &str) -> String {
    match (dimension, motion) {
        (Dimension::Force, Motion::None) => input_unit.to_owned(),
        _ => dimension.unit(motion).to_owned(),
    }
}

/// Chunk lengths, in samples, over which velocity differences are regressed; the first whose
/// differences stand well above the noise is taken.
const CHUNKS: [usize; 7] = [1, 2, 5, 10, 20, 50, 100];

/// How far above the noise, root mean square.
const CLEAR_OF_NOISE: f64 = 10.0;

/// First guess by linear regression of `v(t2) - v(t1) = b int w dt - lambda int v dt + f (t2 - t1)` on chunks,
/// with `w` the input that reaches the body (one value per interval).
///
/// `None` where the regression has no sensible solution.
pub(super) fn guess(data: &Data, w: &[f64]) -> Option<Vec<f64>> {
    let v = data.velocity_estimate();
    let noise = data
        .outputs
        .iter()
        .find(|o| o.is_velocity)
        .map_or(0.0, |o| o.noise);
    let n = data.len();
    let time = &data.time;
    let chunk = CHUNKS
        .iter()
        .copied()
        .filter(|c| c * 20 < n)
        .find(|c| {
            let sum: f64 = (0..n - c).map(|i| (v[i + c] - v[i]).powi(2)).sum();
            (sum / (n - c) as f64).sqrt() > CLEAR_OF_NOISE * noise
        })
        .unwrap_or((n / 40).clamp(1, 100));
    // The constant term keeps an offset of the input from bending the other two.
    let mut normal = Matrix3::zeros();
    let mut right = Vector3::zeros();
    let mut power = 0.0;
    let mut i = 0;
    while i + chunk < n {
        let (mut iw, mut iv) = (0.0, 0.0);
        for j in i..i + chunk {
            let dt = time[j + 1] - time[j];
            iw += w[j] * dt;
            iv += 0.5 * (v[j] + v[j + 1]) * dt;
        }
        let row = Vector3::new(iw, -iv, time[i + chunk] - time[i]);
        normal += row * row.transpose();
        right += row * (v[i + chunk] - v[i]);
        power += (v[i + chunk] - v[i]).powi(2);
        i += chunk;
    }
    // Columns differ by orders of magnitude: scaled to unit length before solving.
    let scale = normal
        .diagonal()
        .map(|d| 1.0 / d.max(f64::MIN_POSITIVE).sqrt());
    let scaled = Matrix3::from_diagonal(&scale) * normal * Matrix3::from_diagonal(&scale);
    let solution = scaled
        .try_inverse()
        .map(|m| (m * right.component_mul(&scale)).component_mul(&scale));
    let (saa, sab, say) = (normal[(0, 0)], normal[(0, 1)], right[0]);
    let (mut b, mut lambda) = solution.map_or((say / saa, 0.0), |x| (x[0], x[1]));
    if !(b.is_finite() && lambda.is_finite()) {
        (b, lambda) = (say / saa, 0.0);
    }
    let duration = time[n - 1] - time[0];
    if data.kind == Kind::Drive && b <= 0.0 {
        b = (say / saa).abs();
    }
    let integrates = data.baseline == Baseline::Integrator;
    if integrates {
        b = say / saa;
    } else if lambda <= 0.0 {
        lambda = match data.kind {
            Kind::Drive => 0.0,
            Kind::Process => 10.0 / duration,
        };
        b = (say - lambda * sab) / saa;
    }
    if data.kind == Kind::Drive && (b.is_nan() || b <= 0.0) {
        // A resonance turns the motor against its torque: the sizes alone say how heavy it is.
        (b, lambda) = ((power / saa).sqrt(), 0.0);
    }
    if !b.is_finite() || b == 0.0 {
        return None;
    }
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    Some(match data.baseline {
        Baseline::Drive => vec![1.0 / b, lambda / b],
        Baseline::Integrator => vec![b],
        Baseline::Lag { from_ambient } => {
            let gain = b / lambda;
            // What the output is in the mean beside what the input gives; the ends weigh less the longer the record.
            let ambient = if from_ambient {
                0.0
            } else {
                let change = (v[n - 1] - v[0]) / (lambda * duration);
                mean(&v) - gain * mean(w) + change
            };
            vec![gain, 1.0 / lambda, ambient]
        }
    })
}
