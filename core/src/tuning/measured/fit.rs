//! Models of a record by least squares, its held input simulated exactly.
//!
//! Gain, operating point, initial state and what acted before the record enter linearly and are solved for; only time
//! constants and dead time are searched (separable least squares, Golub and Pereyra 1973): on a grid, by a simplex, then
//! by Gauss and Newton with the damping of Levenberg and Marquardt. Standard errors come from the Jacobian of all
//! parameters; residuals that hang together count as fewer samples.

use std::f64::consts::PI;

use nalgebra::{DMatrix, DVector};
use num_complex::Complex;
use serde::{Deserialize, Serialize};

use super::record::Record;
use super::response::Held;
use crate::plant::TransferFunction;
use crate::simplex::minimise;
use crate::sums::dot;

/// Most samples of the output that are compared; the input is simulated with all.
const COMPARED: usize = 3000;

/// Time constants and dead times of the grid, in periods of the cycle.
const GRID_TIMES: [f64; 9] = [0.04, 0.08, 0.16, 0.32, 0.64, 1.28, 2.56, 5.12, 10.24];
const GRID_DEAD_TIMES: [f64; 7] = [0.003, 0.03, 0.08, 0.15, 0.25, 0.35, 0.46];

/// Second time constants of the grid, as shares of the first.
const GRID_SHARES: [f64; 3] = [0.1, 0.4, 0.8];

/// Largest share of a time constant of the one before: equal ones would make their partial fractions meaningless.
const LARGEST_SHARE: f64 = 0.95;

/// Evaluations of a simplex, and steps of the last improvement.
const SIMPLEX_EVALUATIONS: usize = 160;
const IMPROVEMENTS: usize = 40;

/// A time constant of more than this many lengths of the record is an integrator's.
const LONGEST: f64 = 20.0;

/// A time constant of less than this share of the largest has no effect.
const SHORTEST: f64 = 1e-6;

/// Share of the diagonal that is added, so that columns that say the same do no harm.
const RIDGE: f64 = 1e-12;

/// What a model misses of the motion below this share is round-off.
const ROUND_OFF: f64 = 1e-9;

/// By how much the score must be better with a drift: strong evidence on Raftery's scale (1995).
const DRIFT_EVIDENCE: f64 = 10.0;

/// Relative standard error from which a gain is not known.
const VAGUE: f64 = 0.5;

/// Step of a numerical derivative.
const DERIVATIVE: f64 = 1e-5;

/// What a model consists of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Structure {
    /// `K e^(-Ls)/(T s + 1)`.
    Fopdt,
    /// `K e^(-Ls)/((T1 s + 1)(T2 s + 1))`.
    Sopdt,
    /// `K (Tz s + 1) e^(-Ls)/((T1 s + 1)(T2 s + 1))`; an inverse response where `Tz` is below 0.
    SopdtZero,
    /// `K e^(-Ls)/((T1 s + 1)(T2 s + 1)(T3 s + 1))` with `T1 : T2 = T2 : T3`, for plants of high order.
    Topdt,
    /// `K e^(-Ls)/s`.
    Integrator,
    /// `K e^(-Ls)/(s (T s + 1))`.
    IntegratorLag,
}

impl Structure {
    /// All, simplest first.
    pub const ALL: [Self; 6] = [
        Self::Fopdt,
        Self::Integrator,
        Self::Sopdt,
        Self::IntegratorLag,
        Self::Topdt,
        Self::SopdtZero,
    ];

    /// Its name in files.
    pub const fn id(self) -> &'static str {
        match self {
            Self::Fopdt => "fopdt",
            Self::Sopdt => "sopdt",
            Self::SopdtZero => "sopdt_zero",
            Self::Topdt => "topdt",
            Self::Integrator => "integrator",
            Self::IntegratorLag => "integrator_lag",
        }
    }

    /// Its name in sentences.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Fopdt => "a lag with dead time",
            Self::Sopdt => "two lags with dead time",
            Self::SopdtZero => "two lags with a zero and dead time",
            Self::Topdt => "three lags with dead time",
            Self::Integrator => "an integrator with dead time",
            Self::IntegratorLag => "an integrator with a lag and dead time",
        }
    }

    /// Whether its output goes on rising with a constant input.
    pub const fn integrates(self) -> bool {
        matches!(self, Self::Integrator | Self::IntegratorLag)
    }

    /// Time constants.
    const fn lags(self) -> usize {
        match self {
            Self::Integrator => 0,
            Self::Fopdt | Self::IntegratorLag => 1,
            Self::Sopdt | Self::SopdtZero => 2,
            Self::Topdt => 3,
        }
    }

    /// Numbers that are searched for the time constants.
    const fn searched(self) -> usize {
        match self {
            Self::Integrator => 0,
            Self::Fopdt | Self::IntegratorLag => 1,
            Self::Sopdt | Self::SopdtZero | Self::Topdt => 2,
        }
    }

    /// Coefficients of the forced response.
    const fn forced(self) -> usize {
        match self {
            Self::SopdtZero => 2,
            _ => 1,
        }
    }
}

