//! Valve stiction: the stem sticks until the command has moved far enough, and slips.

use super::atom::{Values, shape};
use super::{Atom, Dimension, Effect, EffectId, ParameterSpec, Part, Probe, Range};
use crate::measurement::Kind;
use crate::model::{Actuator, Model, given};

pub(super) const ID: EffectId = EffectId::new("valve_stiction");

pub(super) struct ValveStiction;

/// Distances that are tried, as shares of the largest input, each with jumps of these times it.
const DISTANCES: [f64; 9] = [0.01, 0.02, 0.035, 0.05, 0.075, 0.1, 0.15, 0.22, 0.35];
const JUMPS: [f64; 4] = [0.0, 0.5, 1.5, 5.0];

impl Effect for ValveStiction {
    fn id(&self) -> EffectId {
        ID
    }

    fn name(&self) -> &'static str {
        "Valve stiction"
    }

    fn sentence(&self) -> &'static str {
        "The valve sticks when the command turns back, and lets go with a jump once it has been pushed far enough."
    }

    fn equation(&self) -> &'static str {
        "x rests until |u - x| > b + J, and slips to u -+ b; u_acting = x"
    }

    fn source(&self) -> &'static str {
        "Choudhury, Thornhill and Shah, Modelling valve stiction, 2005; He, Wang, Pottmann and Qin, 2007"
    }

    fn kinds(&self) -> &'static [Kind] {
        &[Kind::Process]
    }

    fn parameters(&self) -> &'static [ParameterSpec] {
        &[
            ParameterSpec {
                symbol: "b",
                label: "how far the valve stays behind",
                dimension: Dimension::Force,
                range: Range::NonNegative,
            },
            ParameterSpec {
                symbol: "J",
                label: "jump with which it breaks loose",
                dimension: Dimension::Force,
                range: Range::NonNegative,
            },
        ]
    }

    fn starts(&self, probe: &Probe, _share: f64) -> Vec<Vec<f64>> {
        let largest = probe.largest_input();
        [0.02, 0.07, 0.2]
            .map(|share| vec![share * largest, 0.0])
            .to_vec()
    }

    fn atoms(&self, _: Kind) -> Vec<Atom> {
        const COLUMNS: &[Part] = &[Part::Input(|track, [behind, jump, ..]| {
            let (behind, jump) = (*behind, *jump);
            given(Actuator::Stiction { behind, jump }, track.input, track.step)
        })];
        vec![Atom {
            parts: COLUMNS,
            grid: |extent| {
                let pairs = DISTANCES.iter().flat_map(|d| JUMPS.map(|j| (d, j)));
                pairs
                    .map(|(d, jump)| shape([d * extent.input, jump * d * extent.input]))
                    .collect()
            },
            shapes: 2,
            values: Values::From(|solved| {
                let [behind, jump, ..] = solved.shape;
                Some((solved.body, vec![behind, jump]))
            }),
        }]
    }

    fn apply(&self, values: &[f64], model: &mut Model) {
        model.actuator = Some(Actuator::Stiction {
            behind: values[0],
            jump: values[1],
        });
    }
}
