//! Models of a record by least squares, its held input simulated exactly.
//!
//! Gain, operating point, initial state and what acted before the record enter linearly and are solved for; only time
//! constants and dead time are searched (separable least squares, Golub and Pereyra 1973): on a grid, by a simplex,
//! then by Gauss and Newton with the damping of Levenberg and Marquardt. Standard errors come from the Jacobian of all
//! parameters; residuals that hang together count as fewer samples, and by how much the parameters move when the slow
//! part of the residuals is weighed less is added.

use nalgebra::{DMatrix, DVector};
use num_complex::Complex;

use super::compared::Compared;
use super::structure::{FittedModel, LARGEST_SHARE, Structure, Value, physical, response, times};
use super::wander;
use crate::least_squares::{coherence, damped, inverse_gram};
use crate::simplex::minimise;
use crate::sums::dot;

/// Time constants and dead times of the grid, in periods of the cycle.
const GRID_TIMES: [f64; 9] = [0.04, 0.08, 0.16, 0.32, 0.64, 1.28, 2.56, 5.12, 10.24];
const GRID_DEAD_TIMES: [f64; 7] = [0.003, 0.03, 0.08, 0.15, 0.25, 0.35, 0.46];

/// Second time constants of the grid, as shares of the first.
const GRID_SHARES: [f64; 3] = [0.1, 0.4, 0.8];

/// Points of the grid from which the search goes on.
const STARTS: usize = 3;

/// Evaluations of a simplex, and steps of the last improvement.
const SIMPLEX_EVALUATIONS: usize = 160;
const IMPROVEMENTS: usize = 40;

/// Steps from the one estimate to the other; the first is as good as all in the limit of many samples.
const STEPS_OTHERWISE: usize = 3;

/// A time constant of more than this many lengths of the record is an integrator's.
const LONGEST: f64 = 20.0;

/// A time constant of less than this share of the largest has no effect.
const SHORTEST: f64 = 1e-6;

/// What a model misses of the motion below this share is round-off.
const ROUND_OFF: f64 = 1e-9;

/// By how much the score must be better with a drift: strong evidence on Raftery's scale (1995).
const DRIFT_EVIDENCE: f64 = 10.0;

/// Multiple of what the best model misses up to which another one is not ruled out.
pub(super) const MISSED: f64 = 1.15;

/// Step of a numerical derivative.
const DERIVATIVE: f64 = 1e-5;

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
    /// Where the output goes with the last input; none where it goes on for ever.
    pub settles: Option<Value>,
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

