//! Backlash: a load behind a gap.
//!
//! The contact is a stiff spring with damping that pushes and cannot pull; the rigid play with
//! momentum-conserving impact, equations (10) and (11) of the paper, is its limit for large stiffness.

use super::{Dimension, Effect, EffectId, ParameterSpec, Probe, Range, SeenGap};
use crate::measurement::Kind;
use crate::model::{Coupling, Load, Model};

pub(super) struct Backlash;

/// Half gaps that are tried, as shares of the travel: the contact comes and goes within a narrow range
/// of gaps, so that they lie close together.
const SMALLEST_GAP: f64 = 5e-4;
const LARGEST_GAP: f64 = 0.8;
const GAP_RATIO: f64 = 1.15;
const GAP_SPACING: f64 = 1.0 / 160.0;

/// Rate at which a free load is slowed down by viscous friction, per sample, and its dry friction in
/// units of the typical input.
const LOAD_FRICTION: [(f64, f64); 4] = [(1e-3, 0.01), (1e-3, 0.0), (4e-3, 0.0), (1e-3, 0.05)];

/// Stiffness of the contact: squared radians of its oscillation in a sample.
const STIFFNESS: [f64; 3] = [0.03, 0.01, 0.2];

/// Damping ratio of the contact.
const DAMPING_RATIO: f64 = 0.3;

/// Gaps that are tried with every friction and stiffness, and combinations that are followed.
const REFINED: usize = 5;
const BEST: usize = 3;

/// Share of the unexplained force that may be left by a gap seen in the record for no other to be tried.
const WELL_SEEN: f64 = 0.2;

fn gap_shares() -> impl Iterator<Item = f64> {
    std::iter::successors(Some(SMALLEST_GAP), |share| {
        Some((share * GAP_RATIO).min(share + GAP_SPACING))
    })
    .take_while(|share| *share < LARGEST_GAP)
}

/// A starting point with the share of the unexplained force that it leaves.
#[derive(Clone)]
struct Trial {
    left: f64,
    load: Load,
    /// By how much the load must be scaled.
    scale: f64,
}

impl Trial {
    fn new(probe: &Probe, half_gap: f64, friction: (f64, f64), stiffness: f64) -> Option<Self> {
        let (inertia, step) = (probe.scales.inertia.abs(), probe.scales.step);
        let load = Load {
            inertia,
            viscous: friction.0 * inertia / step,
            dry_friction: friction.1 * probe.scales.force,
            coupling: Coupling {
                half_gap,
                stiffness: stiffness * inertia / (step * step),
                damping: 2.0 * DAMPING_RATIO * stiffness.sqrt() * inertia / step,
            },
        };
        let fit = probe.regress(&[&probe.load_torque(&load)])?;
        let scale = -fit.coefficients[0];
        (scale > 0.0).then_some(Self {
            left: fit.left,
            load,
            scale,
        })
    }

    fn values(&self) -> Vec<f64> {
        let c = self.load.coupling;
        let scale = self.scale;
        vec![
            c.half_gap,
            scale * self.load.inertia,
            scale * self.load.viscous,
            scale * self.load.dry_friction,
            scale * c.stiffness,
            scale * c.damping,
        ]
    }
}

fn best(mut trials: Vec<Trial>, count: usize) -> Vec<Trial> {
    trials.sort_by(|a, b| a.left.total_cmp(&b.left));
    trials.truncate(count);
    trials
}

/// The best starting points about a gap that was seen: only its contact is to be found.
fn about(probe: &Probe, gap: SeenGap) -> Vec<Trial> {
    let scales = &probe.scales;
    let friction = match gap.load_friction {
        Some((viscous, dry)) => vec![(
            viscous * scales.step,
            dry * scales.inertia.abs() / scales.force,
        )],
        None => LOAD_FRICTION.to_vec(),
    };
    let trials = friction
        .into_iter()
        .flat_map(|friction| STIFFNESS.map(|k| (friction, k)))
        .filter_map(|(friction, k)| Trial::new(probe, gap.half_gap, friction, k))
        .collect();
    best(trials, BEST)
}

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
        "J2 dv2/dt = T - d2 v2 - c2 sgn(v2), T = K (|x1 - x2| - beta) + D |v1 - v2| towards the load where |x1 - x2| > beta and T > 0, else 0"
    }

    fn source(&self) -> &'static str {
        "rigid play, equations (10) and (11) of the paper; elastic contact: Nordin and Gutman, 2002"
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
                range: Range::Sizeable,
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
                symbol: "K",
                label: "stiffness of the contact",
                dimension: Dimension::Stiffness,
                range: Range::Stiff,
            },
            ParameterSpec {
                symbol: "D",
                label: "damping of the contact",
                dimension: Dimension::ViscousFriction,
                range: Range::NonNegative,
            },
        ]
    }

    fn contains(&self) -> &'static [EffectId] {
        const { &[EffectId::new("joint_compliance")] }
    }

    fn starts(&self, probe: &Probe) -> Vec<Vec<f64>> {
        let seen = probe.gap().map_or_else(Vec::new, |gap| about(probe, gap));
        if seen.first().is_some_and(|trial| trial.left < WELL_SEEN) {
            return seen.iter().map(Trial::values).collect();
        }
        let scanned = gap_shares()
            .filter_map(|share| {
                let half_gap = share * probe.scales.travel;
                Trial::new(probe, half_gap, LOAD_FRICTION[0], STIFFNESS[0])
            })
            .collect();
        let refined = best(scanned, REFINED)
            .iter()
            .flat_map(|trial| {
                let half_gap = trial.load.coupling.half_gap;
                LOAD_FRICTION
                    .iter()
                    .flat_map(|friction| STIFFNESS.map(|k| (*friction, k)))
                    .filter_map(move |(friction, k)| Trial::new(probe, half_gap, friction, k))
            })
            .collect();
        best(refined, BEST).iter().map(Trial::values).collect()
    }

    fn apply(&self, values: &[f64], model: &mut Model) {
        model.load = Some(Load {
            inertia: values[1],
            viscous: values[2],
            dry_friction: values[3],
            coupling: Coupling {
                half_gap: values[0],
                stiffness: values[4],
                damping: values[5],
            },
        });
    }
}
