//! How well do a gap and a load explain where the contacts lie?

use super::contacts::Touch;
use super::estimate::Side;
use super::flight::Slowing;
use super::simplex::minimise;

/// Unknowns: logarithms of half gap, motor inertia over load inertia, viscous and dry slowing of the
/// load, noise of a contact's place, relative noise of its momentum.
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

/// Half a step of the differences that give the curvature, in logarithms.
const CURVATURE_STEP: f64 = 0.02;

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
    pub half_length: f64,
    pub side: Side,
    pub jump: f64,
    pub jump_noise: f64,
}

impl Event {
    pub fn new(touch: &Touch, time: f64, position: f64, step: f64) -> Self {
        Self {
            time,
            position,
            half_length: 0.5 * touch.length * step,
            side: touch.side,
            jump: touch.jump,
            jump_noise: touch.jump_noise,
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
            0.03_f64.ln(),
        ],
        deviation: [f64::INFINITY, 1.2, 1.5, 2.0, 0.7, 1.0],
    };
    let cost = |point: &Point| {
        let prior: f64 = (0..UNKNOWNS)
            .map(|i| 0.5 * ((point[i] - prior.mean[i]) / prior.deviation[i]).powi(2))
            .sum();
        let value = filter(events, point, None) + prior;
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
                    point[1] = ratio.ln();
                    point[2] = viscous.ln();
                    point[3] = (dry * scales.acceleration).ln();
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
    let relative = relative_error(&cost, &point, value)?;
    let mut innovations = Vec::new();
    filter(events, &point, Some(&mut innovations));
    if let Ok(t) = std::env::var("TRUE") {
        let v: Vec<f64> = t.split(',').map(|x| x.parse::<f64>().unwrap().ln()).collect();
        let mut p = point;
        p[..4].copy_from_slice(&v[..4]);
        #[allow(clippy::disallowed_macros)]
        {
        println!("best {:?} cost {value}; at truth with its noise {}", point.map(f64::exp), cost(&p));
        let (q, c) = minimise(cost, p, 0.05, 3000, 1e-6);
        println!("from truth {:?} cost {c}", q.map(f64::exp));
        let mut inn = Vec::new();
        filter(events, &p, Some(&mut inn));
        for (e, i) in events[1..].iter().zip(&inn) { println!("{:.4} {:?} jump {:.4}±{:.4} half {:.1e} inn {:+.2e} ± {:.1e}", e.time, e.side, e.jump, e.jump_noise, e.half_length, i.value, i.deviation); }
        }
    }
    let half_gap = point[0].exp();
    Some(Fit {
        half_gap,
        error: half_gap * relative,
        inertia_ratio: point[1].exp(),
        slowing: Slowing {
            viscous: point[2].exp(),
            dry: point[3].exp(),
        },
        innovations,
    })
}

/// Minus the logarithm of the likelihood of the innovations, up to a constant.
///
/// State: position and velocity of the load. A contact says that the motor's position is that of the
/// load plus or minus the half gap; it gives the load the momentum that the motor loses.
fn filter(events: &[Event], point: &Point, mut innovations: Option<&mut Vec<Innovation>>) -> f64 {
    let [half_gap, ratio, viscous, dry, place, relative] = point.map(f64::exp);
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
                event.time - before.time - before.half_length,
            );
            let variance = c[0] + place;
            let value = event.position - event.side.sign() * half_gap - x;
            let square = value * value / variance;
            total += 0.5 * variance.ln() + 0.5 * (FREEDOM + 1.0) * (square / FREEDOM).ln_1p();
            if let Some(list) = innovations.as_deref_mut() {
                list.push(Innovation {
                    value,
                    deviation: variance.sqrt(),
                });
            }
            let (gx, gv) = (c[0] / variance, c[1] / variance);
            x += gx * value;
            v += gv * value;
            c = [c[0] - gx * c[0], c[1] - gx * c[1], c[2] - gv * c[1]];
        }
        fly(&mut x, &mut v, &mut c, event.half_length);
        v += ratio * event.jump;
        c[2] += (ratio * relative * event.jump).powi(2) + (ratio * event.jump_noise).powi(2);
    }
    total
}

/// Standard deviation of the first unknown by the curvature of the cost (all others free).
fn relative_error(cost: &impl Fn(&Point) -> f64, point: &Point, value: f64) -> Option<f64> {
    let at = |moves: &[(usize, f64)]| {
        let mut p = *point;
        for (i, by) in moves {
            p[*i] += by;
        }
        cost(&p)
    };
    // The place of the minimum is sharp in the gap and flat in the rest.
    let steps: Point = std::array::from_fn(|i| {
        let mut h = CURVATURE_STEP;
        for _ in 0..12 {
            let rise = at(&[(i, h)]) + at(&[(i, -h)]) - 2.0 * value;
            if rise > 2.0 {
                h *= 0.5;
            } else if rise < 0.2 && h < 0.3 {
                h *= 2.0;
            } else {
                break;
            }
        }
        h
    });
    let mut hessian = nalgebra::SMatrix::<f64, UNKNOWNS, UNKNOWNS>::zeros();
    for i in 0..UNKNOWNS {
        let h = steps[i];
        hessian[(i, i)] = (at(&[(i, h)]) + at(&[(i, -h)]) - 2.0 * value) / (h * h);
        for j in 0..i {
            let g = steps[j];
            let mixed = at(&[(i, h), (j, g)]) - at(&[(i, h), (j, -g)]) - at(&[(i, -h), (j, g)])
                + at(&[(i, -h), (j, -g)]);
            hessian[(i, j)] = mixed / (4.0 * h * g);
            hessian[(j, i)] = hessian[(i, j)];
        }
    }
    let inverse = hessian.cholesky()?.inverse();
    Some(inverse[(0, 0)].sqrt()).filter(|e| e.is_finite())
}