/// A value with its standard error, both in the value's unit.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Value {
    /// The value.
    pub value: f64,
    /// Its standard error.
    pub std_error: f64,
}

/// A model with the standard errors of its parameters.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FittedModel {
    /// What it consists of.
    pub structure: Structure,
    /// Static gain, unit of the output over that of the input; of an integrator its velocity gain, per s.
    pub gain: Value,
    /// Time constants, s, the largest first.
    pub time_constants: Vec<Value>,
    /// Time constant of the zero, s.
    pub zero: Option<Value>,
    /// Dead time, s.
    pub dead_time: Value,
    /// Output without input (the surroundings); of an integrator the input that holds it still.
    pub operating_point: f64,
    /// Root mean square of what it misses over that of the motion, on the record itself.
    pub left: f64,
    /// Whether it is the one that the data prefer.
    pub preferred: bool,
}

impl FittedModel {
    /// As a plant.
    pub fn plant(&self) -> TransferFunction {
        let mut denominator = if self.structure.integrates() {
            vec![1.0, 0.0]
        } else {
            vec![1.0]
        };
        for t in &self.time_constants {
            denominator = crate::tuning::scan::product(&denominator, &[t.value, 1.0]);
        }
        let k = self.gain.value;
        let numerator = self.zero.map_or_else(|| vec![k], |z| vec![k * z.value, k]);
        TransferFunction::new(&numerator, &denominator, self.dead_time.value)
    }
}

/// A model with all that its fit knows.
#[derive(Clone, Debug)]
pub(super) struct Fit {
    pub model: FittedModel,
    /// Gains, then logarithms of time constants and dead time as they were searched.
    theta: Vec<f64>,
    covariance: DMatrix<f64>,
    /// Output of the model at the compared samples, and the record's there.
    pub simulated: Vec<f64>,
    pub score: f64,
    /// Noise of the output: what changes from sample to sample of what the model leaves.
    pub noise: f64,
    motion: f64,
    rss: f64,
    scale: f64,
    parameters: usize,
}

impl Fit {
    /// Response at a frequency.
    pub fn response(&self, omega: f64) -> Complex<f64> {
        response(self.model.structure, &self.theta, self.scale, omega)
    }

    /// Share of the motion that the model misses beyond what changes from sample to sample.
    pub fn misfit(&self) -> f64 {
        (self.model.left.powi(2) - (self.noise / self.motion).powi(2))
            .max(0.0)
            .sqrt()
    }

    /// Standard error of a number that is computed from the model's response.
    pub fn error_of(
        &self,
        number: impl Fn(&dyn Fn(f64) -> Complex<f64>) -> Option<f64>,
    ) -> Option<f64> {
        let at = |theta: &[f64]| number(&|w| response(self.model.structure, theta, self.scale, w));
        let middle = at(&self.theta)?;
        let mut gradient = DVector::zeros(self.theta.len());
        for i in 0..self.theta.len() {
            let step = DERIVATIVE * self.theta[i].abs().max(1e-3);
            let mut theta = self.theta.clone();
            theta[i] += step;
            gradient[i] = (at(&theta)? - middle) / step;
        }
        let variance = (&self.covariance * &gradient).dot(&gradient);
        (variance.is_finite() && variance >= 0.0).then(|| variance.sqrt())
    }
}

