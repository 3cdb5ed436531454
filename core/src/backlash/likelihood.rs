//! How well do a gap and a load explain where the contacts lie?

use rand::SeedableRng as _;
use rand_distr::{Distribution as _, StandardNormal};
use rand_pcg::Pcg64;

use crate::model::{LoadState, Play, SeenContact, Sharpness, Slowing, Surprise};
use crate::simplex::minimise;

/// Unknowns: logarithms of half gap, motor inertia over load inertia, viscous and dry slowing of the
/// load, noise of a contact's place, relative noise of its momentum. The second and the fourth are
/// divided by the half gap: a light load that rattles in the gap shows these quotients far better than
/// their parts, so that the search goes along the ridge instead of across.
const UNKNOWNS: usize = 6;
type Point = [f64; UNKNOWNS];

/// Degrees of freedom of Student's distribution of the innovations: a missed contact must not decide.
const FREEDOM: f64 = 4.0;

/// Half gaps that are tried, geometrically spaced, with these loads.
const GAPS: usize = 36;
const INERTIA_RATIOS: [f64; 3] = [0.4, 1.0, 2.5];
const VISCOUS: [f64; 2] = [0.5, 5.0];
const DRY_SHARES: [f64; 3] = [1e-4, 5e-3, 3e-2];

/// Starts that are followed, and evaluations for each and for the last polish.
const STARTS: usize = 5;
const EVALUATIONS: usize = 500;
const POLISH: usize = 1200;

/// Contacts times steps of the sampling, and bounds of the steps.
const WORK: usize = 3_000_000;
const LEAST_STEPS: usize = 3000;
const MOST_STEPS: usize = 12_000;

/// First steps of the sampling (logarithms), share of accepted steps, steps between adaptations, seed.
const FIRST_STEPS: Point = [0.01, 0.01, 0.1, 0.1, 0.1, 0.1];
const ACCEPTED: f64 = 0.25;
const ADAPT: usize = 100;
const SEED: u64 = 2026;

/// Error of the relative speed at the begin of a contact, as share of the cycle's speed.
const SLOW: f64 = 0.05;

/// Error of the begin of a contact, samples.
const LATE: f64 = 0.5;

/// What is known beforehand of the logarithms: mean and standard deviation. Wide: a load of a seventh
/// to seven times the motor's inertia lies within one and a half of them.
struct Prior {
    mean: Point,
    deviation: Point,
}

impl Prior {
    /// A half gap that is known has its standard error.
    fn of(scales: &Scales, half_gap: Option<(f64, f64)>) -> Self {
        Self {
            mean: [
                half_gap.map_or(0.0, |(value, _)| libm::log(value)),
                0.0,
                libm::log(2.0_f64),
                libm::log(0.01 * scales.acceleration),
                libm::log(0.25 * scales.step * scales.speed),
                libm::log(0.01_f64),
            ],
            deviation: [
                half_gap.map_or(f64::INFINITY, |(value, error)| error / value),
                1.2,
                1.5,
                2.0,
                0.7,
                1.0,
            ],
        }
    }
}

/// Sizes that the prior needs.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scales {
    /// Sampling time, s.
    pub step: f64,
    /// Speed of the cycle, rad/s or m/s.
    pub speed: f64,
    /// Acceleration by the relay, rad/s^2 or m/s^2.
    pub acceleration: f64,
    /// Travel in the record, rad or m.
    pub travel: f64,
    /// Whether touches too light to be seen may have pushed the load along.
    pub unseen: bool,
}

/// How far a contact lies from where the load was expected.
#[derive(Clone, Copy, Debug)]
pub(super) struct Innovation {
    /// Measured minus expected position of the motor.
    pub value: f64,
    pub deviation: f64,
    /// Whether the load was lost before, so that nothing was expected.
    pub lost: bool,
}

/// The best explanation.
#[derive(Clone, Debug)]
pub(super) struct Fit {
    pub play: Play,
    /// Standard error of the half gap.
    pub error: f64,
    /// Standard errors of the load's inertia, viscous and dry friction, as shares of these.
    pub load_errors: [f64; 3],
    /// How well the contacts tell.
    pub sharpness: Sharpness,
    /// One for each event but the first.
    pub innovations: Vec<Innovation>,
}

