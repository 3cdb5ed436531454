//! Eccentric encoder: within a turn the reading runs ahead of the shaft and falls behind.

use std::f64::consts::{FRAC_PI_2, PI};

use super::{Dimension, Effect, EffectId, ParameterSpec, Probe, Range};
use crate::measurement::Kind;
use crate::model::{Eccentricity, Model};

pub(super) const ID: EffectId = EffectId::new("encoder_eccentricity");

pub(super) struct EncoderEccentricity;

/// Travel in rad from which on its wave is told from any other curve.
const LEAST_TRAVEL: f64 = PI;

/// Eccentricity and phases with which a fit begins.
const USUAL: f64 = 0.02;
const PHASES: [f64; 4] = [-FRAC_PI_2, 0.0, FRAC_PI_2, PI];

impl Effect for EncoderEccentricity {
    fn id(&self) -> EffectId {
        ID
    }

    fn name(&self) -> &'static str {
        "Eccentric encoder"
    }

    fn sentence(&self) -> &'static str {
        "The disc of the encoder is not centred on the shaft: once in a turn it shows too much and once too little."
    }

    fn equation(&self) -> &'static str {
        "x_seen = x + e sin(x + phi), v_seen = v (1 + e cos(x + phi))"
    }

    fn source(&self) -> &'static str {
        "once-per-revolution error: Ellis, Control System Design Guide, 2012"
    }

    fn kinds(&self) -> &'static [Kind] {
        &[Kind::Drive]
    }

    fn parameters(&self) -> &'static [ParameterSpec] {
        &[
            ParameterSpec {
                symbol: "e",
                label: "eccentricity of the encoder, share of its radius",
                dimension: Dimension::Ratio,
                range: Range::UnitInterval,
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
        if !probe.rotates || high - low < LEAST_TRAVEL {
            return Vec::new();
        }
        PHASES.map(|phase| vec![USUAL, phase]).to_vec()
    }

    fn apply(&self, values: &[f64], model: &mut Model) {
        model.encoder = Some(Eccentricity {
            amplitude: values[0],
            phase: values[1],
        });
    }
}
