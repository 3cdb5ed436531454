//! Static curvature: the static characteristic is bent.
//!
//! Three places can bend: the balance of the process (its time constant then changes with the output), the sensor and
//! the valve. All are fitted.

use super::atom::Values;
use super::{
    Atom, Dimension, Effect, EffectId, ParameterSpec, Part, Probe, Range, constant_load,
    gain_asymmetry,
};
use crate::measurement::Kind;
use crate::model::Model;

pub(super) struct StaticCurvature;

impl Effect for StaticCurvature {
    fn id(&self) -> EffectId {
        EffectId::new("static_curvature")
    }

    fn name(&self) -> &'static str {
        "Static curvature"
    }

    fn sentence(&self) -> &'static str {
        "The static characteristic is bent: the same step of the input moves the output more on one side than on the other."
    }

    fn equation(&self) -> &'static str {
        "T dw/dt = K (u + g u^2) - w - q w^2, y = w + p w^2"
    }

    fn source(&self) -> &'static str {
        "second-order static nonlinearity: Hammerstein and Wiener models, Ljung, System Identification, 1999"
    }

    fn kinds(&self) -> &'static [Kind] {
        &[Kind::Process]
    }

    fn parameters(&self) -> &'static [ParameterSpec] {
        &[
            ParameterSpec {
                symbol: "q",
                label: "curvature of the balance",
                dimension: Dimension::PerOutput,
                range: Range::Signed,
            },
            ParameterSpec {
                symbol: "p",
                label: "curvature of the reading",
                dimension: Dimension::PerOutput,
                range: Range::Signed,
            },
            ParameterSpec {
                symbol: "g",
                label: "curvature of the valve",
                dimension: Dimension::PerInput,
                range: Range::Signed,
            },
        ]
    }

    fn starts(&self, _probe: &Probe, _share: f64) -> Vec<Vec<f64>> {
        vec![vec![0.0; 3]]
    }

    fn telling(&self) -> usize {
        3
    }

    /// What bends two levels of an input makes one act more than the other.
    fn limits(&self) -> &'static [EffectId] {
        &[gain_asymmetry::ID, constant_load::ID]
    }

    fn atoms(&self, _: Kind) -> Vec<Atom> {
        const BALANCE: &[Part] = &[Part::Force(|m, _| -m.velocity * m.velocity)];
        const VALVE: &[Part] = &[Part::Force(|m, _| m.input * m.input)];
        vec![
            Atom::linear(
                BALANCE,
                Values::From(|solved| {
                    Some((
                        solved.body,
                        vec![solved.coefficients[0] / solved.body[1], 0.0, 0.0],
                    ))
                }),
            ),
            Atom::linear(
                VALVE,
                Values::From(|solved| Some((solved.body, vec![0.0, 0.0, solved.coefficients[0]]))),
            ),
        ]
    }

    fn apply(&self, values: &[f64], model: &mut Model) {
        // As a force on the body (T/K) w' = u - w/K - (q/K) w^2.
        let (balance, reading, valve) = (values[0] * model.viscous, values[1], values[2]);
        model.input_maps.push(Box::new(move |u| u + valve * u * u));
        model.forces.push(Box::new(move |_, w| -balance * w * w));
        model
            .output_maps
            .push(Box::new(move |w| w + reading * w * w));
    }
}