/// Time constants, largest first and 0 where there are none, and dead time, s, of what is searched.
fn times(structure: Structure, p: &[f64], scale: f64) -> ([f64; 3], f64) {
    let searched = structure.searched();
    let first = if searched > 0 {
        scale * libm::exp(p[0])
    } else {
        0.0
    };
    let share = if searched > 1 {
        LARGEST_SHARE / (1.0 + libm::exp(-p[1]))
    } else {
        0.0
    };
    let third = if structure.lags() > 2 {
        first * share * share
    } else {
        0.0
    };
    ([first, first * share, third], scale * p[searched].abs())
}

/// Static or velocity gain, three time constants, zero and dead time.
fn physical(structure: Structure, theta: &[f64], scale: f64) -> [f64; 6] {
    let forced = structure.forced();
    let ([t1, t2, t3], dead_time) = times(structure, &theta[forced..], scale);
    if structure == Structure::SopdtZero {
        let gain = theta[0] + theta[1];
        return [
            gain,
            t1,
            t2,
            t3,
            (theta[0] * t2 + theta[1] * t1) / gain,
            dead_time,
        ];
    }
    [theta[0], t1, t2, t3, 0.0, dead_time]
}

fn response(structure: Structure, theta: &[f64], scale: f64, omega: f64) -> Complex<f64> {
    let [gain, t1, t2, t3, zero, dead_time] = physical(structure, theta, scale);
    let s = Complex::new(0.0, omega);
    let pole = if structure.integrates() {
        s
    } else {
        Complex::new(1.0, 0.0)
    };
    let lags = (s * t1 + 1.0) * (s * t2 + 1.0) * (s * t3 + 1.0);
    let (sin, cos) = libm::sincos(-omega * dead_time);
    (s * zero + 1.0) * gain * Complex::new(cos, sin) / (pole * lags)
}

/// Weights of the single lags in the response of several in a row: `Ti^(n-1)/prod_(j != i) (Ti - Tj)`.
fn partial_fractions(lags: &[f64]) -> Vec<f64> {
    let others = |i: usize| {
        lags.iter()
            .enumerate()
            .filter(move |(j, _)| *j != i)
            .map(|(_, t)| *t)
    };
    (0..lags.len())
        .map(|i| others(i).map(|t| lags[i] / (lags[i] - t)).product())
        .collect()
}

/// Sum of series with weights.
fn weighted(weights: &[f64], series: &[Vec<f64>]) -> Vec<f64> {
    let mut sum = vec![0.0; series.first().map_or(0, Vec::len)];
    for (w, values) in weights.iter().zip(series) {
        sum.iter_mut().zip(values).for_each(|(s, v)| *s += w * v);
    }
    sum
}

/// The record as the fits see it.
pub(super) struct Compared {
    held: Held,
    /// Mean of the input, which the simulated input goes without.
    origin: f64,
    pub time: Vec<f64>,
    pub output: Vec<f64>,
    /// Root mean square of the output about its mean.
    motion: f64,
    span: f64,
    scale: f64,
    /// Whether the load may change steadily.
    drifts: bool,
}

impl Compared {
    /// `scale` is a time in the order of the plant's, s.
    pub fn new(record: &Record, scale: f64) -> Self {
        let stride = record.time.len().div_ceil(COMPARED).max(1);
        let taken = |values: &[f64]| values.iter().copied().step_by(stride).collect::<Vec<f64>>();
        let (time, output) = (taken(&record.time), taken(&record.output));
        let origin = record.input.iter().sum::<f64>() / record.input.len() as f64;
        let mean = output.iter().sum::<f64>() / output.len() as f64;
        let motion =
            (output.iter().map(|y| (y - mean).powi(2)).sum::<f64>() / output.len() as f64).sqrt();
        Self {
            held: Held::new(&record.time, &record.input),
            origin,
            time,
            output,
            motion,
            span: record.span(),
            scale,
            drifts: false,
        }
    }

