//! A process that swings before it settles.

use super::atom::Values;
use super::second_lag::{self, SECOND_DERIVATIVE};
use super::{Atom, Dimension, Effect, EffectId, ParameterSpec, Probe, Range, sensor_lag};
use crate::measurement::Kind;
use crate::model::Model;

pub(super) const ID: EffectId = EffectId::new("underdamped");

pub(super) struct Underdamped;

/// Periods of the free swing that a fit begins with, in time constants of the lag that follows it best.
const PERIODS: [f64; 5] = [1.0, 2.0, 5.0, 12.0, 30.0];

impl Effect for Underdamped {
    fn id(&self) -> EffectId {
        ID
    }

    fn name(&self) -> &'static str {
        "Oscillation"
    }

    fn sentence(&self) -> &'static str {
        "Something in the process keeps moving once it moves: the output swings about its new value before it settles."
    }

    fn equation(&self) -> &'static str {
        "T dy/dt = K u - y - (P/(2π))^2 dw/dt, w = dy/dt"
    }

    fn source(&self) -> &'static str {
        "underdamped second-order system: Åström and Murray, Feedback Systems, 2008"
    }

    fn kinds(&self) -> &'static [Kind] {
        &[Kind::Process]
    }

    fn parameters(&self) -> &'static [ParameterSpec] {
        &[ParameterSpec {
            symbol: "P",
            label: "period of the free swing",
            dimension: Dimension::Time,
            range: Range::Positive,
        }]
    }

    fn starts(&self, probe: &Probe, _share: f64) -> Vec<Vec<f64>> {
        let time = probe.scales.time_constant;
        PERIODS.map(|share| vec![share * time]).to_vec()
    }

    /// Where it is damped so much that it swings no more it is two lags.
    fn limits(&self) -> &'static [EffectId] {
        &[second_lag::ID, sensor_lag::ID]
    }

    fn atoms(&self, _: Kind) -> Vec<Atom> {
        vec![Atom::linear(
            SECOND_DERIVATIVE,
            Values::From(|solved| {
                let square = solved.coefficients[0] / solved.body[1];
                let period = std::f64::consts::TAU * square.sqrt();
                // With more damping it is two lags.
                let swings = solved.body[0] / solved.body[1] < 2.0 * square.sqrt();
                swings.then(|| (solved.body, vec![period]))
            }),
        )]
    }

    fn apply(&self, values: &[f64], model: &mut Model) {
        let time = values[0] / std::f64::consts::TAU;
        let stiffness = model.viscous;
        model.spring = Some(stiffness);
        model.viscous = model.inertia;
        model.inertia = stiffness * time * time;
    }
}
