//! The record as the fits see it: what is compared, and the columns of the linear problem.

use super::record::Record;
use super::response::Held;
use super::structure::{Structure, times};
use super::wander;
use crate::least_squares::least_squares;

/// Most samples of the output that are compared; the input is simulated with all.
const COMPARED: usize = 3000;

/// Most changes of the input, and samples of the output, with which starting points are looked for.
const COARSE: usize = 2000;

/// Weights of the single lags in the response of several in a row: `Ti^(n-1)/prod_(j != i) (Ti - Tj)`.
pub(super) fn partial_fractions(lags: &[f64]) -> Vec<f64> {
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
#[derive(Clone)]
pub(super) struct Compared {
    held: Held,
    /// Mean of the input, which the simulated input goes without.
    pub origin: f64,
    pub time: Vec<f64>,
    pub output: Vec<f64>,
    /// Root mean square of the output about its mean.
    pub motion: f64,
    pub span: f64,
    pub scale: f64,
    /// Whether the load may change steadily.
    pub drifts: bool,
    /// Whether everything was at rest at the first input before the record.
    pub rests: bool,
    /// How fast a wandering level is followed before anything is compared; 0: not at all.
    following: f64,
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
            rests: false,
            following: 0.0,
        }
    }

    /// Columns of the linear problem: forced responses, operating point, of an integrator its slope, free motions, what
    /// acted before the record, and the drift.
    pub fn columns(&self, structure: Structure, p: &[f64]) -> Vec<Vec<f64>> {
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
        if !self.rests {
            columns.extend(
                lags.iter()
                    .map(|t| since().map(|s| libm::exp(-s / t)).collect::<Vec<f64>>()),
            );
        }
        if !self.rests && self.time.partition_point(|t| t - start < dead_time) > 2 {
            columns.push(acted);
        }
        // A steady change of the load: behind lags a slope, behind an integrator a parabola.
        if self.drifts {
            let power = if structure.integrates() { 2 } else { 1 };
            columns.push(since().map(|s| (s / self.span).powi(power)).collect());
        }
        for column in &mut columns {
            wander::follow(column, self.following);
        }
        columns
    }

    /// The last input, less the mean.
    pub fn last_input(&self) -> f64 {
        self.time.last().map_or(0.0, |t| self.held.at(*t)) - self.origin
    }

    /// Coefficients and residuals at the searched parameters.
    pub fn solve(&self, columns: &[Vec<f64>]) -> Option<(Vec<f64>, Vec<f64>)> {
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

    /// The same with an input that changes seldom enough for many trials; its mean from sample to sample is kept.
    pub fn coarse(&self) -> Option<Self> {
        if self.held.changes() <= COARSE {
            return None;
        }
        let stride = self.time.len().div_ceil(COARSE).max(1);
        let taken = |values: &[f64]| values.iter().copied().step_by(stride).collect::<Vec<f64>>();
        let time = taken(&self.time);
        Some(Self {
            held: self.held.averaged(&time),
            output: taken(&self.output),
            time,
            ..self.clone()
        })
    }

    /// The same with all that is compared freed of a wandering level.
    pub fn following(&self, following: f64) -> Self {
        let mut other = Self {
            following,
            ..self.clone()
        };
        wander::follow(&mut other.output, following);
        other
    }
}
