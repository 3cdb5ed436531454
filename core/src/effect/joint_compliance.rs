//! Joint compliance: a load behind an elastic joint.

use super::{Dimension, Effect, EffectId, ParameterSpec, Probe, Range};
use crate::measurement::Kind;
use crate::model::{Coupling, Load, Model};

pub(super) struct JointCompliance;

/// Damping of the joint that is tried, over inertia times natural frequency: first one that blurs the
/// resonance over the distance of the frequencies tried, then less.
const DAMPING_RATIO: f64 = 0.05;
const FINER_DAMPING: [f64; 3] = [0.05, 0.015, 0.003];

/// Frequencies about a good one that are tried then, as ratios.
const FINER: f64 = 1.008;
const FINER_STEPS: i32 = 3;

/// Share of the unexplained force that a frequency may leave to be looked at more closely; and times the share asked for,
/// since damping that blurs a resonance leaves more than its own.
const PROMISING: f64 = 0.997;
const BLURRED: f64 = 2.0;

/// Natural frequencies that are followed.
const BEST: usize = 3;

/// Share of the unexplained force that a load with this natural frequency would leave beside an input that runs on by the
/// `changes` of its samples, and the effect's values: below the resonance, the load shows in little more than such a shift
/// of phase.
fn trial(probe: &Probe, changes: &[f64], omega: f64, damping: f64) -> Option<(f64, f64, Vec<f64>)> {
    let inertia = probe.scales.inertia.abs();
    let load = Load {
        inertia,
        viscous: 0.0,
        dry_friction: 0.0,
        coupling: Coupling {
            half_gap: 0.0,
            stiffness: inertia * omega * omega,
            damping: damping * inertia * omega,
        },
    };
    let torque = probe.load_torque(&load);
    let beside = probe.regress(&[&torque, changes]);
    // An input that never changes has no shift.
    let fit = beside.or_else(|| probe.regress(&[&torque]))?;
    let scale = -fit.coefficients[0];
    (scale > 0.0).then(|| {
        let c = load.coupling;
        let values = vec![scale * c.stiffness, scale * c.damping, scale * inertia, 0.0];
        (fit.left, omega, values)
    })
}

fn best(mut trials: Vec<(f64, f64, Vec<f64>)>) -> Vec<(f64, f64, Vec<f64>)> {
    trials.sort_by(|a, b| a.0.total_cmp(&b.0));
    trials.truncate(BEST);
    trials
}

impl Effect for JointCompliance {
    fn id(&self) -> EffectId {
        EffectId::new("joint_compliance")
    }

    fn name(&self) -> &'static str {
        "Joint compliance"
    }

    fn sentence(&self) -> &'static str {
        "A load is connected through a springy joint: it swings against the motor with a rhythm of its own."
    }

    fn equation(&self) -> &'static str {
        "J2 dv2/dt = K (x1 - x2) + D (v1 - v2) - d2 v2, and the opposite torque on the motor"
    }

    fn source(&self) -> &'static str {
        "two-mass drive with an elastic shaft: Nordin and Gutman, 2002, without play"
    }

    fn kinds(&self) -> &'static [Kind] {
        &[Kind::Drive]
    }

    fn parameters(&self) -> &'static [ParameterSpec] {
        &[
            ParameterSpec {
                symbol: "K",
                label: "stiffness of the joint",
                dimension: Dimension::Stiffness,
                range: Range::Stiff,
            },
            ParameterSpec {
                symbol: "D",
                label: "damping of the joint",
                dimension: Dimension::ViscousFriction,
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
        ]
    }

    fn starts(&self, probe: &Probe, share: f64) -> Vec<Vec<f64>> {
        let stretch = &probe.stretch();
        let changes = &stretch.input_changes();
        let tried = |guesses: Vec<(f64, f64)>| {
            let trial = |i: usize| trial(stretch, changes, guesses[i].0, guesses[i].1);
            let trials = stretch.crew.gather(guesses.len(), trial);
            best(trials.into_iter().flatten().collect())
        };
        let frequencies = stretch.load_frequencies().into_iter();
        let coarse = tried(frequencies.map(|omega| (omega, DAMPING_RATIO)).collect());
        let finer = coarse
            .iter()
            .filter(|(left, ..)| *left < PROMISING.min(BLURRED * share))
            .flat_map(|(_, omega, _)| {
                (-FINER_STEPS..=FINER_STEPS).map(move |k| omega * FINER.powi(k))
            })
            .flat_map(|omega| FINER_DAMPING.map(|damping| (omega, damping)));
        let found = tried(finer.collect())
            .into_iter()
            .filter(|t| Probe::may_be(t.0));
        found.map(|t| t.2).collect()
    }

    fn apply(&self, values: &[f64], model: &mut Model) {
        model.load = Some(Load {
            inertia: values[2],
            viscous: values[3],
            dry_friction: 0.0,
            coupling: Coupling {
                half_gap: 0.0,
                stiffness: values[0],
                damping: values[1],
            },
        });
    }
}
