//! Backlash: a load behind a gap.

use super::{Dimension, Effect, EffectId, ParameterSpec, Range, Scales};
use crate::measurement::Kind;
use crate::model::{Model, Play};

pub(super) struct Backlash;

impl Effect for Backlash {
    fn id(&self) -> EffectId {
        EffectId::new("backlash")
    }

    fn name(&self) -> &'static str {
        "Backlash"
    }

    fn sentence(&self) -> &'static str {
        "The motor turns freely through a small gap before it meets the load: light in the gap, heavy when it pushes, with a knock in between."
    }

    fn equation(&self) -> &'static str {
        "|x1 - x2| <= beta; in contact (J1 + J2) v' = u - (d1 + d2) v - friction; impacts keep J1 v1 + J2 v2, relative speed times -e"
    }

    fn source(&self) -> &'static str {
        "rigid play, equations (10) and (11) of the paper; Nordin and Gutman, 2002"
    }

    fn kinds(&self) -> &'static [Kind] {
        &[Kind::Drive]
    }

    fn parameters(&self) -> &'static [ParameterSpec] {
        &[
            ParameterSpec {
                symbol: "beta",
                label: "half gap",
                dimension: Dimension::Position,
                range: Range::NonNegative,
            },
            ParameterSpec {
                symbol: "J2",
                label: "load inertia",
                dimension: Dimension::Inertia,
                range: Range::Positive,
            },
            ParameterSpec {
                symbol: "d2",
                label: "load viscous friction",
                dimension: Dimension::ViscousFriction,
                range: Range::NonNegative,
            },
            ParameterSpec {
                symbol: "c2",
                label: "load friction level",
                dimension: Dimension::Force,
                range: Range::NonNegative,
            },
            ParameterSpec {
                symbol: "e",
                label: "restitution",
                dimension: Dimension::Ratio,
                range: Range::UnitInterval,
            },
        ]
    }

    fn starts(&self, scales: &Scales) -> Vec<Vec<f64>> {
        // The gap lies anywhere between a fraction of the travel and half of it.
        [0.45, 0.3, 0.2, 0.12, 0.07, 0.04, 0.02, 0.01]
            .iter()
            .map(|share| {
                vec![
                    share * scales.travel,
                    scales.inertia,
                    scales.viscous,
                    0.02 * scales.force,
                    0.2,
                ]
            })
            .collect()
    }

    fn apply(&self, values: &[f64], model: &mut Model) {
        model.play = Some(Play {
            half_gap: values[0],
            inertia: values[1],
            viscous: values[2],
            dry_friction: values[3],
            restitution: values[4],
        });
    }
}