    /// Columns of the linear problem: forced responses, operating point, of an integrator its slope, free motions, what
    /// acted before the record, and the drift.
    fn columns(&self, structure: Structure, p: &[f64]) -> Vec<Vec<f64>> {
        let (all, dead_time) = times(structure, p, self.scale);
        let lags = &all[..structure.lags()];
        let start = self.time[0];
        let since = || self.time.iter().map(move |t| t - start);
        // Another input before the record acts until the dead time is over.
        let early = |t: f64| -> Vec<f64> {
            since()
                .map(|s| {
                    let over = (s - dead_time).max(0.0);
                    (1.0 - libm::exp(-(s - over) / t)) * libm::exp(-over / t)
                })
                .collect()
        };
        let forced: Vec<Vec<f64>> = lags
            .iter()
            .map(|t| self.held.lag(&self.time, *t, self.origin, dead_time))
            .collect();
        let before: Vec<Vec<f64>> = lags.iter().map(|t| early(*t)).collect();
        let weights = partial_fractions(lags);
        let mut columns = Vec::with_capacity(8);
        let acted;
        if structure.integrates() {
            // 1/(s (T s + 1)) = 1/s - T/(T s + 1).
            let through: Vec<f64> = std::iter::once(1.0)
                .chain(lags.iter().map(|t| -t))
                .collect();
            let own = |first: Vec<f64>, rest: Vec<Vec<f64>>| {
                let all: Vec<Vec<f64>> = std::iter::once(first).chain(rest).collect();
                weighted(&through, &all)
            };
            columns.push(own(
                self.held.integral(&self.time, self.origin, dead_time),
                forced,
            ));
            acted = own(since().map(|s| s.min(dead_time)).collect(), before);
        } else if structure == Structure::SopdtZero {
            acted = weighted(&weights, &before);
            columns.extend(forced);
        } else {
            acted = weighted(&weights, &before);
            columns.push(weighted(&weights, &forced));
        }
        columns.push(vec![1.0; self.time.len()]);
        if structure.integrates() {
            columns.push(since().map(|s| s / self.span).collect());
        }
        columns.extend(
            lags.iter()
                .map(|t| since().map(|s| libm::exp(-s / t)).collect::<Vec<f64>>()),
        );
        if self.time.partition_point(|t| t - start < dead_time) > 2 {
            columns.push(acted);
        }
        // A steady change of the load: behind lags a slope, behind an integrator a parabola.
        if self.drifts {
            let power = if structure.integrates() { 2 } else { 1 };
            columns.push(since().map(|s| (s / self.span).powi(power)).collect());
        }
        columns
    }

    /// Coefficients and residuals at the searched parameters.
    fn solve(&self, columns: &[Vec<f64>]) -> Option<(Vec<f64>, Vec<f64>)> {
        let coefficients = least_squares(columns, &self.output)?;
        let mut residuals = self.output.clone();
        for (c, column) in coefficients.iter().zip(columns) {
            residuals
                .iter_mut()
                .zip(column)
                .for_each(|(r, x)| *r -= c * x);
        }
        Some((coefficients, residuals))
    }

    fn cost(&self, structure: Structure, p: &[f64]) -> f64 {
        let allowed = {
            let (lags, dead_time) = times(structure, p, self.scale);
            let too_long = lags[0] > LONGEST * self.span || dead_time > 0.5 * self.span;
            // A lag that is far below the others is none.
            let none = (1..structure.lags()).any(|i| lags[i] < SHORTEST * lags[0]);
            p.iter().all(|v| v.is_finite()) && !too_long && !none
        };
        if !allowed {
            return f64::INFINITY;
        }
        let columns = self.columns(structure, p);
        self.solve(&columns)
            .map_or(f64::INFINITY, |(_, r)| dot(&r, &r))
    }

    /// Fits one structure.
    pub fn fit(&self, structure: Structure) -> Option<Fit> {
        let mut starts: Vec<(Vec<f64>, f64)> = self
            .grid(structure)
            .into_iter()
            .map(|p| {
                let cost = self.cost(structure, &p);
                (p, cost)
            })
            .collect();
        starts.sort_by(|a, b| a.1.total_cmp(&b.1));
        let best = starts
            .into_iter()
            .take(2)
            .map(|(p, _)| self.descend(structure, p))
            .min_by(|a, b| a.1.total_cmp(&b.1))?;
        let p = self.improve(structure, best.0);
        self.finish(structure, &p)
    }

    fn grid(&self, structure: Structure) -> Vec<Vec<f64>> {
        let mut grid = Vec::new();
        for l in GRID_DEAD_TIMES {
            match structure.searched() {
                0 => grid.push(vec![l]),
                1 => grid.extend(GRID_TIMES.iter().map(|t| vec![libm::log(*t), l])),
                _ => {
                    for t in GRID_TIMES {
                        grid.extend(GRID_SHARES.iter().map(|share| {
                            vec![libm::log(t), -libm::log(LARGEST_SHARE / share - 1.0), l]
                        }));
                    }
                }
            }
        }
        grid
    }

