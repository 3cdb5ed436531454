//! Joint compliance: a load behind an elastic joint.

use super::atom::{Values, geometric, shape};
use super::driven_load::{load_columns, load_values};
use super::{
    Atom, Dimension, Effect, EffectId, ParameterSpec, Part, Probe, Range, Track, coulomb_friction,
    presliding_friction,
};
use crate::measurement::Kind;
use crate::model::{Coupling, Load, Model};
use std::f64::consts::TAU;

pub(super) const ID: EffectId = EffectId::new("joint_compliance");

pub(super) struct JointCompliance;

/// Damping of the joint that is tried, over inertia times natural frequency: first one that blurs the
/// resonance over the distance of the frequencies tried, then less.
const DAMPING_RATIO: f64 = 0.05;
const FINER_DAMPING: [f64; 3] = [0.05, 0.015, 0.003];

/// Frequencies about a good one that are tried then, as ratios.
const FINER: f64 = 1.008;
const FINER_STEPS: i32 = 3;

/// Share of the unexplained force that a frequency may leave to be looked at more closely; and times the share asked
/// for, since damping that blurs a resonance leaves more than its own.
const PROMISING: f64 = 0.997;
const BLURRED: f64 = 2.0;

/// Dry friction of a load as heavy as the body, in units of the typical input, that is tried on the best; and one that
/// holds it now and then, which is tried at all frequencies.
const DRY_FRICTION: [f64; 5] = [0.03, 0.1, 0.3, 1.0, 3.0];
const HOLDING: f64 = 1.0;

/// Loads that are followed.
const BEST: usize = 3;

/// Share of the unexplained force that the best may leave for it not to be looked for where the body moves only.
const WELL_SEEN: f64 = 0.2;

/// A load that is tried.
#[derive(Clone, Copy)]
struct Guess {
    /// Its natural frequency, rad/s.
    omega: f64,
    /// Damping of the joint over inertia times natural frequency.
    damping: f64,
    /// Dry friction in units of the typical input, for a load as heavy as the body.
    dry: f64,
}

/// Share of the unexplained force that a load would leave where the probe explains what it does `beside`, and the
/// effect's values.
fn trial(probe: &Probe, beside: &Probe, guess: Guess) -> Option<(f64, Guess, Vec<f64>)> {
    let inertia = probe.scales.inertia.abs();
    let load = Load {
        inertia,
        viscous: 0.0,
        dry_friction: guess.dry * probe.scales.force,
        coupling: Coupling {
            half_gap: 0.0,
            stiffness: inertia * guess.omega * guess.omega,
            damping: guess.damping * inertia * guess.omega,
        },
    };
    let torque = probe.load_torque(&load);
    // An input that never changes has no shift.
    let alone = || probe.regress(&[&torque]);
    let fit = beside.regress(&[&torque]).or_else(alone)?;
    let scale = -fit.coefficients[0];
    (scale > 0.0).then(|| {
        let c = load.coupling;
        let values = vec![
            scale * c.stiffness,
            scale * c.damping,
            scale * inertia,
            0.0,
            scale * load.dry_friction,
        ];
        (fit.left, guess, values)
    })
}

fn best(mut trials: Vec<(f64, Guess, Vec<f64>)>) -> Vec<(f64, Guess, Vec<f64>)> {
    trials.sort_by(|a, b| a.0.total_cmp(&b.0));
    trials.truncate(BEST);
    trials
}

/// The best loads on this stretch of a record where one may leave less than this share of the unexplained force.
fn loads(stretch: &Probe, share: f64) -> Vec<(f64, Guess, Vec<f64>)> {
    // Below its resonance a load shows in little more than a shift of phase, as of an input that runs on by the changes
    // of its samples.
    let beside = &stretch.beside(&stretch.input_changes());
    let tried = |guesses: Vec<Guess>| -> Vec<_> {
        let trial = |i: usize| trial(stretch, beside, guesses[i]);
        let trials = stretch.crew.gather(guesses.len(), trial);
        trials.into_iter().flatten().collect()
    };
    let frequencies = stretch.load_frequencies();
    let coarse = |dry: f64| {
        let guess = |omega: &f64| Guess {
            omega: *omega,
            damping: DAMPING_RATIO,
            dry,
        };
        best(tried(frequencies.iter().map(guess).collect()))
    };
    let mut found = coarse(0.0);
    if found.first().is_none_or(|f| f.0 > WELL_SEEN) {
        found = best([found, coarse(HOLDING)].concat());
    }
    let near = |guess: Guess| {
        let finer = (-FINER_STEPS..=FINER_STEPS).map(move |k| guess.omega * FINER.powi(k));
        finer.flat_map(move |omega| {
            FINER_DAMPING.map(|damping| Guess {
                omega,
                damping,
                ..guess
            })
        })
    };
    let promising = found
        .iter()
        .filter(|(left, ..)| *left < PROMISING.min(BLURRED * share));
    let finer = best(tried(promising.flat_map(|f| near(f.1)).collect()));
    let rubbing = finer
        .iter()
        .flat_map(|(_, guess, _)| DRY_FRICTION.map(|dry| Guess { dry, ..*guess }));
    let rubbing = tried(rubbing.collect());
    best([finer, rubbing].concat())
}

