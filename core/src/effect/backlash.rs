//! Backlash: a load behind a gap.
//!
//! The contact is a stiff spring with damping that pushes and cannot pull; the rigid play with
//! momentum-conserving impact, equations (10) and (11) of the paper, is its limit for large stiffness.

use std::f64::consts::FRAC_PI_2;

use super::atom::{Values, geometric};
use super::driven_load::is_load;
use super::probe::Bounces;
use super::{
    Atom, BodyStart, Dimension, Effect, EffectId, GapLoad, ParameterSpec, Part, Probe, Range,
    SeenGap, Series, Shape, Track, joint_compliance,
};
use crate::measurement::Kind;
use crate::model::{Coupling, Load, Model, load_torque};
use crate::simplex::minimise;

pub(super) struct Backlash;

/// Half gaps that are tried, as shares of the travel: the contact comes and goes within a narrow range
/// of gaps, so that they lie close together.
const SMALLEST_GAP: f64 = 5e-4;
const LARGEST_GAP: f64 = 0.8;
const GAP_RATIO: f64 = 1.15;
const GAP_SPACING: f64 = 1.0 / 160.0;

/// Rate at which a free load is slowed down by viscous friction, per sample, and its dry friction in
/// units of the typical input.
const LOAD_FRICTION: [(f64, f64); 5] = [
    (1e-3, 0.01),
    (1e-3, 0.0),
    (4e-3, 0.0),
    (3e-2, 0.0),
    (1e-3, 0.05),
];

/// Stiffness of the contact: squared radians of its oscillation in a sample.
const STIFFNESS: [f64; 4] = [0.03, 0.01, 0.2, 1.0];

/// Friction and stiffness with which all gaps are tried: a load that goes on by itself, and one that is soon slow.
const SCANNED: [((f64, f64), f64); 2] = [
    (LOAD_FRICTION[0], STIFFNESS[0]),
    (LOAD_FRICTION[3], STIFFNESS[3]),
];

/// Damping ratio of the contact.
const DAMPING_RATIO: f64 = 0.3;

/// A contact that a fit left soft may as well be as many times as stiff.
const STIFFER: [f64; 3] = [6.0, 40.0, 250.0];

/// Damping ratio of a contact that bounces, and its stiffnesses in times of that which the screen finds: a load that
/// follows a noisy motion through it bounces at other times than it did, so that a contact that swallows all it can
/// explains more there.
const BOUNCING: f64 = 0.05;
const HARDER: [f64; 2] = [1.0, 4.0];

/// Stiffness of a contact that was felt, in times of what the length of its push tells.
const FELT_STIFFNESS: [f64; 10] = [0.01, 0.018, 0.032, 0.056, 0.1, 0.18, 0.32, 0.56, 1.0, 3.2];

/// Damping ratio of such a contact.
const FELT_DAMPING: [f64; 2] = [0.05, 0.25];

/// Stiffness of a contact that is met again and again, in times of what its pushes tell: those are means over samples.
const MET_STIFFNESS: [f64; 3] = [1.0, 0.5, 2.0];

/// Dry friction of the load, in units of the typical input, that stands for none.
const LEAST_DRY: f64 = 1e-4;

/// Trials that are refined; sides of the simplex (logarithms), its evaluations, and share of the unexplained force
/// that is not worth more of them.
const FOLLOWED: usize = 2;
const SIDE: f64 = 0.4;
const EVALUATIONS: usize = 120;
const ENOUGH: f64 = 1e-4;

/// Gaps that are tried with every friction and stiffness, and combinations that are followed.
const REFINED: usize = 5;
const BEST: usize = 3;

/// Share of the unexplained force that the best gap may leave for loads behind it to be tried.
const PROMISING: f64 = 0.995;

/// Share of the unexplained force that may be left by a gap seen in the record for no other to be tried.
const WELL_SEEN: f64 = 0.2;

/// Times the share that a gap may leave from which on, where all leave more on a smoothed motion, none will leave less
/// than that on the motion as it was measured.
const WITHIN_REACH: f64 = 4.0;

