//! Stribeck friction: dry friction that is higher at standstill than in motion.
//!
//! It contains Coulomb friction (no excess) with its elastic contact, and replaces it.

use super::atom::{Values, not_negative, shape};
use super::dry_friction::{DAMPING, LEVEL, LONG};
use super::spec::HARD_CROSSINGS;
use super::{
    Atom, Dimension, Effect, EffectId, ParameterSpec, Part, Probe, Range, coulomb_friction,
    presliding_friction,
};
use crate::measurement::Kind;
use crate::model::Model;

pub(super) struct StribeckFriction;

/// Stribeck speeds that are tried, in typical speeds.
const SPEEDS: [f64; 8] = [0.03, 0.06, 0.12, 0.2, 0.3, 0.45, 0.7, 1.1];

/// The same friction in a contact that is all but rigid, and in one that can be seen to give way: at every turn a body
/// on a rigid one rubs at its excess, so that a search on too soft a contact gives it another Stribeck speed.
fn contacts(soft: Vec<f64>, crossed: f64) -> [Vec<f64>; 2] {
    let mut rigid = soft.clone();
    rigid[3] = HARD_CROSSINGS * crossed;
    [rigid, soft]
}

impl Effect for StribeckFriction {
    fn id(&self) -> EffectId {
        EffectId::new("stribeck_friction")
    }

    fn name(&self) -> &'static str {
        "Stribeck friction"
    }

    fn sentence(&self) -> &'static str {
        "Dry friction that is strongest at rest and falls off as the drive gets moving, so that it sticks, breaks loose and jumps ahead."
    }

    fn equation(&self) -> &'static str {
        "F = -(c + (c_s - c) exp(-(v / v_s)^2)) sgn(v) while moving; at rest F balances the input up to c_s"
    }

    fn source(&self) -> &'static str {
        "R. Stribeck, 1902; exponential form: Bo and Pavelescu, 1982; Armstrong-Hélouvry, Dupont and Canudas de Wit, 1994"
    }

    fn kinds(&self) -> &'static [Kind] {
        &[Kind::Drive]
    }

    fn parameters(&self) -> &'static [ParameterSpec] {
        &[
            ParameterSpec {
                label: "friction level in motion",
                ..LEVEL
            },
            ParameterSpec {
                symbol: "dc",
                label: "excess at standstill",
                dimension: Dimension::Force,
                range: Range::NonNegative,
            },
            ParameterSpec {
                symbol: "v_s",
                label: "Stribeck speed",
                dimension: Dimension::Speed,
                range: Range::Positive,
            },
            LONG,
            DAMPING,
        ]
    }

    /// Friction may be all in what it takes to start.
    fn telling(&self) -> usize {
        2
    }

    fn contains(&self) -> &'static [EffectId] {
        &[coulomb_friction::ID, presliding_friction::ID]
    }

    fn starts(&self, probe: &Probe, _share: f64) -> Vec<Vec<f64>> {
        let crossed = probe.scales.crossed();
        let sign = probe.signature(|_, v| v.signum());
        let mut found: Vec<(f64, Vec<f64>)> = SPEEDS
            .iter()
            .filter_map(|share| {
                let speed = share * probe.scales.speed;
                let falling = probe.signature(|_, v| v.signum() * libm::exp(-(v / speed).powi(2)));
                let fit = probe.regress(&[&sign, &falling])?;
                let (level, excess) = (-fit.coefficients[0], -fit.coefficients[1]);
                (level + excess > 0.0).then(|| {
                    let level = level.max(0.1 * (level + excess));
                    let excess = excess.max(0.1 * level);
                    // More than the input ever overcomes would hold the body for good.
                    let share = (probe.largest_input() / (level + excess)).min(1.0);
                    let (level, excess) = (share * level, share * excess);
                    (fit.left, vec![level, excess, speed, 0.5 * crossed, 0.1])
                })
            })
            .collect();
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        let best = found.into_iter().take(2);
        best.flat_map(|f| contacts(f.1, crossed)).collect()
    }

    fn atoms(&self, _: Kind) -> Vec<Atom> {
        const COLUMNS: &[Part] = &[
            Part::Force(|m, _| -m.direction),
            Part::Force(|m, speed| -m.direction * libm::exp(-(m.velocity / speed[0]).powi(2))),
        ];
        vec![Atom {
            parts: COLUMNS,
            grid: |extent| SPEEDS.map(|share| shape([share * extent.speed])).to_vec(),
            shapes: 1,
            values: Values::From(|solved| {
                let (body, levels) = not_negative(solved)?;
                Some((body, vec![levels[0], levels[1], solved.shape[0], 0.0, 0.1]))
            }),
        }]
    }

    fn apply(&self, values: &[f64], model: &mut Model) {
        model.friction.level += values[0];
        model.friction.static_excess = values[1];
        model.friction.stribeck_speed = values[2];
        model.friction.presliding = values[3];
        model.friction.contact_damping = values[4];
    }
}