    fn descend(&self, structure: Structure, p: Vec<f64>) -> (Vec<f64>, f64) {
        let cost = |p: &[f64]| self.cost(structure, p);
        match p.as_slice() {
            [a] => descended(minimise(
                |p: &[f64; 1]| cost(p),
                [*a],
                0.1,
                SIMPLEX_EVALUATIONS,
                0.0,
            )),
            [a, b] => descended(minimise(
                |p: &[f64; 2]| cost(p),
                [*a, *b],
                0.1,
                SIMPLEX_EVALUATIONS,
                0.0,
            )),
            [a, b, c] => descended(minimise(
                |p: &[f64; 3]| cost(p),
                [*a, *b, *c],
                0.1,
                SIMPLEX_EVALUATIONS,
                0.0,
            )),
            _ => (p, f64::INFINITY),
        }
    }

    /// Levenberg-Marquardt on the searched parameters, the others solved for.
    fn improve(&self, structure: Structure, mut p: Vec<f64>) -> Vec<f64> {
        let residuals = |p: &[f64]| self.solve(&self.columns(structure, p)).map(|s| s.1);
        let Some(mut r) = residuals(&p) else { return p };
        let mut damping = 1e-3;
        for _ in 0..IMPROVEMENTS {
            let cost = dot(&r, &r);
            let mut jacobian: Vec<Vec<f64>> = Vec::new();
            for i in 0..p.len() {
                let mut moved = p.clone();
                moved[i] += DERIVATIVE;
                let Some(other) = residuals(&moved) else {
                    return p;
                };
                jacobian.push(
                    other
                        .iter()
                        .zip(&r)
                        .map(|(a, b)| (a - b) / DERIVATIVE)
                        .collect(),
                );
            }
            let mut better = false;
            while damping < 1e9 {
                let Some(step) = damped(&jacobian, &r, damping) else {
                    break;
                };
                let moved: Vec<f64> = p.iter().zip(&step).map(|(a, b)| a - b).collect();
                let new_cost = self.cost(structure, &moved);
                if new_cost < cost {
                    let done = cost - new_cost < 1e-15 * cost;
                    let Some(new) = residuals(&moved) else {
                        return p;
                    };
                    (p, r, better) = (moved, new, !done);
                    damping = (damping * 0.1).max(1e-12);
                    break;
                }
                damping *= 10.0;
            }
            if !better {
                break;
            }
        }
        p
    }

    /// The model with its errors.
    fn finish(&self, structure: Structure, p: &[f64]) -> Option<Fit> {
        let columns = self.columns(structure, p);
        let (coefficients, residuals) = self.solve(&columns)?;
        let forced = structure.forced();
        let rss = dot(&residuals, &residuals);
        let n = residuals.len();
        let parameters = columns.len() + p.len();
        // Full Jacobian: linear columns, and how the model moves with the searched parameters.
        let mut jacobian = columns.clone();
        for i in 0..p.len() {
            let mut moved = p.to_vec();
            moved[i] += DERIVATIVE;
            let others = self.columns(structure, &moved);
            let mut change = vec![0.0; n];
            for ((c, a), b) in coefficients.iter().zip(&others).zip(&columns) {
                for (d, (a, b)) in change.iter_mut().zip(a.iter().zip(b)) {
                    *d += c * (a - b) / DERIVATIVE;
                }
            }
            jacobian.push(change);
        }
        let variance = rss / n.saturating_sub(parameters).max(1) as f64 * coherence(&residuals);
        let full = inverse_gram(&jacobian)? * variance;
        // What matters outside: forced coefficients and searched parameters.
        let kept: Vec<usize> = (0..forced)
            .chain(columns.len()..columns.len() + p.len())
            .collect();
        let covariance = DMatrix::from_fn(kept.len(), kept.len(), |i, j| full[(kept[i], kept[j])]);
        let theta: Vec<f64> = coefficients[..forced].iter().chain(p).copied().collect();
        let values = physical(structure, &theta, self.scale);
        let errors = errors(structure, &theta, self.scale, &covariance);
        let value = |i: usize| Value {
            value: values[i],
            std_error: errors[i],
        };
        let operating_point = if structure.integrates() {
            self.origin - coefficients[forced + 1] / (self.span * values[0])
        } else {
            coefficients[forced] - values[0] * self.origin
        };
        let simulated = self
            .output
            .iter()
            .zip(&residuals)
            .map(|(y, r)| y - r)
            .collect();
        values.iter().all(|v| v.is_finite()).then(|| Fit {
            model: FittedModel {
                structure,
                gain: value(0),
                time_constants: (1..=structure.lags()).map(value).collect(),
                zero: (structure == Structure::SopdtZero).then(|| value(4)),
                dead_time: value(5),
                operating_point,
                left: (rss / n as f64).sqrt() / self.motion,
                preferred: false,
            },
            theta,
            covariance,
            simulated,
            score: f64::INFINITY,
            noise: (0.5
                * residuals
                    .windows(2)
                    .map(|r| (r[1] - r[0]).powi(2))
                    .sum::<f64>()
                / n as f64)
                .sqrt(),
            motion: self.motion,
            rss,
            scale: self.scale,
            parameters,
        })
    }