fn gap_shares() -> impl Iterator<Item = f64> {
    std::iter::successors(Some(SMALLEST_GAP), |share| {
        Some((share * GAP_RATIO).min(share + GAP_SPACING))
    })
    .take_while(|share| *share < LARGEST_GAP)
}

/// A load that is tried.
#[derive(Clone, Copy)]
struct Guess {
    half_gap: f64,
    /// Rate at which viscous friction slows the free load down, per sample.
    viscous: f64,
    /// Dry friction in units of the typical input, for a load as heavy as the body.
    dry: f64,
    /// Squared radians of the contact's oscillation in a sample.
    stiffness: f64,
    /// Damping ratio of the contact.
    damping: f64,
}

impl Guess {
    fn new(half_gap: f64, (viscous, dry): (f64, f64), stiffness: f64) -> Self {
        Self {
            half_gap,
            viscous,
            dry,
            stiffness,
            damping: DAMPING_RATIO,
        }
    }

    fn logarithms(&self) -> [f64; 5] {
        [
            self.half_gap,
            self.viscous,
            self.dry.max(LEAST_DRY),
            self.stiffness,
            self.damping,
        ]
        .map(libm::log)
    }

    fn from_logarithms(point: &[f64; 5]) -> Self {
        let [half_gap, viscous, dry, stiffness, damping] = point.map(libm::exp);
        Self {
            half_gap,
            viscous,
            dry,
            stiffness,
            damping,
        }
    }
}

/// A starting point with the share of the unexplained force that it leaves.
#[derive(Clone)]
struct Trial {
    left: f64,
    guess: Guess,
    load: Load,
    /// By how much the load must be scaled.
    scale: f64,
    /// Inertia and viscous friction of the body that goes with it.
    body: [f64; 2],
}

impl Trial {
    fn new(probe: &Probe, guess: Guess) -> Option<Self> {
        let (inertia, step) = (probe.scales.inertia.abs(), probe.scales.step);
        let load = Load {
            inertia,
            viscous: guess.viscous * inertia / step,
            dry_friction: guess.dry * probe.scales.force,
            coupling: Coupling {
                half_gap: guess.half_gap,
                stiffness: guess.stiffness * inertia / (step * step),
                damping: 2.0 * guess.damping * guess.stiffness.sqrt() * inertia / step,
            },
        };
        let fit = probe.regress(&[&probe.load_torque(&load)])?;
        let scale = -fit.coefficients[0];
        (scale > 0.0).then_some(Self {
            left: fit.left,
            guess,
            load,
            scale,
            body: fit.body,
        })
    }

