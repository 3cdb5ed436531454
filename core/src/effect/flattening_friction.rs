//! Viscous friction that flattens with speed, as grease that gets thin.

use super::atom::{Values, geometric, not_negative};
use super::{
    Atom, Dimension, Effect, EffectId, ParameterSpec, Part, Probe, Range, coulomb_friction,
};
use crate::measurement::Kind;
use crate::model::Model;

pub(super) const ID: EffectId = EffectId::new("flattening_friction");

pub(super) struct FlatteningFriction;

/// Speeds that are tried, in typical ones, and how many from the first to the last by a regression.
const SPEEDS: [f64; 3] = [0.1, 0.5, 2.0];
const TRIED: usize = 8;

impl Effect for FlatteningFriction {
    fn id(&self) -> EffectId {
        ID
    }

    fn name(&self) -> &'static str {
        "Flattening friction"
    }

    fn sentence(&self) -> &'static str {
        "Friction grows with speed, but less and less, as in a gear whose grease gets thinner the faster it turns."
    }

    fn equation(&self) -> &'static str {
        "F = -c v / (|v| + v_h)"
    }

    fn source(&self) -> &'static str {
        "shear-thinning lubricant: Bair and Winer, 1979; sublinear viscous friction of gears: Hayward and Armstrong, 2000"
    }

    fn kinds(&self) -> &'static [Kind] {
        &[Kind::Drive]
    }

    fn parameters(&self) -> &'static [ParameterSpec] {
        &[
            ParameterSpec {
                symbol: "c",
                label: "friction at high speed",
                dimension: Dimension::Force,
                range: Range::NonNegative,
            },
            ParameterSpec {
                symbol: "v_h",
                label: "speed at which half of it is reached",
                dimension: Dimension::Speed,
                range: Range::Positive,
            },
        ]
    }

    fn starts(&self, probe: &Probe, _share: f64) -> Vec<Vec<f64>> {
        let tried = SPEEDS.map(|share| {
            let half = share * probe.scales.speed;
            let shape = probe.signature(|_, v| -v / (v.abs() + half));
            let fit = probe.regress(&[&shape])?;
            (fit.coefficients[0] > 0.0).then(|| (fit.left, vec![fit.coefficients[0], half]))
        });
        let best = tried
            .into_iter()
            .flatten()
            .min_by(|a, b| a.0.total_cmp(&b.0));
        best.into_iter().map(|(_, values)| values).collect()
    }

    /// Without a speed at which it flattens it is dry friction.
    fn contains(&self) -> &'static [EffectId] {
        &[coulomb_friction::ID]
    }

    fn atoms(&self, _: Kind) -> Vec<Atom> {
        const COLUMNS: &[Part] = &[Part::Force(|m, half| {
            -m.velocity / (m.velocity.abs() + half[0])
        })];
        vec![Atom {
            parts: COLUMNS,
            grid: |extent| geometric(SPEEDS[0] * extent.speed, SPEEDS[2] * extent.speed, TRIED),
            shapes: 1,
            values: Values::From(|solved| {
                let (body, level) = not_negative(solved)?;
                Some((body, vec![level[0], solved.shape[0]]))
            }),
        }]
    }

    fn apply(&self, values: &[f64], model: &mut Model) {
        let (level, half) = (values[0], values[1]);
        model
            .forces
            .push(Box::new(move |_, v| -level * v / (v.abs() + half)));
    }
}
