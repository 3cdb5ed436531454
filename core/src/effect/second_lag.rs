//! A second first-order lag in series with the process.

use super::atom::Values;
use super::effect::slower_is_the_process;
use super::{Atom, Dimension, Effect, EffectId, ParameterSpec, Part, Probe, Range, Series};
use crate::measurement::Kind;
use crate::model::Model;

pub(super) const ID: EffectId = EffectId::new("second_lag");

pub(super) struct SecondLag;

/// Body of the slower of two lags and time constant of the faster one, where `inertia y' + damping y` stands beside
/// this coefficient times `y''`; none where one of them would not settle.
fn lags([inertia, damping]: [f64; 2], coefficient: f64) -> Option<([f64; 2], f64)> {
    // Of the polynomial 1 + sum s + product s^2.
    let (sum, product) = (inertia / damping, coefficient / damping);
    let root = (sum * sum / 4.0 - product).max(0.0).sqrt();
    let (slow, fast) = (sum / 2.0 + root, sum / 2.0 - root);
    (product > 0.0 && fast > 0.0).then_some(([slow * damping, damping], fast))
}

/// What a process of second order has beside one of first order.
pub(super) const SECOND_DERIVATIVE: &[Part] = &[Part::Motion(|track, _| {
    let values = track.velocity.iter().map(|y| -y).collect();
    vec![Series {
        derivative: 2,
        values,
    }]
})];

impl Effect for SecondLag {
    fn id(&self) -> EffectId {
        ID
    }

    fn name(&self) -> &'static str {
        "Second lag"
    }

    fn sentence(&self) -> &'static str {
        "The process has a second storage in series, so that its output starts to move gently instead of at once."
    }

    fn equation(&self) -> &'static str {
        "T_2 du_acting/dt = u - u_acting, in series with the first lag"
    }

    fn source(&self) -> &'static str {
        "second-order lag: Åström and Hägglund, Advanced PID Control, 2006"
    }

    fn kinds(&self) -> &'static [Kind] {
        &[Kind::Process]
    }

    fn parameters(&self) -> &'static [ParameterSpec] {
        &[ParameterSpec {
            symbol: "T2",
            label: "second time constant",
            dimension: Dimension::Time,
            range: Range::Positive,
        }]
    }

    fn starts(&self, probe: &Probe, _share: f64) -> Vec<Vec<f64>> {
        [0.02, 0.05, 0.1, 0.2, 0.4, 0.8]
            .iter()
            .map(|share| vec![share * probe.scales.time_constant])
            .collect()
    }

    fn order(&self, kind: Kind, body: &mut [f64], values: &mut [f64]) -> bool {
        slower_is_the_process(kind, body, values)
    }

    /// `T T2 y'' + (T + T2) y' + y = K u`.
    fn atoms(&self, _: Kind) -> Vec<Atom> {
        vec![Atom::linear(
            SECOND_DERIVATIVE,
            Values::From(|solved| {
                let (body, fast) = lags(solved.body, solved.coefficients[0])?;
                Some((body, vec![fast]))
            }),
        )]
    }

    fn apply(&self, values: &[f64], model: &mut Model) {
        model.lag = Some(values[0]);
        // Both storages are the process's: a load fills the one after the other.
        model.load_before_lag = true;
    }
}
