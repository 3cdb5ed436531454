//! A spring to the ground.

use super::atom::Values;
use super::{Atom, Dimension, Effect, EffectId, ParameterSpec, Part, Probe, Range, constant_load};
use crate::measurement::Kind;
use crate::model::Model;

pub(super) const ID: EffectId = EffectId::new("return_spring");

pub(super) struct ReturnSpring;

/// Values with which the force is `-stiffness x + load`; none where it pushes away.
fn spring(stiffness: f64, load: f64) -> Option<Vec<f64>> {
    (stiffness > 0.0).then(|| vec![stiffness, load / stiffness])
}

impl Effect for ReturnSpring {
    fn id(&self) -> EffectId {
        ID
    }

    fn name(&self) -> &'static str {
        "Return spring"
    }

    fn sentence(&self) -> &'static str {
        "A spring between the drive and the ground pulls it back to one place, the harder the farther away it is."
    }

    fn equation(&self) -> &'static str {
        "F = -k (x - x0)"
    }

    fn source(&self) -> &'static str {
        "Hooke's law: Den Hartog, Mechanical Vibrations, 1956"
    }

    fn kinds(&self) -> &'static [Kind] {
        &[Kind::Drive]
    }

    fn parameters(&self) -> &'static [ParameterSpec] {
        &[
            ParameterSpec {
                symbol: "k",
                label: "stiffness of the spring",
                dimension: Dimension::Stiffness,
                range: Range::NonNegative,
            },
            ParameterSpec {
                symbol: "x0",
                label: "position at which it is relaxed",
                dimension: Dimension::Position,
                range: Range::Signed,
            },
        ]
    }

    fn starts(&self, probe: &Probe, _share: f64) -> Vec<Vec<f64>> {
        let place = probe.signature(|x, _| x);
        let always = probe.signature(|_, _| 1.0);
        let fit = probe.regress(&[&place, &always]);
        let found = fit.and_then(|fit| spring(-fit.coefficients[0], fit.coefficients[1]));
        found.into_iter().collect()
    }

    /// A spring that is relaxed far away is a constant load.
    fn limits(&self) -> &'static [EffectId] {
        &[constant_load::ID]
    }

    fn atoms(&self, _: Kind) -> Vec<Atom> {
        const COLUMNS: &[Part] = &[Part::Force(|m, _| -m.position), Part::Force(|_, _| 1.0)];
        vec![Atom::linear(
            COLUMNS,
            Values::From(|solved| {
                Some((
                    solved.body,
                    spring(solved.coefficients[0], solved.coefficients[1])?,
                ))
            }),
        )]
    }

    fn apply(&self, values: &[f64], model: &mut Model) {
        let (stiffness, relaxed) = (values[0], values[1]);
        model
            .forces
            .push(Box::new(move |x, _| -stiffness * (x - relaxed)));
    }
}
