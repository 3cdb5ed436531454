//! Torque ripple: the motor is stronger at some angles than at others.

use super::cogging::{frequencies, wave};
use super::{Dimension, Effect, EffectId, ParameterSpec, Probe, Range};
use crate::measurement::Kind;
use crate::model::{Instant, Model};

pub(super) const ID: EffectId = EffectId::new("torque_ripple");

pub(super) struct TorqueRipple;

/// The largest share of the torque that ripples ([`Range::UnitInterval`]).
const MOST: f64 = 1.0;

/// Share, spatial frequency and phase of a ripple with these parts; none where it is too large to be one.
fn ripple(frequency: f64, sine: f64, cosine: f64) -> Option<Vec<f64>> {
    let [share, phase] = wave(sine, cosine);
    (share <= MOST).then(|| vec![share, frequency, phase])
}

impl Effect for TorqueRipple {
    fn id(&self) -> EffectId {
        ID
    }

    fn name(&self) -> &'static str {
        "Torque ripple"
    }

    fn sentence(&self) -> &'static str {
        "The same current gives more torque at some angles than at others, again and again as the motor turns."
    }

    fn equation(&self) -> &'static str {
        "u_acting = u (1 + a sin(n x + phi))"
    }

    fn source(&self) -> &'static str {
        "mutual torque ripple: Jahns and Soong, Pulsating torque minimization techniques, 1996"
    }

    fn kinds(&self) -> &'static [Kind] {
        &[Kind::Drive]
    }

    fn parameters(&self) -> &'static [ParameterSpec] {
        &[
            ParameterSpec {
                symbol: "a",
                label: "share of the torque that ripples",
                dimension: Dimension::Ratio,
                range: Range::UnitInterval,
            },
            ParameterSpec {
                symbol: "n",
                label: "spatial frequency",
                dimension: Dimension::PerPosition,
                range: Range::Repeating,
            },
            ParameterSpec {
                symbol: "phi",
                label: "phase",
                dimension: Dimension::Phase,
                range: Range::Signed,
            },
        ]
    }

    fn starts(&self, probe: &Probe, _share: f64) -> Vec<Vec<f64>> {
        let (low, high) = probe.position_range();
        let frequencies = frequencies(high - low, probe.scales.speed * probe.scales.step);
        let at = |m: &Instant, n: f64| {
            [libm::sin(n * m.position), libm::cos(n * m.position)].map(|wave| m.input * wave)
        };
        let best = probe.best_waves(&frequencies, at).into_iter();
        best.filter_map(|(n, [sine, cosine])| ripple(n, sine, cosine))
            .collect()
    }

    fn apply(&self, values: &[f64], model: &mut Model) {
        let (a, n, phi) = (values[0], values[1], values[2]);
        model.own_forces.push(Box::new(move |now| {
            now.input * a * libm::sin(n * now.position + phi)
        }));
    }
}
