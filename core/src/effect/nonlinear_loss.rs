//! Losses that grow faster than the difference to the surroundings: radiation, natural convection.
//!
//! Where its zero lies is a matter of the linear loss and of the operating point, which are fitted with it.

use super::atom::Values;
use super::{Atom, Dimension, Effect, EffectId, ParameterSpec, Part, Probe, Range};
use crate::measurement::Kind;
use crate::model::Model;

pub(super) const ID: EffectId = EffectId::new("nonlinear_loss");

pub(super) struct NonlinearLoss;

impl Effect for NonlinearLoss {
    fn id(&self) -> EffectId {
        ID
    }

    fn name(&self) -> &'static str {
        "Nonlinear loss"
    }

    fn sentence(&self) -> &'static str {
        "The hotter it gets, the more it loses for each further degree, as by radiation and rising air."
    }

    fn equation(&self) -> &'static str {
        "T dy/dt = K (u - b y^2) - y"
    }

    fn source(&self) -> &'static str {
        "Incropera and DeWitt, Fundamentals of Heat and Mass Transfer, 2007"
    }

    fn kinds(&self) -> &'static [Kind] {
        &[Kind::Process]
    }

    fn parameters(&self) -> &'static [ParameterSpec] {
        &[ParameterSpec {
            symbol: "b",
            label: "growth of the loss",
            dimension: Dimension::Loss,
            range: Range::Signed,
        }]
    }

    fn starts(&self, _probe: &Probe, _share: f64) -> Vec<Vec<f64>> {
        vec![vec![0.0]]
    }

    fn atoms(&self, _: Kind) -> Vec<Atom> {
        const COLUMNS: &[Part] = &[Part::Force(|m, _| -m.velocity * m.velocity)];
        vec![Atom::linear(COLUMNS, Values::Coefficients)]
    }

    fn apply(&self, values: &[f64], model: &mut Model) {
        let growth = values[0];
        model.forces.push(Box::new(move |_, y| -growth * y * y));
    }
}
