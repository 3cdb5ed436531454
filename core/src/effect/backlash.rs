//! Backlash: a load behind a gap.
//!
//! The contact is a stiff spring with damping that pushes and cannot pull; the rigid play with
//! momentum-conserving impact, equations (10) and (11) of the paper, is its limit for large stiffness.

use super::{Dimension, Effect, EffectId, ParameterSpec, Probe, Range};
use crate::measurement::Kind;
use crate::model::{Coupling, Load, Model};

pub(super) struct Backlash;

/// Half gaps that are tried, as shares of the travel: evenly spaced on a log scale.
const GAPS: u32 = 24;
const SMALLEST_GAP: f64 = 0.005;
const LARGEST_GAP: f64 = 0.8;

/// Viscous and dry friction of the load that are tried, in units of those of the drive and its input.
const LOAD_FRICTION: [(f64, f64); 3] = [(1.0, 0.005), (1.0, 0.02), (3.0, 0.05)];

/// Stiffness and damping of the contact that are tried: a share of what one sample can follow.
const CONTACT: f64 = 0.2;

/// Gaps that are followed.
const BEST: usize = 3;

fn gap_shares() -> impl Iterator<Item = f64> {
    let ratio = (LARGEST_GAP / SMALLEST_GAP).powf(1.0 / f64::from(GAPS - 1));
    (0..GAPS).map(move |i| SMALLEST_GAP * ratio.powf(f64::from(i)))
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
        let inertia = probe.scales.inertia.abs();
        let mut found: Vec<(f64, Vec<f64>)> = Vec::new();
        for share in gap_shares() {
            for (viscous, friction) in LOAD_FRICTION {
                let load = Load {
                    inertia,
                    viscous: viscous * probe.scales.viscous,
                    dry_friction: friction * probe.scales.force,
                    coupling: Coupling {
                        half_gap: share * probe.scales.travel,
                        stiffness: CONTACT * probe.scales.of(Dimension::Stiffness),
                        damping: CONTACT * inertia / probe.scales.step,
                    },
                };
                let Some(fit) = probe.regress(&[&probe.load_torque(&load)]) else {
                    continue;
                };
                let scale = -fit.coefficients[0];
                if scale > 0.0 {
                    let c = load.coupling;
                    let values = vec![
                        c.half_gap,
                        scale * load.inertia,
                        scale * load.viscous,
                        scale * load.dry_friction,
                        scale * c.stiffness,
                        scale * c.damping,
                    ];
                    found.push((fit.left, values));
                }
            }
        }
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        found.into_iter().take(BEST).map(|f| f.1).collect()
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
