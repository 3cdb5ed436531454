//! First-order lag between the commanded and the acting input of a drive.

use super::atom::{Values, geometric};
use super::{Atom, Dimension, Effect, EffectId, ParameterSpec, Part, Probe, Range};
use crate::measurement::Kind;
use crate::model::Model;

pub(super) struct ActuatorLag;

/// Time constants that a regression tries.
const LAGS: usize = 20;

/// Mean over each sample of a held input behind a lag of so many samples, which has come to rest at first.
fn lagged(input: &[f64], samples: f64) -> Vec<f64> {
    let decay = libm::exp(-1.0 / samples);
    let mean = samples * -libm::expm1(-1.0 / samples);
    let mut state = input.first().copied().unwrap_or(0.0);
    let mut of = |u: f64| {
        let off = state - u;
        state = u + off * decay;
        u + off * mean
    };
    input.iter().map(|u| of(*u)).collect()
}

impl Effect for ActuatorLag {
    fn id(&self) -> EffectId {
        EffectId::new("actuator_lag")
    }

    fn name(&self) -> &'static str {
        "Actuator lag"
    }

    fn sentence(&self) -> &'static str {
        "The actuator follows the command gradually, like a filter: fast at first, then ever slower towards the full value."
    }

    fn equation(&self) -> &'static str {
        "T_a du_acting/dt = u - u_acting"
    }

    fn source(&self) -> &'static str {
        "first-order actuator, e.g. the current loop of a drive: Leonhard, Control of Electrical Drives, 2001"
    }

    fn kinds(&self) -> &'static [Kind] {
        &[Kind::Drive]
    }

    fn parameters(&self) -> &'static [ParameterSpec] {
        &[ParameterSpec {
            symbol: "T_a",
            label: "actuator time constant",
            dimension: Dimension::Time,
            range: Range::Positive,
        }]
    }

    fn starts(&self, probe: &Probe, _share: f64) -> Vec<Vec<f64>> {
        [0.5, 1.5, 5.0, 15.0, 50.0]
            .iter()
            .map(|samples| vec![samples * probe.scales.step])
            .collect()
    }

    fn atoms(&self, _: Kind) -> Vec<Atom> {
        const COLUMNS: &[Part] = &[Part::Input(|track, lag| {
            lagged(track.input, lag[0] / track.step)
        })];
        vec![Atom {
            parts: COLUMNS,
            grid: |extent| geometric(0.3 * extent.step, 0.5 * extent.window, LAGS),
            shapes: 1,
            values: Values::Shape,
        }]
    }

    fn apply(&self, values: &[f64], model: &mut Model) {
        model.lag = Some(values[0]);
    }
}