    /// Fits all structures, the one that the data prefer first: by Schwarz's criterion, where residuals that hang together
    /// count as fewer samples. A drift is allowed where the data ask for it.
    pub fn fit_all(&mut self) -> Vec<Fit> {
        let steady = self.fit_each(&Structure::ALL);
        let Some(best) = steady.first() else {
            return steady;
        };
        self.drifts = true;
        let drifting = self.fit(best.model.structure);
        let better = drifting.is_some_and(|d| {
            let independent = self.independent(&d);
            independent * libm::log(best.rss / d.rss)
                > DRIFT_EVIDENCE + libm::log(independent.max(2.0))
        });
        if better && best.model.left > ROUND_OFF {
            return self.fit_each(&Structure::ALL);
        }
        self.drifts = false;
        steady
    }

    /// Samples that count.
    fn independent(&self, fit: &Fit) -> f64 {
        let residuals: Vec<f64> = self
            .output
            .iter()
            .zip(&fit.simulated)
            .map(|(y, s)| y - s)
            .collect();
        (residuals.len() as f64 / coherence(&residuals)).max(1.0)
    }

    fn fit_each(&self, structures: &[Structure]) -> Vec<Fit> {
        let mut fits: Vec<Fit> = structures.iter().filter_map(|s| self.fit(*s)).collect();
        let n = self.output.len() as f64;
        let floor = n * (ROUND_OFF * self.motion).powi(2);
        let Some(least) = fits.iter().min_by(|a, b| a.rss.total_cmp(&b.rss)) else {
            return fits;
        };
        let independent = self.independent(least);
        for fit in &mut fits {
            fit.score = independent * libm::log((fit.rss + floor) / n)
                + fit.parameters as f64 * libm::log(independent.max(2.0));
        }
        // A model whose gain is not known at all is of no use, however well it follows.
        let vague = |f: &Fit| !(f.model.gain.std_error < VAGUE * f.model.gain.value.abs());
        fits.sort_by(|a, b| vague(a).cmp(&vague(b)).then(a.score.total_cmp(&b.score)));
        if let Some(first) = fits.first_mut() {
            first.model.preferred = true;
        }
        fits
    }
}

fn descended<const N: usize>((p, cost): ([f64; N], f64)) -> (Vec<f64>, f64) {
    (p.to_vec(), cost)
}

/// Standard errors of the physical parameters.
fn errors(structure: Structure, theta: &[f64], scale: f64, covariance: &DMatrix<f64>) -> [f64; 6] {
    let middle = physical(structure, theta, scale);
    let gradients: Vec<[f64; 6]> = (0..theta.len())
        .map(|i| {
            let step = DERIVATIVE * theta[i].abs().max(1e-3);
            let mut moved = theta.to_vec();
            moved[i] += step;
            let values = physical(structure, &moved, scale);
            std::array::from_fn(|k| (values[k] - middle[k]) / step)
        })
        .collect();
    std::array::from_fn(|k| {
        let g = DVector::from_iterator(theta.len(), gradients.iter().map(|g| g[k]));
        (covariance * &g).dot(&g).max(0.0).sqrt()
    })
}