    /// The best nearby.
    fn refined(self, probe: &Probe) -> Self {
        let left = |point: &[f64; 5]| {
            let guess = Guess::from_logarithms(point);
            Self::new(probe, guess).map_or(1.0, |trial| trial.left)
        };
        let start = self.guess.logarithms();
        let (point, _) = minimise(left, start, SIDE, EVALUATIONS, ENOUGH);
        let better = Self::new(probe, Guess::from_logarithms(&point));
        better
            .filter(|trial| trial.left < self.left)
            .unwrap_or(self)
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

/// What comes of these guesses.
fn tried(probe: &Probe, guesses: &[Guess]) -> Vec<Trial> {
    let trial = |i: usize| Trial::new(probe, guesses[i]);
    let trials = probe.crew.gather(guesses.len(), trial).into_iter();
    trials.flatten().collect()
}

fn best(mut trials: Vec<Trial>, count: usize) -> Vec<Trial> {
    trials.sort_by(|a, b| a.left.total_cmp(&b.left));
    trials.truncate(count);
    trials
}

/// Starting points where the motor felt the load: only the contact is to be found.
fn felt(probe: &Probe, half_gap: f64, load: GapLoad) -> Vec<Vec<f64>> {
    let body = probe.inertia();
    let inertia = load.inertia_ratio * body;
    let joined = body * inertia / (body + inertia);
    // A push is half an oscillation.
    let push = load.push.max(0.5 * probe.scales.step);
    let stiffness = joined * (FRAC_PI_2 / push).powi(2);
    let contact = |(share, damping): (f64, f64)| {
        let stiffness = share * stiffness;
        vec![
            half_gap,
            inertia,
            load.viscous * inertia,
            load.dry * inertia,
            stiffness,
            2.0 * damping * (stiffness * joined).sqrt(),
        ]
    };
    let shares = FELT_STIFFNESS.iter();
    shares
        .flat_map(|share| FELT_DAMPING.map(|damping| contact((*share, damping))))
        .collect()
}

/// The best loads behind these gaps, refined.
fn behind(probe: &Probe, gaps: &[f64]) -> Vec<Trial> {
    let guesses = gaps.iter().flat_map(|half_gap| {
        LOAD_FRICTION
            .into_iter()
            .flat_map(|friction| STIFFNESS.map(|k| Guess::new(*half_gap, friction, k)))
    });
    let trials = best(tried(probe, &guesses.collect::<Vec<_>>()), BEST);
    let refined = probe.crew.gather(trials.len(), |i| {
        let trial = trials[i].clone();
        if i < FOLLOWED {
            trial.refined(probe)
        } else {
            trial
        }
    });
    best(refined, BEST)
}

/// Starting points where a load was met again and again.
fn met_again(met: &Bounces) -> Vec<BodyStart> {
    let [inertia, viscous, dry] = met.load;
    let [stiffness, damping] = met.contact;
    let start = |times: f64| {
        vec![
            met.half_gap,
            inertia,
            viscous,
            dry,
            times * stiffness,
            times.sqrt() * damping,
        ]
    };
    MET_STIFFNESS.map(|times| (met.body, start(times))).to_vec()
}

/// The best loads behind a gap that nobody has seen, where one may leave less than this share of the unexplained force.
fn hidden(probe: &Probe, share: f64) -> Vec<Trial> {
    let stretch = probe.stretch();
    let smooth = scanned(&stretch);
    let mut found = behind(&stretch, &promising(&smooth, share));
    let well_seen = found.first().is_some_and(|trial| trial.left <= WELL_SEEN);
    if !well_seen
        && smooth
            .first()
            .is_some_and(|best| best.left < WITHIN_REACH * share)
    {
        let measured = stretch.as_measured();
        found.extend(behind(&measured, &promising(&scanned(&measured), share)));
    }
    found.retain(|trial| Probe::may_be(trial.left));
    found
}

/// Loads behind all gaps, the best first.
fn scanned(stretch: &Probe) -> Vec<Trial> {
    let gaps = gap_shares().map(|share| share * stretch.scales.travel);
    let guesses = gaps.flat_map(|gap| SCANNED.map(|(friction, k)| Guess::new(gap, friction, k)));
    let guesses: Vec<Guess> = guesses.collect();
    best(tried(stretch, &guesses), guesses.len())
}

/// The best gaps of those that leave less than this share.
fn promising(scanned: &[Trial], share: f64) -> Vec<f64> {
    let mut gaps: Vec<f64> = Vec::new();
    for trial in scanned {
        let gap = trial.guess.half_gap;
        if trial.left < PROMISING.min(share) && gaps.len() < REFINED && !gaps.contains(&gap) {
            gaps.push(gap);
        }
    }
    gaps
}

/// Half gaps that a regression tries: from the first to the second of these shares of the travel, so many; each with
/// these rates of a free load's decay, in typical accelerations per typical speed, and dry decelerations, in typical
/// accelerations.
const SCREENED_GAPS: [f64; 2] = [1.0 / 400.0, 1.0 / 6.0];
const GAPS: usize = 14;
const RATES: [f64; 2] = [0.05, 0.3];
const DRY: [f64; 2] = [0.01, 0.15];

/// Force on the motor from a load of unit inertia that follows the measured motion through a gap, at every sample.
fn pushed_back(track: &Track, numbers: &Shape) -> Vec<f64> {
    let [half_gap, viscous, dry_friction, stiffness, damping] = *numbers;
    let coupling = Coupling {
        half_gap,
        stiffness,
        damping,
    };
    let load = Load {
        inertia: 1.0,
        viscous,
        dry_friction,
        coupling,
    };
    let spans = [(0, track.position.len())];
    let pushes = load_torque(&load, track.position, track.step, &spans);
    pushes.iter().map(|force| -force).collect()
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
                range: Range::Hard,
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
        &[joint_compliance::ID]
    }

    fn starts(&self, probe: &Probe, _share: f64) -> Vec<Vec<f64>> {
        if let Some((half_gap, load)) = probe.gap().and_then(|g| Some((g.half_gap, g.load?))) {
            return felt(probe, half_gap, load);
        }
        let seen = probe
            .gap()
            .map_or_else(Vec::new, |gap| behind(probe, &[gap.half_gap]));
        seen.iter().map(Trial::values).collect()
    }

    fn starts_with_body(&self, probe: &Probe, share: f64) -> Vec<BodyStart> {
        let met = probe.bounces().map_or_else(Vec::new, |met| met_again(&met));
        let told = probe.gap().is_some_and(|gap| {
            let seen = || behind(probe, &[gap.half_gap]);
            gap.load.is_some() || seen().first().is_some_and(|trial| trial.left < WELL_SEEN)
        });
        if told {
            return met;
        }
        let found = hidden(probe, share);
        let found = found.iter().filter(|trial| trial.body[1] >= 0.0);
        let found = found.map(|trial| (trial.body, trial.values()));
        met.into_iter().chain(found).collect()
    }

    fn other_contacts(&self, values: &[f64], bouncing: bool) -> Vec<Vec<f64>> {
        let (times, damping_ratio): (&[f64], f64) = if bouncing {
            (&HARDER, BOUNCING)
        } else {
            (&STIFFER, DAMPING_RATIO)
        };
        let other = |times: &f64| {
            let (inertia, stiffness) = (values[1], times * values[4]);
            let mut values = values.to_vec();
            values[4] = stiffness;
            values[5] = 2.0 * damping_ratio * (stiffness * inertia).sqrt();
            values
        };
        times.iter().map(other).collect()
    }

    fn least_errors(&self, values: &[f64], gap: &SeenGap) -> Vec<f64> {
        let Some(load) = gap.load else {
            return Vec::new();
        };
        let shares = values.iter().skip(1).zip(load.errors);
        let load = shares.map(|(value, share)| value * share);
        std::iter::once(gap.error).chain(load).collect()
    }

    /// A load of unit inertia follows the measured motion through the gap; what the motor gives it is linear in its
    /// inertia.
    fn atoms(&self, _: Kind) -> Vec<Atom> {
        const COLUMNS: &[Part] = &[Part::Body(|track, numbers| {
            vec![Series {
                derivative: 0,
                values: pushed_back(track, numbers),
            }]
        })];
        vec![Atom {
            parts: COLUMNS,
            grid: |extent| {
                let slowest = extent.acceleration / extent.speed;
                let [least, most] = SCREENED_GAPS;
                let gaps = geometric(least * extent.travel, most * extent.travel, GAPS);
                let stiffness = STIFFNESS[0] / (extent.step * extent.step);
                let damping = 2.0 * DAMPING_RATIO * stiffness.sqrt();
                let with = |gap: f64| {
                    let rates = RATES.map(|share| share * slowest).into_iter();
                    rates.flat_map(move |rate| {
                        DRY.map(|dry| [gap, rate, dry * extent.acceleration, stiffness, damping])
                    })
                };
                gaps.into_iter().flat_map(|gap| with(gap[0])).collect()
            },
            shapes: 5,
            values: Values::From(|solved| {
                let [half_gap, viscous, dry, stiffness, damping] = solved.shape;
                let inertia = solved.coefficients[0];
                let shares = [1.0, viscous, dry, stiffness, damping];
                let load = shares.map(|share| inertia * share);
                is_load(inertia, solved)
                    .then(|| (solved.body, [&[half_gap], load.as_slice()].concat()))
            }),
        }]
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
