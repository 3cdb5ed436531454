//! Gravity on an arm: a torque that follows the sine of the angle.

use super::atom::Values;
use super::{
    Atom, Dimension, Effect, EffectId, NO_SHAPE, ParameterSpec, Part, Probe, Range, constant_load,
};
use crate::measurement::Kind;
use crate::model::Model;

pub(super) const ID: EffectId = EffectId::new("gravity");

pub(super) struct Gravity;

/// Travel in rad from which on a sine is told from a spring with a constant load.
const LEAST_SWING: f64 = 1.0;

/// Values with which the torque is `sine sin(x) + cosine cos(x)`.
fn arm(sine: f64, cosine: f64) -> Vec<f64> {
    vec![libm::hypot(sine, cosine), libm::atan2(cosine, -sine)]
}

impl Effect for Gravity {
    fn id(&self) -> EffectId {
        ID
    }

    fn name(&self) -> &'static str {
        "Gravity"
    }

    fn sentence(&self) -> &'static str {
        "An arm that is heavier on one side wants to hang down: the torque varies with the sine of its angle."
    }

    fn equation(&self) -> &'static str {
        "F = -a sin(x - x0), a = m g l"
    }

    fn source(&self) -> &'static str {
        "pendulum: Spong, Hutchinson and Vidyasagar, Robot Modeling and Control, 2006"
    }

    fn kinds(&self) -> &'static [Kind] {
        &[Kind::Drive]
    }

    fn parameters(&self) -> &'static [ParameterSpec] {
        &[
            ParameterSpec {
                symbol: "a",
                label: "largest gravity torque",
                dimension: Dimension::Force,
                range: Range::NonNegative,
            },
            ParameterSpec {
                symbol: "x0",
                label: "angle at which the arm hangs",
                dimension: Dimension::Phase,
                range: Range::Signed,
            },
        ]
    }

    fn starts(&self, probe: &Probe, _share: f64) -> Vec<Vec<f64>> {
        if !probe.rotates {
            return Vec::new();
        }
        let sine = probe.signature(|x, _| libm::sin(x));
        let cosine = probe.signature(|x, _| libm::cos(x));
        let fit = probe.regress(&[&sine, &cosine]);
        fit.map_or_else(Vec::new, |fit| {
            vec![arm(fit.coefficients[0], fit.coefficients[1])]
        })
    }

    /// Over a small angle, an arm far from upright is a constant load.
    fn limits(&self) -> &'static [EffectId] {
        &[constant_load::ID]
    }

    fn atoms(&self, _: Kind) -> Vec<Atom> {
        const COLUMNS: &[Part] = &[
            Part::Force(|m, _| libm::sin(m.position)),
            Part::Force(|m, _| libm::cos(m.position)),
        ];
        vec![Atom {
            parts: COLUMNS,
            grid: |extent| {
                let swings = extent.rotates && extent.travel >= LEAST_SWING;
                swings.then_some(NO_SHAPE).into_iter().collect()
            },
            shapes: 0,
            values: Values::From(|solved| {
                Some((
                    solved.body,
                    arm(solved.coefficients[0], solved.coefficients[1]),
                ))
            }),
        }]
    }

    fn apply(&self, values: &[f64], model: &mut Model) {
        let (torque, hanging) = (values[0], values[1]);
        model
            .forces
            .push(Box::new(move |x, _| -torque * libm::sin(x - hanging)));
    }
}