/// Natural frequencies of the load that a regression tries: so many, up to this many radians a sample, each with these
/// damping ratios.
const FREQUENCIES: usize = 20;
const FASTEST: f64 = 0.6;
const RATIOS: [f64; 3] = [0.03, 0.1, 0.35];

/// Position of a load behind a spring that is pulled as measured, by its natural frequency (rad/s) and damping ratio;
/// trapezoidal rule.
fn on_spring(track: &Track, frequency: f64, ratio: f64) -> Vec<f64> {
    let h = track.step;
    let (stiff, damped) = (frequency * frequency, 2.0 * ratio * frequency);
    let mut before = track.position.first().copied().unwrap_or(0.0);
    let (mut at, mut speed) = (before, 0.0);
    let mut follow = |motor: f64| {
        let rate = (motor - before) / h;
        let pull = |x: f64, y: f64, v: f64| stiff * (x - y) + damped * (rate - v);
        // y and v after the step by the trapezoidal rule, solved for v.
        let now = pull(before, at, speed);
        let forward = stiff * (motor - at - h * speed / 2.0) + damped * rate;
        let after =
            (speed + h / 2.0 * (now + forward)) / (1.0 + h / 2.0 * (stiff * h / 2.0 + damped));
        at += h * f64::midpoint(speed, after);
        speed = after;
        before = motor;
        at
    };
    track.position.iter().map(|x| follow(*x)).collect()
}

impl Effect for JointCompliance {
    fn id(&self) -> EffectId {
        ID
    }

    fn name(&self) -> &'static str {
        "Joint compliance"
    }

    fn sentence(&self) -> &'static str {
        "A load is connected through a springy joint: it swings against the motor with a rhythm of its own."
    }

    fn equation(&self) -> &'static str {
        "J2 dv2/dt = K (x1 - x2) + D (v1 - v2) - d2 v2 - c2 sgn(v2), and the opposite torque on the motor"
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
            ParameterSpec {
                symbol: "c2",
                label: "load friction level",
                dimension: Dimension::Force,
                range: Range::NonNegative,
            },
        ]
    }

    /// A light load that rubs, on a stiff joint, is dry friction of the body.
    fn limits(&self) -> &'static [EffectId] {
        &[coulomb_friction::ID, presliding_friction::ID]
    }

    /// On a joint too stiff to be seen, the load is a part of the body; a load that its friction holds makes of the
    /// joint a spring to the ground.
    fn marks(&self) -> &'static [&'static str] {
        &["K", "J2"]
    }

    fn starts(&self, probe: &Probe, share: f64) -> Vec<Vec<f64>> {
        let found = loads(&probe.stretch(), share);
        let left = found.first().map_or(1.0, |f| f.0);
        let moving = probe.moving().filter(|_| left > WELL_SEEN);
        let moving = moving.and_then(|moving| loads(&moving.stretch(), 1.0).into_iter().next());
        let found = found.into_iter().filter(|t| Probe::may_be(t.0));
        // Beside the noise of short stretches, little may be seen of a load that decides when the body lets go.
        found.chain(moving).map(|t| t.2).collect()
    }

    /// The load follows the measured motion through a spring; what the motor gives it is linear in its inertia and
    /// friction.
    fn atoms(&self, _: Kind) -> Vec<Atom> {
        const COLUMNS: &[Part] = &[Part::Body(|track, [frequency, ratio, ..]| {
            load_columns(&on_spring(track, *frequency, *ratio), track.step)
        })];
        vec![Atom {
            parts: COLUMNS,
            grid: |extent| {
                let slowest = TAU / extent.window;
                let stiffest = FASTEST / extent.step;
                let all = geometric(slowest, stiffest, FREQUENCIES).into_iter();
                all.flat_map(|f| RATIOS.map(|ratio| shape([f[0], ratio])))
                    .collect()
            },
            shapes: 2,
            values: Values::From(|solved| {
                let [inertia, viscous, dry] = load_values(solved)?;
                let [frequency, ratio, ..] = solved.shape;
                let stiffness = inertia * frequency * frequency;
                let damping = 2.0 * ratio * frequency * inertia;
                Some((solved.body, vec![stiffness, damping, inertia, viscous, dry]))
            }),
        }]
    }

    fn apply(&self, values: &[f64], model: &mut Model) {
        model.load = Some(Load {
            inertia: values[2],
            viscous: values[3],
            dry_friction: values[4],
            coupling: Coupling {
                half_gap: 0.0,
                stiffness: values[0],
                damping: values[1],
            },
        });
    }
}