impl Compared {
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
        let coarse = self.coarse();
        let tried = coarse.as_ref().unwrap_or(self);
        let mut starts: Vec<(Vec<f64>, f64)> = grid(structure)
            .into_iter()
            .map(|p| {
                let cost = tried.cost(structure, &p);
                (p, cost)
            })
            .collect();
        starts.sort_by(|a, b| a.1.total_cmp(&b.1));
        let best = starts
            .into_iter()
            .take(STARTS)
            .map(|(p, _)| {
                let p = self.improve(structure, tried.descend(structure, p).0, IMPROVEMENTS);
                let cost = self.cost(structure, &p);
                (p, cost)
            })
            .min_by(|a, b| a.1.total_cmp(&b.1))?;
        self.finish(structure, &best.0)
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
    fn improve(&self, structure: Structure, mut p: Vec<f64>, steps: usize) -> Vec<f64> {
        let residuals = |p: &[f64]| self.solve(&self.columns(structure, p)).map(|s| s.1);
        let Some(mut r) = residuals(&p) else { return p };
        let mut damping = 1e-3;
        for _ in 0..steps {
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
        let jacobian = self.jacobian(structure, p, &columns, &coefficients);
        // Residuals that hang together are few samples, and every parameter uses one of them up.
        let free = n as f64 / coherence(&residuals) - parameters as f64;
        let variance = rss / free.max(1.0);
        let full = inverse_gram(&jacobian)? * variance;
        // What matters outside: forced coefficients and searched parameters.
        let kept: Vec<usize> = (0..forced)
            .chain(columns.len()..columns.len() + p.len())
            .collect();
        let theta: Vec<f64> = coefficients[..forced].iter().chain(p).copied().collect();
        let mut covariance =
            DMatrix::from_fn(kept.len(), kept.len(), |i, j| full[(kept[i], kept[j])]);
        if let Some(other) = self.weighed_otherwise(structure, p, &residuals) {
            let moved =
                DVector::from_iterator(theta.len(), (theta.iter().zip(&other)).map(|(a, b)| b - a));
            covariance += &moved * moved.transpose();
        }
        let last = self.last_input();
        let settles = (!structure.integrates()).then(|| {
            // Each forced column goes to the input, and the next one stays.
            let by = |i: usize| if i < forced { last } else { 1.0 };
            let pairs = || (0..=forced).flat_map(|i| (0..=forced).map(move |j| (i, j)));
            let variance: f64 = pairs().map(|(i, j)| by(i) * by(j) * full[(i, j)]).sum();
            Value {
                value: (0..=forced).map(|i| by(i) * coefficients[i]).sum(),
                std_error: variance.max(0.0).sqrt(),
            }
        });
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
            settles,
            noise: noise(&residuals),
            motion: self.motion,
            rss,
            scale: self.scale,
            parameters,
        })
    }

    /// The linear columns, and how the model moves with the searched parameters.
    fn jacobian(
        &self,
        structure: Structure,
        p: &[f64],
        columns: &[Vec<f64>],
        coefficients: &[f64],
    ) -> Vec<Vec<f64>> {
        let mut jacobian = columns.to_vec();
        for i in 0..p.len() {
            let mut moved = p.to_vec();
            moved[i] += DERIVATIVE;
            let others = self.columns(structure, &moved);
            let mut change = vec![0.0; self.output.len()];
            for ((c, a), b) in coefficients.iter().zip(&others).zip(columns) {
                for (d, (a, b)) in change.iter_mut().zip(a.iter().zip(b)) {
                    *d += c * (a - b) / DERIVATIVE;
                }
            }
            jacobian.push(change);
        }
        jacobian
    }

    /// Forced coefficients and searched parameters where the residuals' wandering is taken off first. A model that is
    /// right gives the same; what it does not is an error of the model (Hausman 1978).
    fn weighed_otherwise(
        &self,
        structure: Structure,
        p: &[f64],
        residuals: &[f64],
    ) -> Option<Vec<f64>> {
        let other = self.following(wander::share(residuals)?);
        let p = other.improve(structure, p.to_vec(), STEPS_OTHERWISE);
        let (coefficients, _) = other.solve(&other.columns(structure, &p))?;
        Some(
            coefficients[..structure.forced()]
                .iter()
                .chain(&p)
                .copied()
                .collect(),
        )
    }

    /// Fits all structures, the one that the data prefer first: by Schwarz's criterion, where residuals that hang
    /// together count as fewer samples. A drift is allowed where the data ask for it.
    pub fn fit_all(&mut self) -> Vec<Fit> {
        self.fit_moving()
    }

    /// The same for a record without a cycle. A single step tells only where it begins and ends, as long as any motion
    /// may have been under way before it: rest is taken where the data do not speak against it. What remains is known
    /// no better than the models agree that follow the record alike.
    pub fn fit_all_without_cycle(&mut self) -> Vec<Fit> {
        let moving = self.fit_moving();
        let drifted = std::mem::replace(&mut self.drifts, false);
        self.rests = true;
        let resting = self.fit_each(&Structure::ALL);
        let rests = match (moving.first(), resting.first()) {
            (Some(free), Some(rest)) => {
                let independent = self.independent(free);
                let saved = free.parameters as f64 - rest.parameters as f64;
                let floor = self.output.len() as f64 * (ROUND_OFF * self.motion).powi(2);
                independent * libm::log((rest.rss + floor) / (free.rss + floor))
                    < saved * libm::log(independent.max(2.0))
            }
            (None, rest) => rest.is_some(),
            _ => false,
        };
        if !rests {
            (self.rests, self.drifts) = (false, drifted);
        }
        with_disagreement(if rests { resting } else { moving })
    }

    fn fit_moving(&mut self) -> Vec<Fit> {
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
        let vague = |f: &Fit| !f.model.gain.is_known();
        fits.sort_by(|a, b| vague(a).cmp(&vague(b)).then(a.score.total_cmp(&b.score)));
        if let Some(first) = fits.first_mut() {
            first.model.preferred = true;
        }
        fits
    }
}

/// Adds to the errors of gain and final level how far the models disagree that follow the record alike, beyond what
/// their own errors explain.
fn with_disagreement(mut fits: Vec<Fit>) -> Vec<Fit> {
    let beyond = |own: Value, other: Value| {
        ((other.value - own.value).powi(2) - other.std_error.powi(2)).max(0.0)
    };
    let widened = |own: Value, others: &mut dyn Iterator<Item = Value>| Value {
        std_error: (own.std_error.powi(2) + others.map(|o| beyond(own, o)).fold(0.0, f64::max))
            .sqrt(),
        ..own
    };
    let Some(least) = (fits.iter().map(|f| f.model.left)).min_by(f64::total_cmp) else {
        return fits;
    };
    let alike: Vec<(Value, Value)> = (fits.iter())
        .filter(|f| f.model.left <= MISSED * least)
        .filter_map(|f| Some((f.model.gain, f.settles?)))
        .collect();
    for fit in fits.iter_mut().filter(|f| f.settles.is_some()) {
        fit.model.gain = widened(fit.model.gain, &mut alike.iter().map(|a| a.0));
        fit.settles = (fit.settles).map(|s| widened(s, &mut alike.iter().map(|a| a.1)));
    }
    let vague = |f: &Fit| !f.model.gain.is_known();
    // A stable sort: by score among those that are known.
    fits.sort_by_key(vague);
    for (i, fit) in fits.iter_mut().enumerate() {
        fit.model.preferred = i == 0;
    }
    fits
}

/// Starts of the search.
fn grid(structure: Structure) -> Vec<Vec<f64>> {
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

/// Standard deviation of what changes from one sample to the next, from the differences of neighbours.
fn noise(residuals: &[f64]) -> f64 {
    let squares: f64 = residuals.windows(2).map(|r| (r[1] - r[0]).powi(2)).sum();
    (0.5 * squares / residuals.len() as f64).sqrt()
}