/// Scaled normal equations: the columns' lengths, and their Gram matrix with unit diagonal.
fn gram(columns: &[Vec<f64>]) -> (Vec<f64>, DMatrix<f64>) {
    let lengths: Vec<f64> = columns
        .iter()
        .map(|c| dot(c, c).sqrt().max(f64::MIN_POSITIVE))
        .collect();
    let m = columns.len();
    let mut gram = DMatrix::zeros(m, m);
    for i in 0..m {
        for j in 0..=i {
            let g = dot(&columns[i], &columns[j]) / (lengths[i] * lengths[j]);
            gram[(i, j)] = g;
            gram[(j, i)] = g;
        }
        gram[(i, i)] += RIDGE;
    }
    (lengths, gram)
}

pub(super) fn least_squares(columns: &[Vec<f64>], right: &[f64]) -> Option<Vec<f64>> {
    let (lengths, gram) = gram(columns);
    let cholesky = gram.cholesky()?;
    let solved = |right: &[f64]| {
        let rhs = DVector::from_iterator(
            columns.len(),
            columns.iter().zip(&lengths).map(|(c, l)| dot(c, right) / l),
        );
        let x = cholesky.solve(&rhs);
        x.iter()
            .zip(&lengths)
            .map(|(x, l)| x / l)
            .collect::<Vec<f64>>()
    };
    let mut x = solved(right);
    // Once more on what is left, which takes off most of the round-off of the normal equations.
    let mut rest = right.to_vec();
    for (c, column) in x.iter().zip(columns) {
        rest.iter_mut().zip(column).for_each(|(r, v)| *r -= c * v);
    }
    x.iter_mut().zip(solved(&rest)).for_each(|(a, b)| *a += b);
    x.iter().all(|v| v.is_finite()).then_some(x)
}

pub(super) fn inverse_gram(columns: &[Vec<f64>]) -> Option<DMatrix<f64>> {
    let (lengths, gram) = gram(columns);
    let inverse = gram.cholesky()?.inverse();
    let m = columns.len();
    Some(DMatrix::from_fn(m, m, |i, j| {
        inverse[(i, j)] / (lengths[i] * lengths[j])
    }))
}

fn damped(jacobian: &[Vec<f64>], residuals: &[f64], damping: f64) -> Option<Vec<f64>> {
    let (lengths, mut gram) = gram(jacobian);
    for i in 0..jacobian.len() {
        gram[(i, i)] += damping;
    }
    let rhs = DVector::from_iterator(
        jacobian.len(),
        jacobian
            .iter()
            .zip(&lengths)
            .map(|(c, l)| dot(c, residuals) / l),
    );
    let x = gram.cholesky()?.solve(&rhs);
    Some(x.iter().zip(&lengths).map(|(x, l)| x / l).collect())
}

/// By how much residuals that hang together count less: `1 + 2 sum of autocorrelations`, summed until the first that is
/// not above 0; at least 1.
pub(super) fn coherence(residuals: &[f64]) -> f64 {
    let n = residuals.len();
    let own = dot(residuals, residuals);
    if !(own > 0.0) {
        return 1.0;
    }
    let mut sum = 1.0;
    for lag in 1..n / 4 {
        let r = dot(&residuals[lag..], &residuals[..n - lag]) / own;
        if r <= 0.0 {
            break;
        }
        sum += 2.0 * r;
    }
    sum
}

/// Frequency at which the phase passes -180 degrees first, searched from `low` to `high` rad/s; the gain is positive.
pub(super) fn crossover(
    response: &dyn Fn(f64) -> Complex<f64>,
    low: f64,
    high: f64,
) -> Option<f64> {
    let points = crate::tuning::scan::grid(low, high);
    let turned = |w: f64| {
        let r = response(w);
        libm::atan2(r.im, r.re)
    };
    let mut phase = turned(low);
    let mut before = (low, phase);
    for &w in points.iter().skip(1) {
        let raw = turned(w);
        phase = raw + 2.0 * PI * ((phase - raw) / (2.0 * PI)).round();
        if before.1 > -PI && phase <= -PI {
            let f = |x: f64| response(x).im;
            return Some(crate::tuning::scan::bisect(
                before.0,
                w,
                f(before.0) > 0.0,
                f,
            ));
        }
        before = (w, phase);
    }
    None
}
