//! Presliding friction: a soft contact that gives way like a spring before it slips.
//!
//! The same contact as in Coulomb friction, with a deflection so long that its build-up is seen
//! sample by sample (Maxwell-slip elements along Dahl's curve).

use super::atom::{Values, geometric, not_negative};
use super::dry_friction::{DAMPING, LEVEL, LONG};
use super::{
    Atom, BodyStart, Effect, EffectId, ParameterSpec, Part, Probe, Series, coulomb_friction,
};
use crate::measurement::Kind;
use crate::model::Model;

pub(super) const ID: EffectId = EffectId::new("presliding_friction");

pub(super) struct PreslidingFriction;

/// Deflections that are tried, in displacements of the first sample after a reversal.
const CROSSINGS: [f64; 4] = [4.0, 12.0, 40.0, 150.0];

/// Longer ones up to the travel that are compared by what they leave of the unexplained force, and how many of the best
/// are tried.
const LONGER: u32 = 12;
const BEST: usize = 2;

fn starts(level: f64, probe: &Probe) -> Vec<Vec<f64>> {
    let crossed = probe.scales.crossed();
    let values = CROSSINGS.map(|samples| vec![level, samples * crossed, 0.1]);
    values.to_vec()
}

/// Values with the longer deflections that leave least of the unexplained force, beside friction that needs none, if
/// that is less than this `share` of it; and the body that goes with them.
fn long_starts(probe: &Probe, share: f64) -> Vec<BodyStart> {
    let shortest = CROSSINGS[3] * probe.scales.crossed();
    let ratio = libm::pow(probe.scales.travel / shortest, 1.0 / f64::from(LONGER));
    if !(ratio > 1.0 && ratio.is_finite()) {
        return Vec::new();
    }
    let probe = &probe.stretch();
    let sign = probe.signature(|_, v| v.signum());
    let tried = probe.crew.gather(LONGER as usize, |k| {
        let s = shortest * libm::pow(ratio, k as f64 + 0.5);
        let fit = probe.regress(&[&probe.deflection(s), &sign])?;
        let level = -fit.coefficients[0];
        (level > 0.0 && fit.left < share && Probe::may_be(fit.left))
            .then_some((fit.left, (fit.body, vec![level, s, 0.1])))
    });
    let mut found: Vec<(f64, _)> = tried.into_iter().flatten().collect();
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    found.truncate(BEST);
    found.into_iter().map(|(_, start)| start).collect()
}

/// Displacements that a regression tries: from the first to the second of these shares of the travel, so many.
const LEAST_WAY: f64 = 3e-4;
const MOST_WAY: f64 = 0.2;
const WAYS: usize = 10;

impl Effect for PreslidingFriction {
    fn id(&self) -> EffectId {
        ID
    }

    fn name(&self) -> &'static str {
        "Presliding friction"
    }

    fn sentence(&self) -> &'static str {
        "The contact gives way like a spring before it slips: after each reversal the friction builds up gradually over a small displacement."
    }

    fn equation(&self) -> &'static str {
        "F follows the displacement x after a reversal, F = -c + 2 c (1 - exp(-x / s)), up to the friction level c"
    }

    fn source(&self) -> &'static str {
        "Dahl, 1968; Maxwell-slip (Prandtl-Ishlinskii) form: Iwan, 1966; Lampaert, Al-Bender and Swevers, 2003"
    }

    fn kinds(&self) -> &'static [Kind] {
        &[Kind::Drive]
    }

    fn parameters(&self) -> &'static [ParameterSpec] {
        &[LEVEL, LONG, DAMPING]
    }

    fn contains(&self) -> &'static [EffectId] {
        &[coulomb_friction::ID]
    }

    fn starts(&self, probe: &Probe, share: f64) -> Vec<Vec<f64>> {
        let mut all = starts(probe.friction_level(), probe);
        all.extend(long_starts(probe, share).into_iter().map(|long| long.1));
        all
    }

    /// Where friction builds up over a long way, what it takes looked like a viscous friction that there is not.
    fn starts_with_body(&self, probe: &Probe, share: f64) -> Vec<BodyStart> {
        let mut found = long_starts(probe, share);
        found.retain(|(body, _)| body[1] >= 0.0);
        let told = probe.balanced_bristle();
        let told = told.map(|(s, balance)| (balance.body, vec![balance.forces[0], s, 0.1]));
        found.extend(told);
        found
    }

    fn atoms(&self, _: Kind) -> Vec<Atom> {
        const COLUMNS: &[Part] = &[Part::Motion(|track, way| {
            let mut bristle: f64 = 0.0;
            let mut before = track.position.first().copied().unwrap_or(0.0);
            let mut rub = |x: f64| {
                let moved = x - before;
                before = x;
                let end = if moved == 0.0 { 0.0 } else { moved.signum() };
                bristle = end + (bristle - end) * libm::exp(-moved.abs() / way[0]);
                -bristle
            };
            let values = track.position.iter().map(|x| rub(*x)).collect();
            vec![Series {
                derivative: 0,
                values,
            }]
        })];
        vec![Atom {
            parts: COLUMNS,
            grid: |extent| geometric(LEAST_WAY * extent.travel, MOST_WAY * extent.travel, WAYS),
            shapes: 1,
            values: Values::From(|solved| {
                let (body, level) = not_negative(solved)?;
                Some((body, vec![level[0], solved.shape[0], 0.1]))
            }),
        }]
    }

    fn apply(&self, values: &[f64], model: &mut Model) {
        model.friction.level += values[0];
        model.friction.presliding = values[1];
        model.friction.contact_damping = values[2];
    }
}