/// Most likely half gap and load; `None` where the contacts do not tell. A half gap that is known, with its standard
/// error, is kept: contacts at one end show the load only.
pub(super) fn fit(
    events: &[SeenContact],
    scales: &Scales,
    half_gap: Option<(f64, f64)>,
) -> Option<Fit> {
    let prior = Prior::of(scales, half_gap);
    let errors = Errors {
        slow: SLOW * scales.speed,
        late: LATE * scales.step,
        unseen: scales.unseen,
        unknown: Surprise {
            value: 0.0,
            variance: scales.travel * scales.travel,
        },
    };
    let cost = |point: &Point| {
        let plain = plain(point);
        let prior: f64 = (0..UNKNOWNS)
            .map(|i| 0.5 * ((plain[i] - prior.mean[i]) / prior.deviation[i]).powi(2))
            .sum();
        let value = filter(events, point, errors, None) + prior;
        if value.is_finite() { value } else { f64::MAX }
    };
    let (least, most) = (scales.travel / 400.0, scales.travel);
    let gaps: Vec<f64> = match half_gap {
        Some((value, _)) => vec![value],
        None => (0..GAPS)
            .map(|k| least * libm::pow(most / least, k as f64 / (GAPS - 1) as f64))
            .collect(),
    };
    let mut starts: Vec<(Point, f64)> = gaps
        .into_iter()
        .filter_map(|half_gap| best_load(&cost, prior.mean, half_gap, scales.acceleration))
        .collect();
    starts.sort_by(|a, b| a.1.total_cmp(&b.1));
    let best = starts
        .iter()
        .take(STARTS)
        .map(|start| minimise(cost, start.0, 0.3, EVALUATIONS, 1e-3))
        .min_by(|a, b| a.1.total_cmp(&b.1))?;
    let (point, value) = minimise(cost, best.0, 0.1, POLISH, 1e-6);
    if value >= f64::MAX {
        return None;
    }
    let steps = (WORK / events.len().max(1)).clamp(LEAST_STEPS, MOST_STEPS);
    let posterior = sample(&cost, point, value, steps);
    let point = posterior.mean;
    let mut innovations = Vec::new();
    filter(events, &point, errors, Some(&mut innovations));
    let (play, sharpness) = meaning(&point, errors.late);
    // The logarithm of each as a sum of the unknowns: that of the ratio is the first two together, and the frictions
    // stand there divided by the load's inertia.
    let relative = |weights: Point| {
        let weights = nalgebra::SVector::from(weights);
        let variance = (weights.transpose() * posterior.covariance * weights)[0];
        variance.max(0.0).sqrt()
    };
    Some(Fit {
        error: play.half_gap * relative([1.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
        load_errors: [
            relative([1.0, 1.0, 0.0, 0.0, 0.0, 0.0]),
            relative([-1.0, -1.0, 1.0, 0.0, 0.0, 0.0]),
            relative([0.0, -1.0, 0.0, 1.0, 0.0, 0.0]),
        ],
        play,
        sharpness,
        innovations,
    })
}

/// Of the loads that are tried with a half gap the one that costs least.
fn best_load(
    cost: &impl Fn(&Point) -> f64,
    mean: Point,
    half_gap: f64,
    acceleration: f64,
) -> Option<(Point, f64)> {
    let mut best: Option<(Point, f64)> = None;
    for ratio in INERTIA_RATIOS {
        for viscous in VISCOUS {
            for dry in DRY_SHARES {
                let mut point = mean;
                point[0] = libm::log(half_gap);
                point[1] = libm::log(ratio) - point[0];
                point[2] = libm::log(viscous);
                point[3] = libm::log(dry * acceleration) - point[0];
                let value = cost(&point);
                if best.is_none_or(|b| value < b.1) {
                    best = Some((point, value));
                }
            }
        }
    }
    best
}

/// What the logarithms stand for; `late` is the error of the begin of a contact, s.
fn meaning(point: &Point, late: f64) -> (Play, Sharpness) {
    let [half_gap, ratio, viscous, dry, place, momentum] = plain(point).map(libm::exp);
    let play = Play {
        half_gap,
        ratio,
        slowing: Slowing { viscous, dry },
    };
    let sharpness = Sharpness {
        place,
        late,
        momentum,
    };
    (play, sharpness)
}

/// The logarithms themselves, no longer divided by the half gap.
fn plain(point: &Point) -> Point {
    let mut plain = *point;
    plain[1] += point[0];
    plain[3] += point[0];
    plain
}

/// How well a contact is seen.
#[derive(Clone, Copy)]
struct Errors {
    /// Of the relative speed at its begin, rad/s or m/s.
    slow: f64,
    /// Of its begin, s.
    late: f64,
    /// Whether touches too light to be seen may have pushed the load along.
    unseen: bool,
    /// Where nothing is known of the load: the travel.
    unknown: Surprise,
}

/// Minus the logarithm of the likelihood of the innovations, up to a constant.
fn filter(
    events: &[SeenContact],
    point: &Point,
    errors: Errors,
    mut innovations: Option<&mut Vec<Innovation>>,
) -> f64 {
    let (play, sharpness) = meaning(point, errors.late);
    let Some(first) = events.first() else {
        return 0.0;
    };
    let mut state = LoadState::at_rest(first.load_at(play.half_gap), &sharpness);
    let mut total = 0.0;
    for (k, event) in events.iter().enumerate() {
        if k > 0 {
            let before = &events[k - 1];
            let mut now = before.begin + before.centre;
            let mut lost = false;
            for turn in event.turns.iter().flatten() {
                // At the other end a load is hit before it is pushed along, and that is seen.
                if errors.unseen && turn.time > now && turn.side * before.side > 0.0 {
                    state.fly(&play.slowing, turn.time - now);
                    lost |= state.is_passed(turn, play.half_gap, &sharpness);
                    now = turn.time;
                }
            }
            state.fly(&play.slowing, event.begin - now);
            let mut surprise = state.surprise(event, play.half_gap, &sharpness);
            if lost {
                // It may be met anywhere, and is found again.
                surprise = errors.unknown;
                state = LoadState::at_rest(event.load_at(play.half_gap), &sharpness);
            }
            let (value, variance) = (surprise.value, surprise.variance);
            if let Some(list) = innovations.as_deref_mut() {
                list.push(Innovation {
                    value,
                    deviation: variance.sqrt(),
                    lost,
                });
            }
            if event.free {
                let square = value * value / variance;
                total += 0.5 * libm::log(variance)
                    + 0.5 * (FREEDOM + 1.0) * libm::log1p(square / FREEDOM);
                // What is random is when they meet, not where: density in time, not in position.
                let approach = event.side * (event.velocity - state.v);
                total -= libm::log(errors.slow * softplus(approach / errors.slow));
                if !lost {
                    state.meet(&surprise);
                }
            }
        }
        state.fly(&play.slowing, event.centre);
        state.push(event, &play, &sharpness);
    }
    total
}

/// Mean and covariance of the unknowns under the likelihood times the prior.
struct Posterior {
    mean: Point,
    covariance: Matrix,
}

type Matrix = nalgebra::SMatrix<f64, UNKNOWNS, UNKNOWNS>;

/// Samples the posterior from `start` on: adaptive Metropolis (Haario, Saksman and Tamminen 2001, "An
/// adaptive Metropolis algorithm", Bernoulli 7). Where gap and load can scale together the cost is flat
/// along a bent ridge, of which a curvature at its lowest point would know nothing.
fn sample(cost: &impl Fn(&Point) -> f64, start: Point, value: f64, steps: usize) -> Posterior {
    let mut random = Pcg64::seed_from_u64(SEED);
    let mut normal = || -> f64 { StandardNormal.sample(&mut random) };
    let mut at = start;
    let mut here = value;
    let mut root = Matrix::from_diagonal(&nalgebra::SVector::from(FIRST_STEPS));
    let mut sum = nalgebra::SVector::<f64, UNKNOWNS>::zeros();
    let mut squares = Matrix::zeros();
    let (mut count, mut scale) = (0.0, 1.0_f64);
    for step in 0..steps {
        let move_ = root * nalgebra::SVector::<f64, UNKNOWNS>::from_fn(|_, _| normal()) * scale;
        let proposed: Point = std::array::from_fn(|i| at[i] + move_[i]);
        let there = cost(&proposed);
        // Minus the logarithm of a uniform number, from two normal ones.
        let threshold = 0.5 * (normal().powi(2) + normal().powi(2));
        let accepted = there - here < threshold;
        if accepted {
            (at, here) = (proposed, there);
        }
        // Robbins and Monro: a quarter of the steps accepted.
        let gain = libm::pow(step as f64 + 1.0, -0.6);
        scale *= libm::exp((f64::from(u8::from(accepted)) - ACCEPTED) * gain);
        if step < steps / 10 {
            continue;
        }
        let v = nalgebra::SVector::from(at) - nalgebra::SVector::from(start);
        count += 1.0;
        sum += v;
        squares += v * v.transpose();
        if step % ADAPT == 0 && step < steps / 2 && count > 200.0 {
            let mean = sum / count;
            let covariance = squares / count - mean * mean.transpose();
            if let Some(cholesky) = (covariance + Matrix::identity() * 1e-10).cholesky() {
                root = cholesky.l() * (2.4 / (UNKNOWNS as f64).sqrt());
            }
            if step % (4 * ADAPT) == 0 {
                (sum, squares, count) = (sum * 0.5, squares * 0.5, count * 0.5);
            }
        }
    }
    let mean = sum / count.max(1.0);
    Posterior {
        mean: std::array::from_fn(|i| start[i] + mean[i]),
        covariance: squares / count.max(1.0) - mean * mean.transpose(),
    }
}

/// `ln(1 + e^x)`: `x` where it is large, next to nothing below zero.
fn softplus(x: f64) -> f64 {
    x.max(0.0) + libm::log1p(libm::exp(-x.abs()))
}
