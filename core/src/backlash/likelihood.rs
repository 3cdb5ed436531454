//! How well do a gap and a load explain where the contacts lie?

use rand::SeedableRng as _;
use rand_distr::{Distribution as _, StandardNormal};
use rand_pcg::Pcg64;

use super::contacts::Touch;
use super::estimate::Side;
use super::flight::Slowing;
use super::simplex::minimise;

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

/// A contact in SI units.
#[derive(Clone, Copy, Debug)]
pub(super) struct Event {
    pub time: f64,
    pub position: f64,
    /// From the begin to the centre of the push, s.
    pub centre: f64,
    pub side: Side,
    /// Velocity of the motor at the begin.
    pub velocity: f64,
    pub jump: f64,
    pub jump_noise: f64,
    /// Whether the load flew before, so that its place is told by the begin; else the push goes on.
    pub free: bool,
}

impl Event {
    pub fn new(touch: &Touch, time: f64, position: f64, velocity: f64, step: f64) -> Self {
        Self {
            time,
            position,
            velocity,
            centre: touch.centre * step,
            side: touch.side,
            jump: touch.jump,
            jump_noise: touch.jump_noise,
            free: touch.free,
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
}

/// How far a contact lies from where the load was expected.
#[derive(Clone, Copy, Debug)]
pub(super) struct Innovation {
    /// Measured minus expected position of the motor.
    pub value: f64,
    pub deviation: f64,
}

/// The best explanation.
#[derive(Clone, Debug)]
pub(super) struct Fit {
    pub half_gap: f64,
    /// Standard error of `half_gap`.
    pub error: f64,
    pub inertia_ratio: f64,
    pub slowing: Slowing,
    /// One for each event but the first.
    pub innovations: Vec<Innovation>,
}

/// Most likely half gap; `None` where the contacts do not tell.
pub(super) fn fit(events: &[Event], scales: &Scales) -> Option<Fit> {
    let prior = Prior {
        mean: [
            0.0,
            0.0,
            2.0_f64.ln(),
            (0.01 * scales.acceleration).ln(),
            (0.25 * scales.step * scales.speed).ln(),
            0.01_f64.ln(),
        ],
        deviation: [f64::INFINITY, 1.2, 1.5, 2.0, 0.7, 1.0],
    };
    let errors = (SLOW * scales.speed, LATE * scales.step);
    let cost = |point: &Point| {
        let plain = plain(point);
        let prior: f64 = (0..UNKNOWNS)
            .map(|i| 0.5 * ((plain[i] - prior.mean[i]) / prior.deviation[i]).powi(2))
            .sum();
        let value = filter(events, point, errors, None) + prior;
        if value.is_finite() { value } else { f64::MAX }
    };
    let (least, most) = (scales.travel / 400.0, scales.travel);
    let mut starts = Vec::new();
    for k in 0..GAPS {
        let half_gap = least * (most / least).powf(k as f64 / (GAPS - 1) as f64);
        let mut best: Option<(Point, f64)> = None;
        for ratio in INERTIA_RATIOS {
            for viscous in VISCOUS {
                for dry in DRY_SHARES {
                    let mut point = prior.mean;
                    point[0] = half_gap.ln();
                    point[1] = ratio.ln() - point[0];
                    point[2] = viscous.ln();
                    point[3] = (dry * scales.acceleration).ln() - point[0];
                    let value = cost(&point);
                    if best.is_none_or(|b| value < b.1) {
                        best = Some((point, value));
                    }
                }
            }
        }
        starts.extend(best);
    }
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
    let half_gap = point[0].exp();
    let relative = posterior.covariance[(0, 0)].max(0.0).sqrt();
    Some(Fit {
        half_gap,
        error: half_gap * relative,
        inertia_ratio: plain(&point)[1].exp(),
        slowing: Slowing {
            viscous: point[2].exp(),
            dry: plain(&point)[3].exp(),
        },
        innovations,
    })
}

/// The logarithms themselves, no longer divided by the half gap.
fn plain(point: &Point) -> Point {
    let mut plain = *point;
    plain[1] += point[0];
    plain[3] += point[0];
    plain
}

/// Minus the logarithm of the likelihood of the innovations, up to a constant.
///
/// State: position and velocity of the load. A contact says that the motor's position is that of the
/// load plus or minus the half gap; it gives the load the momentum that the motor loses.
fn filter(
    events: &[Event],
    point: &Point,
    (slow, late): (f64, f64),
    mut innovations: Option<&mut Vec<Innovation>>,
) -> f64 {
    let [half_gap, ratio, viscous, dry, place, relative] = plain(point).map(f64::exp);
    let slowing = Slowing { viscous, dry };
    let Some(first) = events.first() else {
        return 0.0;
    };
    let place = place * place;
    let mut x = first.position - first.side.sign() * half_gap;
    let mut v = 0.0;
    // Covariance of position and velocity: xx, xv, vv.
    let mut c = [place, 0.0, 0.0];
    let mut total = 0.0;
    let fly = |x: &mut f64, v: &mut f64, c: &mut [f64; 3], time: f64| {
        let f = slowing.flight(*v, time.max(0.0));
        *x += f.way;
        *v = f.velocity;
        let (a, b) = (f.way_by_velocity, f.velocity_by_velocity);
        *c = [
            c[0] + 2.0 * a * c[1] + a * a * c[2],
            b * (c[1] + a * c[2]),
            b * b * c[2],
        ];
    };
    for (k, event) in events.iter().enumerate() {
        if k > 0 {
            let before = &events[k - 1];
            fly(
                &mut x,
                &mut v,
                &mut c,
                event.time - before.time - before.centre,
            );
            // A contact is placed in time, so that its place is the less certain the faster they meet.
            let place = place + (late * (event.velocity - v)).powi(2);
            let variance = c[0] + place;
            let value = event.position - event.side.sign() * half_gap - x;
            let square = value * value / variance;
            if let Some(list) = innovations.as_deref_mut() {
                list.push(Innovation {
                    value,
                    deviation: variance.sqrt(),
                });
            }
            if event.free {
                total += 0.5 * variance.ln() + 0.5 * (FREEDOM + 1.0) * (square / FREEDOM).ln_1p();
                // What is random is when they meet, not where: density in time, not in position.
                let approach = event.side.sign() * (event.velocity - v);
                total -= (slow * softplus(approach / slow)).ln();
                let (gx, gv) = (c[0] / variance, c[1] / variance);
                x += gx * value;
                v += gv * value;
                c = [c[0] - gx * c[0], c[1] - gx * c[1], c[2] - gv * c[1]];
            }
        }
        fly(&mut x, &mut v, &mut c, event.centre);
        v += ratio * event.jump;
        c[2] += (ratio * relative * event.jump).powi(2) + (ratio * event.jump_noise).powi(2);
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
        let gain = (step as f64 + 1.0).powf(-0.6);
        scale *= ((f64::from(u8::from(accepted)) - ACCEPTED) * gain).exp();
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
    x.max(0.0) + (-x.abs()).exp().ln_1p()
}
